#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a triangle without normals of its own, once its corners are where they are.
#include "engine/kernel.glsl"
#include "passes/deform/deform_io.h"
layout(push_constant, scalar) uniform Push { DeformFlatPush push; };

void main() {
    if (thread_index() >= push.count) return;
    const uint i = push.flat_triangles.at[thread_index()];
    const vec3 normal = flat_normal(push.positions.at[i], push.positions.at[i + 1u], push.positions.at[i + 2u]);
    for (uint k = 0u; k < 3u; ++k) push.normals.at[i + k] = normal;
}
