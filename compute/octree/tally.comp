#version 460
#extension GL_GOOGLE_include_directive : require
#include "engine/kernel.glsl"
#include "compute/octree/octree_io.h"
layout(push_constant, scalar) uniform Push { OctreeTallyPush push; };

void main() {
    const uint i = thread_index();
    if (i >= push.state.at[0].count[push.level]) return;
    const uint node = push.state.at[0].first[push.level] + i;
    const uint begin = push.first.at[node], end = push.first.at[node + 1u];
    uint sum = end - begin;
    if (push.leaves == 0u) {
        sum = 0u;
        for (uint child = begin; child < end; ++child) sum += push.tally.at[child];
    }
    push.tally.at[node] = sum;
}
