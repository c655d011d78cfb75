#version 460
#extension GL_GOOGLE_include_directive : require
// How often each digit occurs in each tile.
#include "compute/sort/sort.glsl"

void main() {
    const uint tile = group_index(), items = push.count.at[0], columns = sort_columns(sort_tiles(items, tile_items));
    const uint digits = 1u << push.bits, begin = tile * tile_items, end = tile < columns ? min(items, begin + tile_items) : 0u;
    if (plain_groups) {
        if (tile >= columns) return;
        for (uint d = 0u; d < digits; ++d) push.counters.at[d * columns + tile] = 0u;
        for (uint i = begin; i < end; ++i) push.counters.at[digit_at(i) * columns + tile] += 1u;
        return;
    }
    const uint mine = gl_SubgroupID * digits;
    for (uint d = group_lane(); d < digits; d += group_size()) counters[mine + d] = 0u;
    group_sync();
    for (uint i = begin + group_lane(); i < end; i += group_size()) atomicAdd(counters[mine + digit_at(i)], 1u);
    group_sync();
    if (tile < columns)
        for (uint d = group_lane(); d < digits; d += group_size()) push.counters.at[d * columns + tile] = counters[mine + d];
}
