#version 460
#extension GL_GOOGLE_include_directive : require
// Whether each ray of a list meets anything.
#include "engine/kernel.glsl"
#include "compute/raytrace/trace.glsl"
layout(push_constant, scalar) uniform Push { RayQueryPush push; };

void main() {
    const uint i = thread_index();
    if (i >= push.count) return;
    const Ray ray = push.rays.at[i];
    push.occluded.at[i] = trace_occluded(push.bvh, ray.origin, ray.direction, ray.t_min, ray.t_max) ? 1u : 0u;
    if (trace_exhausted) push.status.at[0] = 1u;
}
