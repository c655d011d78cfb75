#include "compute/view_tree/view_tree.hpp"

#include <algorithm>

#include "compute/kernels.hpp"
#include "compute/octree/octree.hpp"

namespace myriad::compute {

using engine::compute_kernels;

namespace {

// Each inner node with inner children has two at least, and each without holds a view at least.
uint32_t inner_nodes(uint32_t views) { return 2 * std::max(views, 1u); }

}  // namespace

uint32_t ViewTree::node_count(uint32_t capacity) { return capacity + inner_nodes(capacity); }

ViewTree::ViewTree(engine::Device& device, uint32_t capacity)
    : capacity_(capacity), keys_kernel_(device, compute_kernels, "view_tree/keys"), place_(device, compute_kernels, "view_tree/place"),
      merge_(device, compute_kernels, "view_tree/merge"), split_(device, compute_kernels, "view_tree/split"), sort_(device, capacity, 64),
      lists_(device, AppendMode::scan, capacity, 1), grid_(device), keys_(device, "view tree", "keys of views", capacity),
      order_(device, "view tree", "order of views", capacity), levels_(device, "view tree", "levels of views", 2 * (view_tree_levels + 1)),
      nodes_(device, "view tree", "nodes of views", node_count(capacity)), groups_(device, "view tree", "groups of views", inner_nodes(capacity)),
      boxes_(device, "view tree", "boxes of views", inner_nodes(capacity)) {
    assert(capacity > 0 && capacity <= most_views);
}

void ViewTree::record(engine::Recorder& recorder, const engine::Array<View>& views, const engine::Array<uint>& count, vec3 low, vec3 high) {
    recorder.dispatch(keys_kernel_,
                      ViewKeysPush{.views = recorder.read(views), .count = recorder.read(count), .keys = recorder.write(keys_),
                                   .order = recorder.write(order_), .cube = octree_cube(low, high, view_tree_curve_bits), .limit = capacity_},
                      capacity_);
    const auto sorted = sort_.record(recorder, keys_, order_, count, 0, 3 * view_tree_curve_bits);
    sorted_ = &sorted.payload;
    recorder.dispatch(place_,
                      ViewPlacePush{.views = recorder.read(views), .count = recorder.read(count), .order = recorder.read(*sorted_),
                                    .nodes = recorder.write(nodes_), .limit = capacity_},
                      capacity_);
    recorder.fill(levels_, 0);
    lists_.begin(recorder, split_, count, 0, 1);
    for (uint32_t level = 0; level < view_tree_levels; ++level)
        lists_.step(recorder, split_, 1, [&](const AppendRef& ref) {
            return ViewSplitPush{.lists = ref, .keys = recorder.read(sorted.keys), .count = recorder.read(count), .groups = recorder.write(groups_),
                                 .levels = {recorder.write(levels_).address}, .level = level, .capacity = capacity_, .inner = inner_capacity()};
        });
    for (uint32_t level = view_tree_levels; level-- > 0;)
        grid_.dispatch(recorder, merge_, levels_, count_word(level), inner_capacity(), 1, [&] {
            return ViewMergePush{.nodes = recorder.write(nodes_), .groups = recorder.write(groups_), .boxes = recorder.write(boxes_),
                                 .levels = read_levels(recorder), .level = level, .capacity = capacity_, .inner = inner_capacity()};
        });
}

}  // namespace myriad::compute
