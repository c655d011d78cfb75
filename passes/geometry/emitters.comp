#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation an emissive triangle that moves: its area.
#include "engine/kernel.glsl"
#include "passes/geometry/geometry_io.h"
#include "passes/geometry/light_io.h"
layout(push_constant, scalar) uniform Push { EmittersPush push; };

void main() {
    if (thread_index() >= push.count) return;
    const Emitter emitter = push.emitters.at[thread_index()];
    const uvec4 corners = push.triangles.at[emitter.triangle];
    const vec3 p0 = push.positions.at[corners.x];
    const vec3 normal = cross(push.positions.at[corners.y] - p0, push.positions.at[corners.z] - p0);
    push.lights.at[emitter.light].extent.x = 0.5 * emitter.sides * sqrt(dot(normal, normal));
}
