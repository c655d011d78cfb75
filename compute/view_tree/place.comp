#version 460
#extension GL_GOOGLE_include_directive : require
// Views in the order of the curve.
#include "engine/kernel.glsl"
#include "compute/view_tree/view_tree_io.h"
layout(push_constant, scalar) uniform Push { ViewPlacePush push; };

void main() {
    const uint i = thread_index();
    if (i >= min(push.count.at[0], push.limit)) return;
    push.nodes.at[i] = push.views.at[push.order.at[i]];
}
