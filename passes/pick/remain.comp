#version 460
#extension GL_GOOGLE_include_directive : require
// How many VPLs of each part remain for each tile (MegaViews 5.1).
#include "engine/kernel.glsl"
#include "passes/pick/pick_io.h"
layout(push_constant, scalar) uniform Push { PickCulledPush push; };
#include "passes/pick/culled.glsl"

uint remaining = 0u;
void found(uint first, uint end) { remaining += end - first; }

void main() {
    const uint tile = thread_index() / push.parts, part = thread_index() % push.parts;
    if (tile >= push.tile_count) return;
    each_remaining(push.tiles.at[tile], part * push.part, min((part + 1u) * push.part, push.count.at[0]));
    push.remain.at[thread_index()] = remaining;
}
