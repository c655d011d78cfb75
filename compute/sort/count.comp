#version 460
#extension GL_GOOGLE_include_directive : require
// How often each digit occurs in each tile.
#include "compute/sort/sort.glsl"

void main() {
    const uint tile = group_index(), items = push.count.at[0], tiles = sort_tiles(items, tile_items);
    const uint digits = 1u << push.bits, begin = tile * tile_items;
    if (plain_groups) {
        if (tile >= tiles) return;
        for (uint d = 0u; d < digits; ++d) push.counters.at[d * tiles + tile] = 0u;
        const uint end = min(items, begin + tile_items);
        for (uint i = begin; i < end; ++i) push.counters.at[digit_of(key_at(i)) * tiles + tile] += 1u;
        return;
    }
    const uint mine = gl_SubgroupID * digits, end = tile < tiles ? min(items, begin + tile_items) : 0u;
    for (uint d = group_lane(); d < digits; d += group_size()) counters[mine + d] = 0u;
    group_sync();
    for (uint i = begin + group_lane(); i < end; i += group_size()) atomicAdd(counters[mine + digit_of(key_at(i))], 1u);
    group_sync();
    if (tile < tiles)
        for (uint d = group_lane(); d < digits; d += group_size()) push.counters.at[d * tiles + tile] = counters[mine + d];
}
