#version 460
#extension GL_GOOGLE_include_directive : require
// Moves items to their places. A group goes through its tile front to back, so equal digits keep their order.
#include "compute/sort/sort.glsl"

void put(uint at, uvec2 key, uint payload) {
    if (key_words == 2u) Uint2s(push.keys_out).at[at] = key;
    else push.keys_out.at[at] = key.x;
    push.payload_out.at[at] = payload;
}

void main() {
    const uint tile = group_index(), items = push.count.at[0], tiles = sort_tiles(items, tile_items), columns = sort_columns(tiles);
    const uint digits = 1u << push.bits, begin = tile * tile_items, end = tile < tiles ? min(items, begin + tile_items) : 0u;
    if (plain_groups) {
        for (uint i = begin; i < end; ++i) {
            const uvec2 key = key_at(i);
            const uint counter = digit_of(key) * columns + tile, at = push.counters.at[counter];
            push.counters.at[counter] = at + 1u;
            put(at, key, push.payload_in.at[i]);
        }
        return;
    }
    const uint mine = gl_SubgroupID * digits;
    if (tile < tiles)
        for (uint d = group_lane(); d < digits; d += group_size()) counters[mine + d] = push.counters.at[d * columns + tile];
    // As many rounds in every group, whatever it has to do, for group_sync's sake.
    for (uint round = 0u; round < tile_items; round += group_size()) {
        group_sync();
        const uint i = begin + round + group_lane();
        const bool has = i < end;
        uvec2 key = uvec2(0u);
        uint payload = 0u;
        if (has) {
            key = key_at(i);
            payload = push.payload_in.at[i];
        }
        const uint digit = digit_of(key);
        uvec4 peers = subgroupBallot(has);  // lanes with this lane's digit
        for (uint b = 0u; b < push.bits; ++b) {
            const bool one = (digit >> b & 1u) != 0u;
            const uvec4 ones = subgroupBallot(one);
            peers &= one ? ones : ~ones;
        }
        const uint rank = subgroupBallotExclusiveBitCount(peers);
        uint at = 0u;
        if (has && rank == 0u) at = atomicAdd(counters[mine + digit], subgroupBallotBitCount(peers));
        at = subgroupShuffle(at, has ? subgroupBallotFindLSB(peers) : group_lane()) + rank;
        if (has) put(at, key, payload);
    }
}
