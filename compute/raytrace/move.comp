#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a triangle that moves.
#include "engine/kernel.glsl"
#include "compute/raytrace/bvh_pack.h"
layout(push_constant, scalar) uniform Push { BvhMovePush push; };

void main() {
    const uint i = thread_index();
    if (i >= push.count) return;
    const uvec2 moving = push.moving.at[i];
    const uvec4 corners = push.triangles.at[moving.y];
    push.tree.at[moving.x].p0 = push.positions.at[corners.x];
    push.tree.at[moving.x].p1 = push.positions.at[corners.y];
    push.tree.at[moving.x].p2 = push.positions.at[corners.z];
}
