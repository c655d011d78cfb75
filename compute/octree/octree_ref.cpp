#include "compute/octree/octree_ref.hpp"

#include <algorithm>
#include <numeric>
#include <set>

namespace myriad::compute {

// Each level by itself: the set of its cells; and children are looked up.
OctreeTwin octree_ref(const std::vector<uint64_t>& item_keys, uint depth) {
    OctreeTwin tree{.depth = depth};
    tree.items.resize(item_keys.size());
    std::iota(tree.items.begin(), tree.items.end(), 0u);
    std::stable_sort(tree.items.begin(), tree.items.end(), [&](uint a, uint b) { return item_keys[a] < item_keys[b]; });
    for (uint level = 0; level <= depth; ++level) {
        std::set<uint64_t> cells;
        for (const uint64_t key : item_keys) cells.insert(key >> 3 * (depth - level));
        tree.level_first.push_back(uint(tree.nodes()));
        tree.keys.insert(tree.keys.end(), cells.begin(), cells.end());
    }
    tree.level_first.push_back(uint(tree.nodes()));
    for (uint level = 0; level <= depth; ++level)
        for (uint node = tree.level_first[level]; node < tree.level_first[level + 1]; ++node) {
            if (level < depth) {
                const auto below = tree.keys.begin() + tree.level_first[level + 1], end = tree.keys.begin() + tree.level_first[level + 2];
                tree.first.push_back(uint(std::lower_bound(below, end, tree.keys[node] << 3) - tree.keys.begin()));
            } else {
                const auto at = std::lower_bound(tree.items.begin(), tree.items.end(), tree.keys[node], [&](uint i, uint64_t key) { return item_keys[i] < key; });
                tree.first.push_back(uint(tree.nodes()) + uint(at - tree.items.begin()));
            }
        }
    tree.first.push_back(uint(tree.nodes() + tree.items.size()));
    return tree;
}

std::string octree_check(const OctreeTwin& tree, const std::vector<uint64_t>& item_keys) {
    const auto node_name = [](uint level, uint node) { return "node " + std::to_string(node) + " of level " + std::to_string(level); };
    const uint nodes = uint(tree.nodes()), items = uint(item_keys.size());
    if (tree.level_first.size() != tree.depth + 2 || tree.level_first.front() != 0 || tree.level_first.back() != nodes) return "levels do not hold all nodes";
    if (tree.first.size() != nodes + 1 || tree.first.back() != nodes + tree.items.size()) return "the last leaf does not end with the items";
    if (tree.items.size() != items) return "as many items as keys are not there";
    if (tree.level_first[1] != (items ? 1u : 0u)) return "the root is not one node";
    std::vector<bool> found(items);
    for (uint level = 0; level <= tree.depth; ++level) {
        uint next = tree.level_first[level + 1];  // child
        for (uint node = tree.level_first[level]; node < tree.level_first[level + 1]; ++node) {
            if (node > tree.level_first[level] && tree.keys[node - 1] >= tree.keys[node]) return node_name(level, node) + " is not behind the one before";
            const uint begin = tree.first[node], end = tree.first[node + 1];
            if (begin != next) return node_name(level, node) + ": its children do not follow those of the one before";
            if (end <= begin) return node_name(level, node) + " is empty";
            if (level < tree.depth && end > tree.level_first[level + 2]) return node_name(level, node) + ": its children are beyond the next level";
            for (uint child = begin; child < end; ++child) {
                if (level < tree.depth) {
                    if (tree.keys[child] >> 3 != tree.keys[node]) return node_name(level, node) + ": a child's key does not extend its own";
                    continue;
                }
                const uint item = tree.items[child - nodes];
                if (item >= items || found[item]) return "item " + std::to_string(item) + " is in two leaves, or does not exist";
                found[item] = true;
                if (item_keys[item] != tree.keys[node]) return "item " + std::to_string(item) + " has another key than its leaf";
            }
            next = end;
        }
        const uint all = level < tree.depth ? tree.level_first[level + 2] : nodes + items;
        if (next != all && tree.level_first[level] != tree.level_first[level + 1]) return "nodes of level " + std::to_string(level + 1) + " have no parent";
    }
    if (std::find(found.begin(), found.end(), false) != found.end()) return "an item is in no leaf";
    return "";
}

}  // namespace myriad::compute
