// The plain CPU twin of the octree builder, and what every octree must satisfy.
#pragma once

#include <string>
#include <vector>

#include "compute/octree/octree_io.h"

namespace myriad::compute {

struct OctreeTwin {
    uint depth = 0;
    std::vector<uint> level_first;  // of each level, and behind the last: depth + 2
    std::vector<uint> first, items;
    std::vector<uint64_t> keys;
    size_t nodes() const { return keys.size(); }
};

// Of items with these keys (below 2^(3 depth)).
OctreeTwin octree_ref(const std::vector<uint64_t>& item_keys, uint depth);

// The first violated invariant, or nothing: levels' nodes are distinct and in Morton order; the root is one node, if there is an item; children of all nodes are
// all nodes of the next level and their keys extend their parents'; no node is empty; every item is in exactly one leaf, whose key it has.
std::string octree_check(const OctreeTwin& tree, const std::vector<uint64_t>& item_keys);

}  // namespace myriad::compute
