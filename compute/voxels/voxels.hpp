// Conservative voxelisation of triangles; see README.md.
#pragma once

#include "compute/append/append.hpp"
#include "compute/append/grid.hpp"
#include "compute/octree/octree.hpp"
#include "compute/voxels/voxels_io.h"

namespace myriad::compute {

struct VoxelTriangles {
    const engine::Array<vec3>& positions;
    const engine::Array<uvec4>& triangles;
    const engine::Array<Instance>* instances;  // null: nothing is shared
    uint32_t instance_count = 0;
};

class Voxels {
public:
    static constexpr uint64_t max_triangles = uint64_t(1) << voxels_triangle_bits;

    // `depth`: 1 to 12 levels below the root. `next_capacity` pairs on the way down, the triangles of one record() among them, and `kept_capacity` at the leaves.
    // `constants`: WorldTriangles::constants() of those that it will see.
    Voxels(engine::Device& device, AppendMode mode, uint32_t depth, uint64_t next_capacity, uint64_t kept_capacity, const engine::Constants& constants);

    // Finds the pairs of leaf cells and triangles [first, first + limit), as far as count[0] goes, that meet. What reaches out of the cube is cut off there.
    void record(engine::Recorder& recorder, const VoxelTriangles& world, const engine::Array<uint>& count, uint32_t first, uint32_t limit, const OctreeCube& cube);
    // Hands the pairs to an octree of the same depth, as its items: their number is state()[kept_word] of lists(). An item is a triangle.
    void record_items(engine::Recorder& recorder, const Octree& octree);

    // The pairs (voxel_key, voxel_triangle_of), their number, and the report of what it took. AppendLists::end() is done.
    const AppendLists& lists() const { return lists_; }

private:
    uint32_t depth_;
    AppendKernel open_;
    engine::Program items_;
    AppendLists lists_;
    Grid grid_;
};

}  // namespace myriad::compute
