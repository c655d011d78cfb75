// What the filter kernel, its host and its twin share.
#ifndef MYRIAD_PASSES_FILTER_IO_H
#define MYRIAD_PASSES_FILTER_IO_H

#include "passes/gbuffer/gbuffer_io.h"

MYRIAD_BEGIN
struct FilterPush {
    GBufferRef gbuffer;
    Float4s irradiance;    // glossy: and then what lobes reflect; so has `filtered`
    Float4s filtered;
    uint block;            // k
    float pixel_angle;     // the height of a pixel at distance 1 along the camera's axis
};

// Weight of an offset along one axis: k + 1 taps for blocks of k, the two on the rim half. (Odd k need no rim: k taps.)
MYRIAD_FN int filter_reach(uint block) { return int(block / 2u); }
MYRIAD_FN float filter_tap(int offset, uint block) {
    return block % 2u == 0u && (offset == filter_reach(block) || offset == -filter_reach(block)) ? 0.5f : 1.0f;
}

// How alike two surface points are: p, n, n_g (position, shading and geometric normal) of the pixel; q, m of its neighbour. `scale` in
// metres: the window's width there. The tangent plane is the geometric one: interpolated normals would take a flat facet for a step.
MYRIAD_FN float filter_alike(vec3 p, vec3 n, vec3 n_g, vec3 q, vec3 m, float scale) {
    const float c = max(dot(n, m), 0.0f);
    const float c2 = c * c;
    const float c4 = c2 * c2;
    const float off = abs(dot(n_g, q - p)) / scale;
    const float near = max(1.0f - off * off, 0.0f);
    return c4 * c4 * c4 * c4 * near * near;
}

// Between lobes: none where either surface is matte, and less the more roughnesses differ.
MYRIAD_FN float filter_alike_lobes(Gloss a, Gloss b) {
    if (is_matte(a) || is_matte(b)) return 0.0f;
    const float off = 4.0f * (unpack_high(a.f0_b_roughness) - unpack_high(b.f0_b_roughness));
    const float near = max(1.0f - off * off, 0.0f);
    return near * near;
}
// Lobes' light is averaged as a share of what they reflect of even light, so that a pattern of reflectances stays sharp. The neighbour
// is taken to be seen from where the pixel is.
MYRIAD_FN vec3 filter_share(Gloss g, vec3 n, vec3 view) {
    return max(glossy_albedo(lobe_of(vec3(unpack_low(g.f0_rg), unpack_high(g.f0_rg), unpack_low(g.f0_b_roughness)), unpack_high(g.f0_b_roughness), view, n)), vec3(1e-3f));
}
MYRIAD_END

#endif
