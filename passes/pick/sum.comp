#version 460
#extension GL_GOOGLE_include_directive : require
// The first inner nodes of a tile whose children have their weights, from the last one up.
#include "engine/kernel.glsl"
#include "passes/pick/pick_io.h"
layout(push_constant, scalar) uniform Push { PickWeighPush push; };

void main() {
    const uint tile_index = thread_index();
    if (tile_index >= push.tile_count || push.tiles.at[tile_index].radius < 0.0f) return;
    uint count = 0u;
    for (uint level = 0u; level < view_tree_levels; ++level) count += push.levels.at[level].count;
    const uint base = tile_index * push.limit;
    for (uint n = min(count, push.limit); n-- > 0u;) {
        const LightNode node = push.nodes.at[push.capacity + n];
        if (!pick_summed(node, push.capacity, push.limit)) continue;
        float sum = 0.0f;
        for (uint i = 0u; i < light_child_count(node); ++i) sum += push.weights.at[base + light_first_child(node) - push.capacity + i];
        push.weights.at[base + n] = sum;
    }
}
