#version 460
#extension GL_GOOGLE_include_directive : require
// The closest hit of each ray of a list.
#include "engine/kernel.glsl"
#include "compute/raytrace/trace.glsl"
layout(push_constant, scalar) uniform Push { RayQueryPush push; };

void main() {
    const uint i = thread_index();
    if (i >= push.count) return;
    const Ray ray = push.rays.at[i];
    const RayHit hit = trace_closest(push.bvh, ray.origin, ray.direction, ray.t_min, ray.t_max);
    push.hits.at[i] = RayHitRecord(hit.t, hit.triangle, hit.u, hit.v, hit.front ? 1u : 0u);
    if (trace_exhausted) push.status.at[0] = 1u;
}
