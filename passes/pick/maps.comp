#version 460
#extension GL_GOOGLE_include_directive : require
// Gathers a tile's picks with visibility from the atlas, or with none (specialisation constant 2). A workgroup is a set's pixels of a tile, so each pick is
// read once for all of them.
#include "engine/kernel.glsl"
#include "passes/gather/seen.glsl"
#include "passes/pick/pick_io.h"
layout(constant_id = 2) const bool use_maps = true;
layout(constant_id = glossy_constant) const bool glossy = false;
layout(push_constant, scalar) uniform Push { PickMapsPush push; };

void main() {
    const uint side = push.side_block >> 8, block = push.side_block & 255u;
    const GatherPixel pixel = pick_pixel(workgroup_index(), gl_LocalInvocationIndex, side, block, push.gbuffer.width, push.gbuffer.height);
    if (!pixel.inside) return;
    if (push.has_failed != 0u && push.failed.at[0] != 0u) return;
    const uint p = pixel.y * push.gbuffer.width + pixel.x;
    const vec4 position = push.gbuffer.positions.at[p];
    if (position.w == 0.0f) return;
    const vec3 x = position.xyz;
    const uvec2 normals = push.gbuffer.normals.at[p];
    const vec3 n = unpack_direction(normals.x);
    const vec3 n_g = unpack_direction(normals.y);
    Lobe lobe = matte_lobe();
    if (glossy) lobe = lobe_of(push.gbuffer.gloss.at[p], n);
    const uint pixels = push.gbuffer.width * push.gbuffer.height;

    const uint base = workgroup_index() * push.count;
    // The first pick that is not of an earlier batch.
    uint at = 0u;
    for (uint end = push.first == 0u ? 0u : push.count; at < end;) {
        const uint middle = (at + end) / 2u;
        if (push.picks.at[base + middle].vpl < push.first) at = middle + 1u;
        else end = middle;
    }
    // As in passes/gather: continued in order, so the bits do not depend on batches.
    vec3 sum = push.irradiance.at[p].xyz;
    vec3 mirrored = vec3(0.0f);
    if (glossy) mirrored = push.irradiance.at[pixels + p].xyz;
    for (; at < push.count; ++at) {
        const Pick pick = push.picks.at[base + at];
        if (pick.vpl >= push.end) break;
        if (pick.weight == 0.0f) continue;
        const Vpl vpl = push.vpls.at[pick.vpl];
        const vec3 d = vpl.position - x;
        const Transfer t = transfer_of(x, n, lobe, vpl.position, unpack_direction(vpl.normal), push.bound);
        if (t.diffuse > 0.0f && dot(d, d) <= push.reach2) {
            float seen = pick.weight / pi;
            if (use_maps) seen *= seen_in_map(x, n_g, vpl.position, push.atlas, (pick.vpl - push.first) * map_texels(push.map_size), push.map_size, push.bias);
            sum += vpl.flux * (t.diffuse * seen);
            if (glossy) mirrored += vpl.flux * (t.glossy * seen) * brdf_fresnel(lobe.f0, t.power);
        }
    }
    push.irradiance.at[p] = vec4(min(sum, vec3(gather_most)), 0.0f);
    if (glossy) push.irradiance.at[pixels + p] = vec4(min(mirrored, vec3(gather_most)), 0.0f);
}
