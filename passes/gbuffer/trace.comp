#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a pixel: a ray from the eye through the pixel's centre.
#include "engine/kernel.glsl"
#include "compute/raytrace/trace.glsl"
#include "passes/gbuffer/gbuffer_io.h"
layout(push_constant, scalar) uniform Push { GBufferTracePush push; };

void main() {
    const uint pixel = thread_index();
    if (pixel >= push.width * push.height) return;
    const vec3 direction = camera_direction(push.camera, pixel % push.width, pixel / push.width, push.width, push.height);
    trace_dice = opacity_pixel(pixel % push.width, pixel / push.width);
    const RayHit hit = trace_closest(push.bvh, push.camera.position, direction, 0.0, 1e30);
    push.hits.at[pixel] = RayHitRecord(hit.t, hit.triangle, hit.u, hit.v, hit.front ? 1u : 0u);
    if (trace_exhausted) push.exhausted.at[0] = 1u;
}
