#version 460
#extension GL_GOOGLE_include_directive : require
// Where each view lies along the curve. Those that see nothing come last: their places are no places.
#include "engine/kernel.glsl"
#include "compute/view_tree/view_tree_io.h"
layout(push_constant, scalar) uniform Push { ViewKeysPush push; };

void main() {
    const uint i = thread_index();
    if (i >= min(push.count.at[0], push.limit)) return;
    push.keys.at[i] = view_key(push.views.at[i], push.cube);
    push.order.at[i] = i;
}
