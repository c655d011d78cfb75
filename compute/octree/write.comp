#version 460
#extension GL_GOOGLE_include_directive : require
// Writes the nodes. Levels are gone through from the leaves up, so that each node's first child is known.
#include "compute/octree/octree.glsl"

void put(uint at, uint first_child, uvec2 key, uint level) {
    push.first.at[at] = first_child;
    push.keys.at[at] = octree_ancestor(key, push.depth - level);
}

void main() {
    const uint tile = group_index(), items = push.count.at[0], columns = sort_columns(sort_tiles(items, tile_items));
    const uint begin = tile * tile_items, end = min(items, begin + tile_items);
    const uint nodes = push.counters.at[(push.depth + 1u) * columns];
    if (begin >= end || nodes > push.capacity) return;  // all of a group
    if (plain_groups) {
        uvec2 before = begin > 0u ? push.sorted.at[begin - 1u] : uvec2(0u);
        for (uint i = begin; i < end; ++i) {
            const uvec2 key = push.sorted.at[i];
            const uint from = begins(i, before, key);
            uint first_child = nodes + i;
            for (uint level = push.depth + 1u; level > from; --level) {
                const uint counter = (level - 1u) * columns + tile, at = push.counters.at[counter];
                push.counters.at[counter] = at + 1u;
                put(at, first_child, key, level - 1u);
                first_child = at;
            }
            before = key;
        }
        return;
    }
    uint next[octree_max_levels];
    [[unroll]] for (uint level = 0u; level < octree_max_levels; ++level) next[level] = level <= push.depth ? push.counters.at[level * columns + tile] : 0u;
    // The rounds are uniform over the group: lanes past the end take part with nothing.
    for (uint base = begin; base < end; base += group_size()) {
        const uint i = base + group_lane();
        uvec2 key = uvec2(0u);
        uint from = push.depth + 1u, first_child = nodes + i;
        if (i < end) {
            key = push.sorted.at[i];
            from = begins(i, push.sorted.at[max(i, 1u) - 1u], key);
        }
        [[unroll]] for (uint up = 0u; up < octree_max_levels; ++up) {
            const uint level = octree_max_levels - 1u - up;
            const uint one = from <= level && level <= push.depth ? 1u : 0u;
            const uint at = next[level] + group_exclusive_sum(one);
            next[level] += group_sum(one);
            if (one != 0u) {
                put(at, first_child, key, level);
                first_child = at;
            }
        }
    }
}
