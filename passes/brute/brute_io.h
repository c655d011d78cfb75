// What the triangle rasteriser, its host and its twin share: which texels of a view's map a triangle covers, exactly, and a
// tight bound of them.
//
// A texel holds the nearest hit of the ray through its middle, so a triangle covers those texels whose rays meet it: edges
// are planes through the view. Their great circles are arcs of circles in the map, where the classic vertex-wise projection draws
// chords. With n the plane's normal and s = +-1 the half's axis, the circle of n . d = 0 is
//     u^2 + v^2 - 2 (n.y u + n.z v) / (s n.x) = 1:   centre (n.y, n.z) / (s n.x), radius |n| / |n.x| >= 1,
// so an arc over a chord of length c <= 2 rises above it by no more than 1 - sqrt(1 - c^2 / 4), and the extremes of longer arcs follow
// without trigonometry.
#ifndef MYRIAD_PASSES_BRUTE_IO_H
#define MYRIAD_PASSES_BRUTE_IO_H

#include "passes/geometry/geometry_io.h"
#include "passes/splat/splat_io.h"

#ifdef __cplusplus
#define precise
#endif

MYRIAD_BEGIN
// "brute/brute".
struct BrutePush {
    GeometryRef geometry;
    OpacityRef opacity;       // where surfaces have holes or blend
    Views views;
    Uints count;              // how many views there are
    Uints atlas;              // of views [first_view, …)
    uint triangles;           // of the world
    uint first_view, limit;   // views [first_view, min(first_view + limit, count))
    uint first_slice, slice;  // workgroup w draws for `slice` views, from first_view + slice * (first_slice + w / groups_a_slice) on
    uint groups_a_slice;
    uint map_size;
};

// A triangle around a view.
struct BruteTriangle {
    vec3 d0, d1, d2;  // corners - view
};

MYRIAD_FN BruteTriangle brute_around(vec3 view, Corners p) {
    BruteTriangle t;
    t.d0 = p.p0 - view;
    t.d1 = p.p1 - view;
    t.d2 = p.p2 - view;
    return t;
}

// A sphere around the triangle: the first question that is asked of it in each view.
MYRIAD_FN Sphere brute_sphere(Corners p) {
    Sphere s;
    s.center = (p.p0 + p.p1 + p.p2) / 3.0f;
    const vec3 a = p.p0 - s.center, b = p.p1 - s.center, c = p.p2 - s.center;
    s.radius = sqrt(max(dot(a, a), max(dot(b, b), dot(c, c)))) * 1.00001f;
    return s;
}

// Whether no point of the triangle lies in the view's frustum. For half-spaces, a VPL's, without slack; else by the sphere.
MYRIAD_FN bool brute_outside(View view, BruteTriangle t, Sphere s) {
    if (view.cos_phi != 0.0f) return outside_frustum(view, s.center - view.position, s.radius);
    return max(dot(view.direction, t.d0), max(dot(view.direction, t.d1), dot(view.direction, t.d2))) < 0.0f;
}

// ---- What is covered ----

// Planes through the view and the edges, and the triangle's own. Twice d_j x d_i, as the difference times the sum: its error is relative
// to the edge, however far that is, and the neighbour's plane at a common edge is the exact negative, so that no ray passes between two
// triangles (Plücker coordinates, as in Embree; `precise` forbids fused forms, which are not symmetric).
struct BruteEdges {
    vec3 n0, n1, n2;  // opposite corners 0, 1, 2
    vec3 normal;
    float height;     // of the triangle's plane over the view, times |normal|
};
MYRIAD_FN vec3 brute_cross(vec3 a, vec3 b) {
    precise const vec3 c = vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
    return c;
}
MYRIAD_FN float brute_dot(vec3 a, vec3 b) {
    precise const float c = (a.x * b.x + a.y * b.y) + a.z * b.z;
    return c;
}
MYRIAD_FN BruteEdges brute_edges(Corners p, BruteTriangle t) {
    BruteEdges e;
    e.n0 = brute_cross(p.p2 - p.p1, t.d2 + t.d1);
    e.n1 = brute_cross(p.p0 - p.p2, t.d0 + t.d2);
    e.n2 = brute_cross(p.p1 - p.p0, t.d1 + t.d0);
    e.normal = cross(p.p1 - p.p0, p.p2 - p.p0);
    e.height = dot(e.normal, t.d0);
    return e;
}

// How far from the middle, in (u, v), there are texels that a gather asks: the others stay empty.
MYRIAD_FN float brute_rim(uint size) { return 1.0f + splat_rim / float(size); }

