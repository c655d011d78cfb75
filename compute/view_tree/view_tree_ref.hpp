// The plain CPU twin: the same tree by recursion on sorted keys, and what must hold of any.
#pragma once

#include <string>
#include <vector>

#include "compute/view_tree/view_tree.hpp"

namespace myriad::compute {

struct HostViewTree {
    uint32_t capacity = 0;
    std::vector<uint> order;
    std::vector<View> nodes;          // as ViewTree::nodes(); those past the end are undefined
    std::vector<ViewGroup> groups;    // as many as there are inner nodes
    std::vector<ViewLevel> levels;

    uint32_t views() const { return uint32_t(order.size()); }
    bool is_view(uint node) const { return node < capacity; }
    const ViewGroup& group(uint node) const { return groups[node - capacity]; }
    float radius(uint node) const { return is_view(node) ? 0 : group(node).radius; }
};

HostViewTree view_tree_ref(const std::vector<View>& views, uint32_t capacity, vec3 low, vec3 high);
HostViewTree view_tree_download(engine::Device& device, const ViewTree& tree, uint32_t views);

// The first thing that is wrong with a tree of these views; empty: nothing. Every view is in one leaf, ranges are their children's, spheres hold
// places, cones hold frustums.
std::string view_tree_violation(const HostViewTree& tree, const std::vector<View>& views);

}  // namespace myriad::compute
