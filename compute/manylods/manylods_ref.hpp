// The plain CPU twin: a sequential recursion over the same tree, view by view.
#pragma once

#include <string>
#include <vector>

#include "compute/bsh/bsh.hpp"
#include "compute/manylods/manylods_io.h"

namespace myriad::compute {

// The tree's arrays, as read back from the device, by block and by slot.
struct HostTree : BshShape {
    std::vector<vec4> frames;
    std::vector<uvec2> spheres;
    std::vector<uint> cones;
    // Of an octree, which has no arithmetic for them; its root is in slot 0, and `leaves` are slots that may hold one.
    std::vector<uint> heights;       // of a block's children
    std::vector<uint> child_blocks;  // by slot

    HostTree() = default;
    HostTree(engine::Device& device, const Bsh& tree);
    bool is_octree() const { return !heights.empty(); }
    uint root() const { return is_octree() ? 0 : BshShape::root(); }
    uint height(uint slot) const { return is_octree() ? heights[slot >> arity_log2] : bsh_height(slot, *this); }
    bool is_leaf(uint slot) const { return is_octree() ? height(slot) == 0 : bsh_is_leaf(slot, leaves); }
    uint block_of(uint slot) const { return is_octree() ? child_blocks[slot] : bsh_block_of(slot, *this); }
    Sphere sphere(uint slot) const { return bsh_decode(frames[slot >> arity_log2], spheres[slot]); }
    bool absent(uint slot) const { return bsh_is_absent(spheres[slot]); }
};

// One node-view of a cut; ordered by view, then slot.
struct NodeView {
    uint view, slot;
    bool culled;
    auto operator<=>(const NodeView&) const = default;
};
void PrintTo(const NodeView& nv, std::ostream* out);

struct CutRef {
    std::vector<NodeView> cut;  // sorted
    uint64_t tested = 0;        // node-views
};
CutRef cut_ref(const HostTree& tree, const std::vector<View>& views, float epsilon, uint map_size);

// A cut's groups, taken apart and sorted.
std::vector<NodeView> node_views(const std::vector<uvec2>& groups, uint arity = bsh_arity_default);

// The first violation of the partition invariant (spec, section 3): every leaf has exactly one ancestor-or-self in the cut of
// every view. Empty: none.
std::string partition_violation(const HostTree& tree, const std::vector<NodeView>& cut, uint views);

}  // namespace myriad::compute
