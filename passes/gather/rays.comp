#version 460
#extension GL_GOOGLE_include_directive : require
// Gathers with exact visibility: a shadow ray from each pixel to each VPL of its set. The same-VPL reference of the spec.
#include "engine/kernel.glsl"
#include "compute/raytrace/trace.glsl"
#include "passes/gather/gather_io.h"
layout(constant_id = glossy_constant) const bool glossy = false;
layout(constant_id = gather_omni_constant) const bool omni = false;
layout(push_constant, scalar) uniform Push { GatherRaysPush push; };

void main() {
    const GatherPixel pixel = gather_pixel(workgroup_index(), gl_LocalInvocationIndex, gl_WorkGroupSize.x, push.gbuffer.width,
                                           push.gbuffer.height, push.block);
    const uint p = pixel.inside ? pixel.y * push.gbuffer.width + pixel.x : 0u;
    const vec4 position = push.gbuffer.positions.at[p];
    // Pixels without a receiver stay, and ask for nothing: rays are traced by whole subgroups (trace.glsl).
    const bool receives = pixel.inside && position.w != 0.0f;
    const vec3 x = position.xyz;
    const uvec2 normals = push.gbuffer.normals.at[p];
    const vec3 n = unpack_direction(normals.x);
    const vec3 n_g = unpack_direction(normals.y);
    const vec3 origin = ray_origin(x, n_g, push.bvh.reach);

    Lobe lobe = matte_lobe();
    if (glossy) lobe = lobe_of(push.gbuffer.gloss.at[p], n);
    const uint pixels = push.gbuffer.width * push.gbuffer.height;

    const uint sets = push.block * push.block;
    const float scale = gather_scale(push.block);
    const uint end = min(push.first + push.limit, push.count.at[0]);
    vec3 sum = receives ? push.irradiance.at[p].xyz : vec3(0.0f);  // as in maps.comp
    vec3 mirrored = vec3(0.0f);
    if (glossy && receives) mirrored = push.irradiance.at[pixels + p].xyz;
    for (uint i = push.first + pixel.set; i < end; i += sets) {
        const Vpl vpl = push.vpls.at[i];
        Transfer t;
        if (parallel_views) t = far_transfer(n, n_g, lobe, vpl);
        else if (omni) t = omni_transfer(x, n, n_g, lobe, vpl);
        else t = transfer_of(x, n, lobe, vpl.position, unpack_direction(vpl.normal), push.bound);
        const bool asks = receives && t.diffuse > 0.0f;
        if (!subgroupAny(asks)) continue;
        const vec3 way = parallel_views ? far_direction(vpl) : vpl.position - origin;
        const float far = parallel_views ? 1e30f : omni ? 0.9999f : 1.0f;  // omni: as passes/direct, a lamp that touches a surface is not hidden by it
        if (trace_occluded(push.bvh, origin, way, 0.0f, asks ? far : -1.0f) || !asks) continue;
        sum += vpl.flux * (t.diffuse * scale);
        if (glossy) mirrored += vpl.flux * (t.glossy * scale) * brdf_fresnel(lobe.f0, t.power);
    }
    if (receives) push.irradiance.at[p] = vec4(min(sum, vec3(gather_most)), 0.0f);
    if (glossy && receives) push.irradiance.at[pixels + p] = vec4(min(mirrored, vec3(gather_most)), 0.0f);
    if (trace_exhausted) push.status.at[0] = 1u;
}
