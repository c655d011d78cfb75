#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a pixel: the surface that its ray hit.
#include "engine/kernel.glsl"
#include "passes/gbuffer/gbuffer_io.h"
#include "passes/geometry/surface.glsl"
layout(push_constant, scalar) uniform Push { GBufferShadePush push; };

void main() {
    const uint pixel = thread_index();
    if (pixel >= push.count) return;
    const RayHitRecord hit = push.hits.at[pixel];
    if (hit.triangle == ~0u) {
        push.positions.at[pixel] = vec4(0.0);
        push.normals.at[pixel] = uvec2(0u);
        push.albedo.at[pixel] = vec4(0.0);
        push.emitted.at[pixel] = vec4(push.background, 0.0);
        if (push.has_gloss != 0u) push.gloss.at[pixel] = Gloss(0u, 0u, 0u);
        return;
    }
    Surface s = surface_at(push.geometry, hit.triangle, hit.u, hit.v);
    // The direction from the point itself, which is more exact than the ray's where the eye is close; the eye on the
    // surface has none and takes the camera's.
    const vec3 seen = s.position - push.eye;
    const vec3 direction = unit_or(seen, push.forward);
    s = face_towards(s, direction);
    // Never 0, which would say that nothing is here.
    push.positions.at[pixel] = vec4(s.position, max(dot(seen, push.forward), 1e-30));
    push.normals.at[pixel] = uvec2(pack_direction(s.shading_normal), pack_direction(s.geometric_normal));
    push.albedo.at[pixel] = vec4(s.albedo, s.reach);
    push.emitted.at[pixel] = vec4(s.emission, 0.0);
    if (push.has_gloss != 0u) push.gloss.at[pixel] = pack_gloss(s.f0, s.roughness, -direction);
}
