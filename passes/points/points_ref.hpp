// The plain CPU twin of point rendering.
#pragma once

#include <span>
#include <vector>

#include "compute/bsh/bsh_ref.hpp"
#include "passes/points/points_io.h"
#include "passes/points/points_cells.hpp"

namespace myriad::passes {

// What is drawn. The samples are in leaf order.
struct PointsSceneRef {
    const compute::BshArrays& tree;
    std::span<const SurfaceSample> samples;
    const compute::WorldTriangles& world;
    const PointsCells& cells;
};

// As PointsSplatPush::pixels has it, of these groups; without the count.
std::vector<uint> points_ref(const PointsSceneRef& scene, std::span<const uvec2> groups, const CameraPush& camera, uint width, uint height);

// What a pixel sees by them.
std::vector<RayHitRecord> points_hits_ref(const PointsSceneRef& scene, const std::vector<uint>& pixels, const CameraPush& camera, uint width, uint height);

}  // namespace myriad::passes
