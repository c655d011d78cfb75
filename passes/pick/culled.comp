#version 460
#extension GL_GOOGLE_include_directive : require
// Even picks among what remains (MegaViews 5.1): each invocation makes those that fall on its part's VPLs.
#include "engine/kernel.glsl"
#include "passes/pick/pick_io.h"
layout(push_constant, scalar) uniform Push { PickCulledPush push; };
#include "passes/pick/culled.glsl"

uint tile_index, sets, total, remain, number, rank;
float weight;

uint wanted() { return pick_even(number, total, remain, tile_index, push.shape.seed); }
void found(uint first, uint end) {
    for (; number < total; ++number) {
        const uint at = wanted();
        if (at >= rank + (end - first)) break;
        push.picks.at[pick_slot(number, sets, push.shape.picks, tile_index, push.shape.seed)] = Pick(first + (at - rank), weight);
    }
    rank += end - first;
}

void main() {
    tile_index = thread_index() / push.parts;
    const uint part = thread_index() % push.parts;
    if (tile_index >= push.tile_count) return;
    const PickTile tile = push.tiles.at[tile_index];
    if (tile.radius < 0.0f) return;
    sets = pick_sets(push.shape.block);
    total = sets * push.shape.picks;
    remain = 0u;
    rank = 0u;
    for (uint i = 0u; i < push.parts; ++i) {
        if (i == part) rank = remain;
        remain += push.remain.at[tile_index * push.parts + i];
    }
    if (remain == 0u) {
        for (number = part; number < total; number += push.parts) push.picks.at[pick_slot(number, sets, push.shape.picks, tile_index, push.shape.seed)] = Pick(0u, 0.0f);
        return;
    }
    weight = float(remain) / float(push.shape.picks);
    // The first pick that falls on this part.
    number = uint(max(float(rank) / float(remain) * float(total) - 2.0f, 0.0f));
    while (number < total && wanted() < rank) ++number;
    each_remaining(tile, part * push.part, min((part + 1u) * push.part, push.count.at[0]));
}
