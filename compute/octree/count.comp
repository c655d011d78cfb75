#version 460
#extension GL_GOOGLE_include_directive : require
// How many nodes of each level begin in each tile.
#include "compute/octree/octree.glsl"

void main() {
    const uint tile = group_index(), items = push.count.at[0], columns = sort_columns(sort_tiles(items, tile_items));
    if (tile >= columns) return;  // all of a group
    const uint begin = tile * tile_items, end = min(items, begin + tile_items);
    if (plain_groups) {
        for (uint level = 0u; level <= push.depth; ++level) push.counters.at[level * columns + tile] = 0u;
        uvec2 before = begin > 0u && begin < end ? push.sorted.at[begin - 1u] : uvec2(0u);
        for (uint i = begin; i < end; ++i) {
            const uvec2 key = push.sorted.at[i];
            const uint level = begins(i, before, key);
            if (level <= push.depth) push.counters.at[level * columns + tile] += 1u;
            before = key;
        }
        // An item begins nodes of all levels from its own down.
        uint sum = 0u;
        for (uint level = 0u; level <= push.depth; ++level) {
            sum += push.counters.at[level * columns + tile];
            push.counters.at[level * columns + tile] = sum;
        }
        return;
    }
    uint sums[octree_max_levels];
    [[unroll]] for (uint level = 0u; level < octree_max_levels; ++level) sums[level] = 0u;
    for (uint i = begin + group_lane(); i < end; i += group_size()) {
        const uint from = begins(i, push.sorted.at[max(i, 1u) - 1u], push.sorted.at[i]);
        [[unroll]] for (uint level = 0u; level < octree_max_levels; ++level) sums[level] += from <= level ? 1u : 0u;
    }
    [[unroll]] for (uint level = 0u; level < octree_max_levels; ++level) {
        const uint sum = group_sum(sums[level]);
        if (level <= push.depth && group_elect()) push.counters.at[level * columns + tile] = sum;
    }
}