struct BruteHit {
    float depth;    // metres; negative: the ray passes
    float u, v;     // barycentrics of corners 1 and 2
};
MYRIAD_FN BruteHit brute_hit(BruteTriangle t, BruteEdges e, uint half_index, vec2 uv, uint size) {
    BruteHit hit;
    hit.depth = -1.0f;
    hit.u = 0.0f;
    hit.v = 0.0f;
    const float q = uv.x * uv.x + uv.y * uv.y;
    const float rim = brute_rim(size);
    // As long as 1 + q: the texel's direction without its division.
    const vec3 w = vec3(half_index == half_front ? 1.0f - q : q - 1.0f, 2.0f * uv.x, 2.0f * uv.y);
    const float e0 = brute_dot(e.n0, w), e1 = brute_dot(e.n1, w), e2 = brute_dot(e.n2, w);
    const bool inside = min(e0, min(e1, e2)) >= 0.0f || max(e0, max(e1, e2)) <= 0.0f;
    const float area = e0 + e1 + e2, slope = dot(w, e.normal);
    if (!inside || area == 0.0f || slope == 0.0f || q > rim * rim) return hit;
    const float t0 = dot(w, t.d0), t1 = dot(w, t.d1), t2 = dot(w, t.d2);
    // The plane's distance; clamped to the corners', which is all that is known of a triangle seen edge-on.
    const float length = 1.0f + q;
    const float plane = e.height * length / slope;
    const float nearest = min(t0, min(t1, t2)) / length, farthest = max(t0, max(t1, t2)) / length;
    hit.depth = plane < nearest ? nearest : plane < farthest ? plane : farthest;
    hit.u = e1 / area;
    hit.v = e2 / area;
    return hit;
}

// ---- A bound of it ----

// Whether a sphere at d may reach texels of the half where its centre is not: directions up to the rim, a cone around that half's axis.
MYRIAD_FN bool brute_in_both(vec3 d, float r, uint size) {
    const float t = brute_rim(size), scale = 1.0f / (t * t + 1.0f);  // the tangent of half the cone's angle
    return abs(d.x) * (2.0f * t * scale) <= r + (t * t - 1.0f) * scale * 1.00001f * sqrt(dot(d, d));
}

// Whether a sphere's footprint, a disc, holds the middle of no texel: so it is with most triangles, which are smaller than a texel.
MYRIAD_FN bool brute_misses(uint half_index, vec3 d, float r, uint size) {
    const Footprint f = footprint(half_index, d, r);
    if (f.whole) return false;
    const float scale = 0.5f * float(size), least = f.radius * 1.00001f + 4e-6f;
    const vec2 middle = (f.center + vec2(1.0f, 1.0f)) * scale - vec2(0.5f, 0.5f);
    const vec2 first = max(ceil(middle - least * scale), vec2(0.0f, 0.0f));
    const vec2 last = min(floor(middle + least * scale), vec2(float(size) - 1.0f, float(size) - 1.0f));
    return first.x > last.x || first.y > last.y;
}

struct BruteBounds {
    vec2 low, high;  // in (u, v) of one half
    bool wide;       // brute_wide_bounds is to be asked instead
};

// Chords up to this are short: the shorter of the two arcs over one is that between the corners (it is at most pi/2 times as long, and
// lengths on the sphere are at most twice those in the map), and the triangle is the inside of its outline (whose area is below
// 1, so below 4 of the sphere's 4 pi, where a triangle has at most 2 pi).
const float brute_short = 0.75f;
// Corners are projected with an error below 2^-20.
const float brute_slack = 9.5367432e-7f * 4.0f;

MYRIAD_FN vec2 brute_project(float s, vec3 d) {
    const float scale = 1.0f / (sqrt(dot(d, d)) + s * d.x);
    return vec2(d.y * scale, d.z * scale);
}

MYRIAD_FN BruteBounds brute_bounds(uint half_index, BruteTriangle t) {
    const float s = half_index == half_front ? 1.0f : -1.0f;
    const vec2 a = brute_project(s, t.d0), b = brute_project(s, t.d1), c = brute_project(s, t.d2);
    const vec2 ab = b - a, bc = c - b, ca = a - c;
    const float most2 = brute_short * brute_short;
    const float chord2 = max(dot(ab, ab), max(dot(bc, bc), dot(ca, ca)));
    const float rise = chord2 / 7.0f + brute_slack;  // at least 1 - sqrt(1 - c^2 / 4) up to chords of 0.95
    BruteBounds bounds;
    bounds.low = min(a, min(b, c)) - rise;
    bounds.high = max(a, max(b, c)) + rise;
    // One by one: a corner may be at no number.
    bounds.wide = !(dot(ab, ab) <= most2 && dot(bc, bc) <= most2 && dot(ca, ca) <= most2);
    return bounds;
}

