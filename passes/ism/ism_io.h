// Imperfect shadow maps (Ritschel, Grosch, Kim, Seidel, Dachsbacher, Kautz 2008): what the kernels, their host and their twins share.
#ifndef MYRIAD_PASSES_ISM_IO_H
#define MYRIAD_PASSES_ISM_IO_H

#include "compute/bsh/bsh_build.h"
#include "passes/geometry/geometry_io.h"
#include "passes/splat/splat_io.h"

MYRIAD_BEGIN
// A sample of the surface where it stands now. 16 bytes, one load.
struct IsmPoint {
    vec3 position;
    uint code;     // bsh_cone_axis of the normal in 24 bits, opacity_missing in 4, then ism_no_normal
};
MYRIAD_ARRAY(IsmPoints, IsmPoint, 16)
const uint ism_no_normal = 1u << 28;

MYRIAD_FN IsmPoint ism_point(Corners c, float u, float v, uint missing) {
    IsmPoint p;
    p.position = bsh_position(c.p0, c.p1, c.p2, u, v);
    const uint cone = bsh_cone_of(c.p1 - c.p0, c.p2 - c.p0);
    p.code = (cone & 0xffffffu) | (missing << 24) | ((cone >> 24) == 255u ? ism_no_normal : 0u);
    return p;
}
MYRIAD_FN uint ism_missing(IsmPoint p) { return (p.code >> 24) & 15u; }

// "ism/points".
struct IsmPointsPush {
    GeometryRef geometry;
    OpacityRef opacity;      // where some blend
    SurfaceSamples samples;
    IsmPoints points;
    uint count;
};

// "ism/splat": workgroup w works for view first_view + w / groups_a_view.
struct IsmSplatPush {
    IsmPoints points;
    Views views;
    Uints count;             // how many views there are
    Uints atlas;             // of views [first_view, …)
    uint samples;            // points there are
    uint subset;             // points a view draws
    float radius;            // of a point's disc
    uint seed;
    uint first_view, limit;
    uint groups_a_view;
    uint map_size;
};

// Which of the samples is the i-th point of a view's subset: one at random of the i-th share of them. Samples are in the order of a curve
// through space, so that a subset is random, another one in each view, and yet lies evenly on the surface.
MYRIAD_FN uint ism_chosen(uint view, uint i, uint subset, uint samples, uint seed) {
    const float within = to_unit(hash_pair(hash_pair(seed, view), i));
    return min(uint((float(i) + within) / float(subset) * float(samples)), samples - 1u);
}

// A point's disc as a view sees it.
struct IsmDisc {
    vec3 d, normal;
    float radius, height;    // SplatPlane's
};
MYRIAD_FN IsmDisc ism_disc(View view, IsmPoint p, float radius) {
    IsmDisc s;
    s.d = p.position - view.position;
    s.radius = radius;
    const SplatPlane plane = splat_plane(s.d, radius, bsh_cone_axis(p.code), (p.code & ism_no_normal) != 0u);
    s.normal = plane.normal;
    s.height = plane.height;
    return s;
}
// Along the unit direction w; negative: it passes.
MYRIAD_FN float ism_depth(IsmDisc s, vec3 w) {
    const float t = s.height / dot(w, s.normal);  // may be infinite or NaN: the comparisons below then fail
    const vec3 q = t * w - s.d;
    return t > 0.0f && dot(q, q) <= s.radius * s.radius ? t : -1.0f;
}

// ---- Pull and push ----
//
// A pyramid over each half map; level 0 is the half itself, level l + 1 has a texel for 2 x 2 of level l.
MYRIAD_FN uint ism_coarser(uint size) { return (size + 1u) / 2u; }

// "ism/pull": a thread a texel of the coarse level; "ism/push": of the fine one.
struct IsmLevelPush {
    Uints fine, coarse;      // the levels, map after map, front half then back
    uint fine_size, coarse_size;
    uint halves;             // two a map
    float threshold;         // metres: depths that differ by more are of different surfaces
};

MYRIAD_FN float ism_nothing() { return uintBitsToFloat(atlas_nothing); }

// The mean of those depths that are near the nearest one: what is behind it is another surface.
MYRIAD_FN float ism_mean(vec4 depth, vec4 weight, float threshold) {
    const float nearest = min(min(depth.x, depth.y), min(depth.z, depth.w));
    const float most = nearest + threshold;
    const vec4 w = vec4(depth.x <= most ? weight.x : 0.0f, depth.y <= most ? weight.y : 0.0f, depth.z <= most ? weight.z : 0.0f,
                        depth.w <= most ? weight.w : 0.0f);
    const float x = w.x > 0.0f ? w.x * depth.x : 0.0f, y = w.y > 0.0f ? w.y * depth.y : 0.0f;  // not 0 * infinity
    const float z = w.z > 0.0f ? w.z * depth.z : 0.0f, v = w.w > 0.0f ? w.w * depth.w : 0.0f;
    return nearest < ism_nothing() ? ((x + y) + (z + v)) / ((w.x + w.y) + (w.z + w.w)) : ism_nothing();
}

// The four coarse texels around the middle of fine texel (x, y): the one that holds it, then its neighbours on the nearer sides along x, y
// and both, each held within the level.
MYRIAD_FN uvec4 ism_around(uint x, uint y, uint coarse_size) {
    const uint cx = x / 2u, cy = y / 2u;
    const uint nx = (x & 1u) == 0u ? (cx > 0u ? cx - 1u : 0u) : min(cx + 1u, coarse_size - 1u);
    const uint ny = (y & 1u) == 0u ? (cy > 0u ? cy - 1u : 0u) : min(cy + 1u, coarse_size - 1u);
    return uvec4(cy * coarse_size + cx, cy * coarse_size + nx, ny * coarse_size + cx, ny * coarse_size + nx);
}
const vec4 ism_weights = vec4(9.0f / 16.0f, 3.0f / 16.0f, 3.0f / 16.0f, 1.0f / 16.0f);
MYRIAD_END

#ifdef __cplusplus
static_assert(sizeof(myriad::IsmPoint) == 16 && sizeof(myriad::IsmPointsPush) <= 128 && sizeof(myriad::IsmSplatPush) <= 128);
static_assert(sizeof(myriad::IsmLevelPush) <= 128);
#endif

#endif
