// Triangles, rasterised into every view's map; see README.md.
#pragma once

#include "compute/raytrace/bvh.hpp"
#include "passes/brute/brute_io.h"
#include "passes/geometry/geometry.hpp"

namespace myriad::passes {

class BrutePass {
public:
    // `world`: the triangles that will be drawn; kernels are made for what they need.
    // `own_texels`: the most texels of a triangle that one invocation draws by itself; changes no bit.
    BrutePass(engine::Device& device, const compute::WorldTriangles& world, uint32_t own_texels = 16);

    // Clears `atlas` (map_texels(map_size) words a view, view `first` first) and draws all triangles into it, for those of the views
    // [first, first + limit) that exist.
    void record(engine::Recorder& recorder, const Geometry& geometry, const engine::Array<View>& views, const engine::Array<uint>& count,
                uint32_t first, uint32_t limit, uint32_t map_size, const engine::Array<uint>& atlas);

private:
    engine::Device& device_;
    engine::Program program_;
    uint32_t triangles_;
    bool solid_;
};

}  // namespace myriad::passes