// The bounds of the arc from p to q (unit) along u (axis 0) or v (axis 1), beside its ends. The extremes of the circle are the directions
// `e` with u or v = (n_i +- |n|) / (s n.x); there is no division before it is known that they lie between p and q.
MYRIAD_FN void brute_widen(float s, vec3 p, vec3 q, uint axis, MYRIAD_INOUT(float) low, MYRIAD_INOUT(float) high) {
    const vec3 n = 0.5f * cross(p - q, p + q);  // p x q
    const float length = sqrt(dot(n, n));
    const vec3 from = cross(n, p), to = cross(n, q);
    const float across = axis == 0u ? n.y : n.z, along = axis == 0u ? n.z : n.y;
    for (uint i = 0u; i < 2u; ++i) {
        const float end = across + (i == 0u ? length : -length);
        const float back = -(n.y * n.y + n.z * n.z) - (i == 0u ? length : -length) * across;
        const vec3 e = s * (axis == 0u ? vec3(back, n.x * end, n.x * along) : vec3(back, n.x * along, n.x * end));
        if (end == 0.0f || dot(from, e) < 0.0f || dot(to, e) > 0.0f) continue;
        const float extreme = end / (s * n.x);
        low = min(low, extreme);
        high = max(high, extreme);
    }
}

// Of any triangle: what its corners and arcs span, or everything where it holds the direction opposite to the half's axis, and where
// the view is in a corner or on an edge.
MYRIAD_FN BruteBounds brute_wide_bounds(uint half_index, BruteTriangle t, BruteEdges e) {
    const float s = half_index == half_front ? 1.0f : -1.0f;
    const vec2 a = brute_project(s, t.d0), b = brute_project(s, t.d1), c = brute_project(s, t.d2);
    BruteBounds bounds;
    bounds.low = min(a, min(b, c));
    bounds.high = max(a, max(b, c));
    const vec3 p = t.d0 / sqrt(dot(t.d0, t.d0)), q = t.d1 / sqrt(dot(t.d1, t.d1)), r = t.d2 / sqrt(dot(t.d2, t.d2));
    brute_widen(s, p, q, 0u, bounds.low.x, bounds.high.x);
    brute_widen(s, q, r, 0u, bounds.low.x, bounds.high.x);
    brute_widen(s, r, p, 0u, bounds.low.x, bounds.high.x);
    brute_widen(s, p, q, 1u, bounds.low.y, bounds.high.y);
    brute_widen(s, q, r, 1u, bounds.low.y, bounds.high.y);
    brute_widen(s, r, p, 1u, bounds.low.y, bounds.high.y);
    // An arc shorter than 0.01 rises less than this, and the normal of a longer one is good to it.
    bounds.low = bounds.low - 1e-4f;
    bounds.high = bounds.high + 1e-4f;
    const bool meets_axis = min(e.n0.x, min(e.n1.x, e.n2.x)) >= 0.0f || max(e.n0.x, max(e.n1.x, e.n2.x)) <= 0.0f;
    const bool opposite = meets_axis && !(s * e.height * e.normal.x > 0.0f);
    const bool finite = dot(a, a) < 1e12f && dot(b, b) < 1e12f && dot(c, c) < 1e12f;
    // Nearly half a circle has no plane to speak of: the view is on the edge. And brute_edges of a corner this near are rounded by more
    // than what was added.
    const bool on_edge = min(dot(p, q), min(dot(q, r), dot(r, p))) < -0.999f;
    const vec3 l2 = vec3(dot(t.d0, t.d0), dot(t.d1, t.d1), dot(t.d2, t.d2));
    const bool in_corner = !(min(l2.x, min(l2.y, l2.z)) > 1e-6f * max(l2.x, max(l2.y, l2.z)));
    if (opposite || on_edge || in_corner || !finite) {
        bounds.low = vec2(-2.0f, -2.0f);
        bounds.high = vec2(2.0f, 2.0f);
    }
    bounds.wide = true;
    return bounds;
}

// The texels whose middles may lie in the bounds: [x0, x1) x [y0, y1).
struct BruteBox {
    uint x0, y0, x1, y1;
};
MYRIAD_FN BruteBox brute_box(BruteBounds b, uint size) {
    BruteBox box;
    box.x0 = splat_first(b.low.x, size);
    box.x1 = splat_end(b.high.x, size);
    box.y0 = splat_first(b.low.y, size);
    box.y1 = splat_end(b.high.y, size);
    return box;
}
MYRIAD_FN uint brute_texels(BruteBox box) { return box.x1 > box.x0 && box.y1 > box.y0 ? (box.x1 - box.x0) * (box.y1 - box.y0) : 0u; }
MYRIAD_END

#ifdef __cplusplus
#undef precise
static_assert(sizeof(myriad::BrutePush) <= 128);
#endif

#endif
