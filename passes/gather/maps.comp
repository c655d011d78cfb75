#version 460
#extension GL_GOOGLE_include_directive : require
// Gathers with visibility from the atlas, or with none (specialisation constant 2). One invocation a pixel.
#include "engine/kernel.glsl"
#include "passes/gather/seen.glsl"
layout(constant_id = 2) const bool use_maps = true;
layout(constant_id = glossy_constant) const bool glossy = false;
layout(constant_id = gather_omni_constant) const bool omni = false;
layout(constant_id = gather_listed_constant) const bool listed = false;
layout(constant_id = gather_asks_constant) const bool asks = false;
layout(push_constant, scalar) uniform Push { GatherPush push; };

float depth_in_both(MapQuery q, int right, int below, uint map, SharedMap above, uint index) {
    const float own = uintBitsToFloat(push.atlas.at[map + index]);
    if (above.first == fuse_no_map) return own;
    const float far = uintBitsToFloat(push.atlas.at[above.first + index]);
    return min(own, fused_depth(above.offset, map_texel_towards(q, right, below, gather_map_size_of(push.sides)), far));  // infinity stays what it is
}
float seen_in_both_texels(MapQuery q, int right, int below, uint map, SharedMap above) {
    const MapTexel t = map_texel(q, right, below, gather_map_size_of(push.sides));
    return map_seen(depth_in_both(q, right, below, map, above, t.index), t);
}
// As seen_in_map, where the map is not fused with what its view shares.
float seen_in_both(vec3 x, vec3 n_g, vec3 vpl_position, uint map, SharedMap above) {
    const MapQuery q = map_query(x, n_g, vpl_position, gather_map_size_of(push.sides), push.bias);
    return map_blend(q, vec4(seen_in_both_texels(q, 0, 0, map, above), seen_in_both_texels(q, 1, 0, map, above),
                             seen_in_both_texels(q, 0, 1, map, above), seen_in_both_texels(q, 1, 1, map, above)));
}

float seen_in_parallel_texel(ParallelQuery q, int right, int below, uint map) {
    const MapTexel t = parallel_map_texel(q, right, below);
    return map_seen(uintBitsToFloat(push.atlas.at[map + t.index]), t);
}
float seen_in_parallel_map(vec3 x, vec3 n_g, View view, uint map) {
    const ParallelQuery q = parallel_query(x, n_g, view, gather_map_size_of(push.sides), push.bias);
    return parallel_blend(q, vec4(seen_in_parallel_texel(q, 0, 0, map), seen_in_parallel_texel(q, 1, 0, map),
                                  seen_in_parallel_texel(q, 0, 1, map), seen_in_parallel_texel(q, 1, 1, map)));
}

// The first of `count` listed VPLs that is not before `code`.
uint first_listed(uint code, uint count) {
    uint first = 0u;
    while (first < count) {
        const uint middle = (first + count) / 2u;
        if (push.listed.at[middle] < code) first = middle + 1u;
        else count = middle;
    }
    return first;
}

void main() {
    const GatherPixel pixel = gather_pixel(workgroup_index(), gl_LocalInvocationIndex, gl_WorkGroupSize.x, push.gbuffer.width,
                                           push.gbuffer.height, gather_block_of(push.sides));
    if (!pixel.inside) return;
    if (gather_may_fail(push.sides) && push.failed.at[0] != 0u) return;
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

    const uint block = gather_block_of(push.sides);
    const uint sets = block * block;
    const float scale = gather_scale(block);
    const uint count = push.count.at[0];
    const uint end = min(push.first + push.limit, count);
    const uint base = pixel.set << gather_listed_bits;
    uint at = listed ? first_listed(base | push.first, count) : push.first + pixel.set;
    // Continues the sum that is there in order, so the bits do not depend on how VPLs are split over dispatches.
    vec3 sum = push.irradiance.at[p].xyz;
    vec3 mirrored = vec3(0.0f);
    if (glossy) mirrored = push.irradiance.at[pixels + p].xyz;
    // The index depends on the workgroup alone, so a VPL is read once for all its lanes.
    for (; at < (listed ? count : end); at += listed ? 1u : sets) {
        const uint i = listed ? push.listed.at[at] - base : at;
        if (listed && i >= end) break;
        const Vpl vpl = push.vpls.at[i];
        Transfer t;
        if (parallel_views) t = far_transfer(n, n_g, lobe, vpl);
        else if (omni) t = omni_transfer(x, n, n_g, lobe, vpl);
        else t = transfer_of(x, n, lobe, vpl.position, unpack_direction(vpl.normal), push.bound);
        if (t.diffuse > 0.0f) {
            const uint place = i - push.first_map;
            const uint map = place * map_texels(gather_map_size_of(push.sides));
            float seen = 1.0f;
            if (use_maps && parallel_views) seen = seen_in_parallel_map(x, n_g, push.views.at[i], map);
            else if (use_maps && asks) seen = seen_in_both(x, n_g, vpl.position, map, push.asked.at[place]);
            else if (use_maps) seen = seen_in_map(x, n_g, vpl.position, push.atlas, map, gather_map_size_of(push.sides), push.bias);
            sum += vpl.flux * (t.diffuse * seen * scale);
            if (glossy) mirrored += vpl.flux * (t.glossy * seen * scale) * brdf_fresnel(lobe.f0, t.power);
        }
    }
    push.irradiance.at[p] = vec4(min(sum, vec3(gather_most)), 0.0f);
    if (glossy) push.irradiance.at[pixels + p] = vec4(min(mirrored, vec3(gather_most)), 0.0f);
}
