#include "compute/octree/octree.hpp"

#include <cmath>

#include "compute/kernels.hpp"

namespace myriad::compute {

using engine::compute_kernels;

namespace {

constexpr uint64_t state_words = sizeof(OctreeState) / sizeof(uint);

uint64_t counters_for(uint64_t items, uint32_t depth, const SortShape& shape) {
    return uint64_t(sort_columns(sort_tiles(uint(items), shape.tile))) * (depth + 1);
}

engine::Constants constants(const SortShape& shape) { return {{0, shape.workgroup_size()}, {1, shape.lone_lanes}, {2, shape.tile}}; }

}  // namespace

OctreeCube octree_cube(const vec3& least, const vec3& most, uint32_t depth) {
    const vec3 extent = most - least;
    const float scale = float(1u << depth) / max(extent.x, max(extent.y, extent.z));
    return {.origin = least, .cells_per_length = std::isfinite(scale) ? scale : 0.0f};
}

Octree::Octree(engine::Device& device, uint64_t max_items, uint64_t max_nodes, uint32_t depth, std::optional<SortShape> shape)
    : depth_(depth), max_items_(max_items), max_nodes_(max_nodes), shape_(shape.value_or(SortShape::of(device))),
      make_keys_(device, compute_kernels, "octree/keys"), setup_(device, compute_kernels, "octree/setup"),
      count_(device, compute_kernels, "octree/count", constants(shape_)), finish_(device, compute_kernels, "octree/finish", {{2, shape_.tile}}),
      write_(device, compute_kernels, "octree/write", constants(shape_)), sort_(device, max_items, 64, shape_),
      scan_(device, counters_for(max_items, depth, shape_)), grid_(device), item_keys_(device, "octree", "item keys", max_items),
      keys_(device, "octree", "node keys", max_nodes), item_indices_(device, "octree", "item indices", max_items),
      first_(device, "octree", "first children", max_nodes + 1), counters_(device, "octree", "octree counters", counters_for(max_items, depth, shape_) + 1),
      counts_(device, "octree", "octree counts", 2), state_(device, "octree", "octree state", state_words),
      report_(device, "octree", "octree report", state_words, engine::Location::host), args_(device, "octree", "octree grid", 1) {
    assert(depth <= octree_max_depth && max_items <= max_capacity && max_nodes <= max_capacity);
    assert(uint64_t(shape_.tile) * (depth + 2) < 65535 && "a driver's budget of loop rounds");
}

void Octree::record_keys(engine::Recorder& recorder, const engine::Array<vec4>& points, const engine::Array<uint>& count, uint64_t index,
                         const OctreeCube& cube) {
    grid_.dispatch(recorder, make_keys_, count, index, max_items_, 1, [&] {
        return OctreeKeysPush{.points = recorder.read(points),
                              .keys = recorder.write(item_keys_),
                              .items = recorder.write(item_indices_),
                              .count = recorder.read(count, index),
                              .cube = cube,
                              .depth = depth_,
                              .max_items = uint(max_items_)};
    });
}

void Octree::record(engine::Recorder& recorder, const engine::Array<uint>& count, uint64_t index) {
    const auto sorted = [&] {
        auto scope = recorder.scope("octree sort");
        return sort_.record(recorder, item_keys_, item_indices_, count, index, 3 * depth_);
    }();
    auto scope = recorder.scope("octree nodes");
    sorted_items_ = &sorted.payload;
    recorder.dispatch(setup_,
                      OctreeSetupPush{.item_count = recorder.read(count, index),
                                      .args = recorder.write(args_),
                                      .counts = recorder.write(counts_),
                                      .max_items = uint(max_items_),
                                      .tile = shape_.tile,
                                      .workgroup_size = shape_.workgroup_size(),
                                      .group_size = shape_.group_size(recorder.device()),
                                      .levels = depth_ + 1},
                      1);
    const auto push = [&](bool writes) {
        return OctreeBuildPush{.sorted = recorder.read(sorted.keys),
                               .counters = recorder.write(counters_),
                               .count = recorder.read(counts_, octree_count_items),
                               .first = writes ? recorder.write(first_) : Uints{},
                               .keys = writes ? recorder.write(keys_) : Uint2s{},
                               .state = {writes ? recorder.write(state_).address : 0},
                               .depth = depth_,
                               .capacity = uint(max_nodes_)};
    };
    recorder.dispatch_indirect(count_, push(false), args_);
    scan_.record(recorder, counters_, counts_, octree_count_counters);
    recorder.dispatch(finish_, push(true), 1);
    recorder.dispatch_indirect(write_, push(true), args_);
}

OctreeRef Octree::read(engine::Recorder& recorder) const {
    assert(sorted_items_ && "record() comes first");
    return {.first = recorder.read(first_), .keys = recorder.read(keys_), .items = recorder.read(*sorted_items_), .state = {recorder.read(state_).address}};
}

void Octree::end(engine::Recorder& recorder) const { recorder.copy(state_, report_, report_.bytes()); }

OctreeReport Octree::report() const {
    OctreeReport report;
    std::memcpy(&report.state, report_.span().data(), sizeof report.state);
    return report;
}

}  // namespace myriad::compute
