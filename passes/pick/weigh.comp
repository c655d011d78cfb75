#version 460
#extension GL_GOOGLE_include_directive : require
// What the first inner nodes may bring to a tile, by that of their children: of all that pick/sum does not add up. A workgroup has one node and many tiles: the
// children are read once for all of them.
#include "engine/kernel.glsl"
#include "passes/pick/pick_io.h"
layout(push_constant, scalar) uniform Push { PickWeighPush push; };

void main() {
    const uint n = workgroup_index() % push.limit;
    const uint tile_index = workgroup_index() / push.limit * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    uint count = 0u;
    for (uint level = 0u; level < view_tree_levels; ++level) count += push.levels.at[level].count;
    if (n >= count) return;
    const LightNode node = push.nodes.at[push.capacity + n];
    if (pick_summed(node, push.capacity, push.limit) || tile_index >= push.tile_count) return;
    const PickTile tile = push.tiles.at[tile_index];
    if (tile.radius < 0.0f) return;
    float sum = 0.0f;
    for (uint i = 0u; i < light_child_count(node); ++i) sum += pick_importance(tile, push.nodes.at[light_first_child(node) + i], push.bound);
    push.weights.at[tile_index * push.limit + n] = sum;
}
