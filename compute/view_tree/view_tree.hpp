// A tree over views, built on the device in every frame; see README.md.
#pragma once

#include "compute/append/append.hpp"
#include "compute/append/grid.hpp"
#include "compute/sort/sort.hpp"
#include "compute/view_tree/view_tree_io.h"

namespace myriad::compute {

class ViewTree {
public:
    static constexpr uint32_t most_views = uint32_t(1) << 20;  // so that cuts can tell all nodes apart (cut_max_views)

    // For up to `capacity` views.
    ViewTree(engine::Device& device, uint32_t capacity);

    // Builds the tree of the first min(count[0], capacity()) views. `low`, `high`: a box that most of them are in, where the curve goes.
    void record(engine::Recorder& recorder, const engine::Array<View>& views, const engine::Array<uint>& count, vec3 low, vec3 high);

    uint32_t capacity() const { return capacity_; }
    static uint32_t node_count(uint32_t capacity);  // room that nodes() of so many views have
    // There are at most so many: each has two children or more that are inner nodes, or none.
    uint32_t inner_capacity() const { return uint32_t(groups_.count()); }
    // By place along the curve: which of the views that were given.
    const engine::Array<uint>& order() const { return sorted_ ? *sorted_ : order_; }
    // By node. Nodes [0, count[0]) are the views, in order(); the root is node capacity().
    const engine::Array<View>& nodes() const { return nodes_; }
    const engine::Array<ViewGroup>& groups() const { return groups_; }  // by inner node: node - capacity()
    // As words, a ViewLevel each, view_tree_levels of them.
    const engine::Array<uint>& levels() const { return levels_; }
    ViewLevels read_levels(engine::Recorder& recorder) const { return {recorder.read(levels_).address}; }
    static constexpr uint64_t count_word(uint32_t level) { return 2 * level + 1; }  // of levels(): how many nodes a level has

private:
    uint32_t capacity_;
    engine::Program keys_kernel_, place_, merge_;
    AppendKernel split_;
    Sort sort_;
    AppendLists lists_;
    Grid grid_;
    engine::Array<uvec2> keys_;
    engine::Array<uint> order_, levels_;
    const engine::Array<uint>* sorted_ = nullptr;  // the order, wherever the sort left it
    engine::Array<View> nodes_;
    engine::Array<ViewGroup> groups_;
    engine::Array<ViewBox> boxes_;
};

}  // namespace myriad::compute
