#version 460
#extension GL_GOOGLE_include_directive : require
// Puts the camera where the node-view kernel reads its views.
#include "engine/kernel.glsl"
#include "passes/points/points_io.h"
layout(push_constant, scalar) uniform Push { PointsViewPush push; };

void main() {
    if (thread_index() != 0u) return;
    push.views.at[0] = push.view;
    push.count.at[0] = 1u;
}
