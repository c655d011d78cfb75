// The plain CPU twins, a function a kernel.
#pragma once

#include <span>
#include <vector>

#include "compute/instances/world.hpp"
#include "passes/ism/ism_io.h"

namespace myriad::passes {

std::vector<IsmPoint> ism_points_ref(const compute::WorldTriangles& world, std::span<const SurfaceSample> samples);

struct IsmSplatRef {
    uint subset = 0;
    float radius = 0;
    uint seed = 0, first_view = 0, maps = 0, map_size = 0;
};
// Every chosen point, tested against every texel.
std::vector<uint> ism_splat_ref(std::span<const IsmPoint> points, std::span<const View> views, const IsmSplatRef& in);

// A level of `halves` half maps of `size` x `size` texels to the next coarser one, and back.
std::vector<uint> ism_pull_ref(std::span<const uint> fine, uint size, uint halves, float threshold);
void ism_push_ref(std::vector<uint>& fine, std::span<const uint> coarse, uint size, uint halves, float threshold);
// All of it.
std::vector<uint> ism_fill_ref(std::vector<uint> maps, uint size, uint halves, float threshold, uint levels);

}  // namespace myriad::passes
