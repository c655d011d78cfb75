#version 460
#extension GL_GOOGLE_include_directive : require
#include "engine/kernel.glsl"
#include "passes/gathering/gathering_io.h"
layout(push_constant, scalar) uniform Push { ReorderPush push; };

void main() {
    const uint i = thread_index();
    if (i >= min(push.count.at[0], push.limit)) return;
    const uint light = push.order.at[i];
    const uint set = light % push.sets_count;
    push.reordered.at[i] = push.lights.at[light];
    push.sets.at[i] = set;
    push.listed.at[i] = (set << gather_listed_bits) | i;
}
