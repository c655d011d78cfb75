// The plain CPU twin of the double traversal, and what must hold of its pairs.
#pragma once

#include <string>
#include <vector>

#include "compute/manylods/manylods_ref.hpp"
#include "compute/megaviews/megaviews.hpp"
#include "compute/view_tree/view_tree_ref.hpp"

namespace myriad::compute {

// A terminal pair; ordered by view node, then slot.
struct TerminalPair {
    uint node, slot;
    bool culled, edge_on = false;
    auto operator<=>(const TerminalPair&) const = default;
};
void PrintTo(const TerminalPair& pair, std::ostream* out);

struct PairsRef {
    std::vector<TerminalPair> pairs;  // sorted
    uint64_t tested = 0, shared = 0;
};
// `rendered`: neither culled nor edge-on. By recursion, for views [first, end) along the curve.
PairsRef pairs_ref(const HostTree& tree, const HostViewTree& views, uint first, uint end, float epsilon, uint map_size);

// Rendered pairs of a kept list, taken apart and sorted.
std::vector<TerminalPair> rendered_pairs(const std::vector<uvec2>& groups, uint arity = bsh_arity_default);

// The first (leaf, view) of those wanted that is below no pair, or below several (spec, invariant 5), or that is culled though the view sees something
// of the leaf's sphere (invariant 6), by brute force. Empty: none.
std::string pairs_violation(const HostTree& tree, const HostViewTree& views, uint first, uint end, const std::vector<TerminalPair>& pairs);

}  // namespace myriad::compute
