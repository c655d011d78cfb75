#version 460
#extension GL_GOOGLE_include_directive : require
#include "engine/kernel.glsl"
#include "compute/instances/instances.glsl"
#include "compute/svo/svo_build.h"
layout(push_constant, scalar) uniform Push { SvoTrianglesPush push; };

void main() {
    const uint i = thread_index();
    if (i >= push.count) return;
    const Corners t = world_corners(push.instances, push.instance_count, push.triangles, push.positions, i);
    push.found.at[i] = SvoTriangle(t, bsh_cone_of(t.p1 - t.p0, t.p2 - t.p0));
}
