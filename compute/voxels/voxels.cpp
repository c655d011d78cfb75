#include "compute/voxels/voxels.hpp"

#include "compute/kernels.hpp"

namespace myriad::compute {

using engine::compute_kernels;

Voxels::Voxels(engine::Device& device, AppendMode mode, uint32_t depth, uint64_t next_capacity, uint64_t kept_capacity, const engine::Constants& constants)
    : depth_(depth), open_(device, compute_kernels, "voxels/open", constants), items_(device, compute_kernels, "voxels/items"),
      lists_(device, mode, next_capacity, kept_capacity), grid_(device) {
    assert(depth >= 1 && depth <= voxels_max_depth);
}

void Voxels::record(engine::Recorder& recorder, const VoxelTriangles& world, const engine::Array<uint>& count, uint32_t first, uint32_t limit,
                    const OctreeCube& cube) {
    assert(uint64_t(first) + limit <= max_triangles);
    lists_.begin(recorder, open_, count, first, limit);
    for (uint32_t level = 0; level < depth_; ++level)
        lists_.step(recorder, open_, 1, [&](const AppendRef& lists) {
            return VoxelsPush{.lists = lists,
                              .positions = recorder.read(world.positions),
                              .triangles = recorder.read(world.triangles),
                              .instances = world.instances ? recorder.read(*world.instances) : Instances{},
                              .cube = cube,
                              .instance_count = world.instance_count,
                              .first_triangle = first,
                              .level = level,
                              .depth = depth_};
        });
    lists_.end(recorder);
}

void Voxels::record_items(engine::Recorder& recorder, const Octree& octree) {
    assert(octree.depth() == depth_);
    assert(octree.max_items() <= lists_.kept_capacity() && "where the list overflows, the octree would take what was never written");
    const uint64_t limit = octree.max_items();
    grid_.dispatch(recorder, items_, lists_.state(), AppendLists::kept_word, limit, 1, [&] {
        return VoxelItemsPush{.pairs = recorder.read(lists_.kept()),
                              .count = recorder.read(lists_.state(), AppendLists::kept_word),
                              .keys = recorder.write(octree.item_keys()),
                              .items = recorder.write(octree.item_indices()),
                              .max_items = uint(limit)};
    });
}

}  // namespace myriad::compute
