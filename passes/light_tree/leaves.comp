#version 460
#extension GL_GOOGLE_include_directive : require
// Lights in the order of the curve, and as leaves.
#include "engine/kernel.glsl"
#include "passes/light_tree/light_tree_io.h"
layout(push_constant, scalar) uniform Push { LightLeavesPush push; };

void main() {
    const uint i = thread_index();
    if (i >= min(push.count.at[0], push.limit)) return;
    const Vpl light = push.lights.at[push.order.at[i]];
    push.ordered.at[i] = light;
    push.nodes.at[i] = light_leaf(light);
}
