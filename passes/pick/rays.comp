#version 460
#extension GL_GOOGLE_include_directive : require
// Gathers a tile's picks with exact visibility: a shadow ray from each pixel to each pick of its set.
#include "engine/kernel.glsl"
#include "compute/raytrace/trace.glsl"
#include "passes/pick/pick_io.h"
layout(constant_id = glossy_constant) const bool glossy = false;
layout(push_constant, scalar) uniform Push { PickRaysPush push; };

void main() {
    const uint side = push.side_block_count >> 24, block = push.side_block_count >> 16 & 255u, count = push.side_block_count & 65535u;
    const GatherPixel pixel = pick_pixel(workgroup_index(), gl_LocalInvocationIndex, side, block, push.gbuffer.width, push.gbuffer.height);
    const uint p = pixel.inside ? pixel.y * push.gbuffer.width + pixel.x : 0u;
    const vec4 position = push.gbuffer.positions.at[p];
    // As in passes/gather: who has nothing to ask stays, rays are traced by whole subgroups.
    const bool receives = pixel.inside && position.w != 0.0f;
    const vec3 x = position.xyz;
    const uvec2 normals = push.gbuffer.normals.at[p];
    const vec3 n = unpack_direction(normals.x);
    const vec3 origin = ray_origin(x, unpack_direction(normals.y), push.bvh.reach);
    Lobe lobe = matte_lobe();
    if (glossy) lobe = lobe_of(push.gbuffer.gloss.at[p], n);
    const uint pixels = push.gbuffer.width * push.gbuffer.height;

    vec3 sum = receives ? push.irradiance.at[p].xyz : vec3(0.0f);
    vec3 mirrored = vec3(0.0f);
    if (glossy && receives) mirrored = push.irradiance.at[pixels + p].xyz;
    // A tile without receivers has no picks.
    const bool any = subgroupAny(receives);
    for (uint at = push.first_end >> 16; any && at < (push.first_end & 65535u); ++at) {
        const Pick pick = push.picks.at[workgroup_index() * count + at];
        if (pick.weight == 0.0f) continue;
        const Vpl vpl = push.vpls.at[pick.vpl];
        const vec3 d = vpl.position - x;
        const Transfer t = transfer_of(x, n, lobe, vpl.position, unpack_direction(vpl.normal), push.bound);
        const bool asks = receives && t.diffuse > 0.0f && dot(d, d) <= push.reach2;
        if (!subgroupAny(asks)) continue;
        if (trace_occluded(push.bvh, origin, vpl.position - origin, 0.0f, asks ? 1.0f : -1.0f) || !asks) continue;
        sum += vpl.flux * (t.diffuse * (pick.weight / pi));
        if (glossy) mirrored += vpl.flux * (t.glossy * (pick.weight / pi)) * brdf_fresnel(lobe.f0, t.power);
    }
    if (receives) push.irradiance.at[p] = vec4(min(sum, vec3(gather_most)), 0.0f);
    if (glossy && receives) push.irradiance.at[pixels + p] = vec4(min(mirrored, vec3(gather_most)), 0.0f);
    if (trace_exhausted) push.status.at[0] = 1u;
}
