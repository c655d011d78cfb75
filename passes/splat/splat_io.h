// What the splat kernel, its host and its twin share.
#ifndef MYRIAD_PASSES_SPLAT_IO_H
#define MYRIAD_PASSES_SPLAT_IO_H

#include "compute/bsh/bsh_io.h"
#include "compute/common/hash.h"
#include "compute/manylods/cut_io.h"
#include "compute/opacity/opacity_io.h"
#include "compute/views/paraboloid.h"
#include "compute/views/parallel.h"
#include "compute/views/splat_plane.h"

MYRIAD_BEGIN
const uint atlas_nothing = 0x7f800000u;  // +infinity: no surface in this texel

// How much larger than its box a node is drawn, in radii: the box's codes are good to 1/511 of the radius and the plane's
// normal to 1/2047, so a thin box may lie beside its own plane by their sum and more at its rim.
const float splat_margin = 1.0f / 128.0f;

struct SplatPush {
    Uint2s groups;
    Uints count;
    Uints failed;            // failed.at[0] != 0: groups are missing, all of this will be done again, and nothing is drawn
    BshRef tree;
    Views views;
    Uints atlas;
    uint capacity, map_size, first_view;
    uint keeps;              // 1: maps of views that did not change are in the atlas, and stay
    Uints changed;           // by view from first_view; only where `keeps`
    // Shared maps only: groups' views are nodes of a view tree, those from `view_capacity` on are inner ones.
    Uints places;            // by inner node: which of the shared maps is its
    uint view_capacity;
    uint first_shared;       // maps before these are views'
};
// Specialisation constant: maps are shared.
const uint shared_maps_constant = 22u;

// Specialisation constant: what a node covers whose footprint is less than a texel wide.
const uint coverage_constant = 26u;
const uint coverage_exact = 0u;       // the texels whose middles it covers, as larger ones do
const uint coverage_full = 1u;        // all of the texel that its middle is in, as points are drawn in the papers
const uint coverage_stochastic = 2u;  // a texel, with the probability of its share of it

// "splat/clear": one invocation a row of a half map.
struct SplatClearPush {
    Uints changed;           // by view; maps of the others stay
    Uints atlas;
    uint views, map_size;
};

// A node as one view sees it.
struct Splat {
    vec3 d;          // centre - view
    float radius;
    vec3 normal;
    float height;    // SplatPlane's
    vec3 low, high;  // the box, around the centre
};

MYRIAD_FN Splat splat_of(View view, Sphere sphere, uint cone, uvec2 box_code) {
    Splat s;
    s.d = sphere.center - view.position;
    s.radius = sphere.radius;
    const bool faces = (cone >> 24) == 255u;
    const SplatPlane plane = splat_plane(s.d, s.radius, faces && is_parallel(view) ? view.direction : bsh_cone_axis(cone), faces && !is_parallel(view));
    s.normal = plane.normal;
    s.height = plane.height;
    const BshBox box = bsh_decode_box(box_code, sphere.radius);
    const float margin = splat_margin * sphere.radius;
    s.low = box.low - margin;
    s.high = box.high + margin;
    return s;
}

// The depth (metres along the unit direction w) that the node gives to a texel with its middle at w; negative: none.
MYRIAD_FN float splat_depth(Splat s, vec3 w) {
    const float t = s.height / dot(w, s.normal);  // may be infinite or NaN: the comparisons below then fail
    const vec3 q = t * w - s.d;
    const bool inside = q.x >= s.low.x && q.y >= s.low.y && q.z >= s.low.z && q.x <= s.high.x && q.y <= s.high.y && q.z <= s.high.z;
    return t > 0.0f && inside ? t : -1.0f;
}

// The same for a parallel view, whose texel's line of sight along the unit direction n passes the centre at `off`, perpendicular to n.
// A plane that is seen edge-on covers nothing.
MYRIAD_FN float splat_parallel_depth(Splat s, vec3 n, vec3 off) {
    const float slope = dot(n, s.normal);
    if (!(abs(slope) > splat_edge_on)) return -1.0f;
    const float along = -dot(off, s.normal) / slope;  // from the centre
    const vec3 q = off + along * n;
    const bool inside = q.x >= s.low.x && q.y >= s.low.y && q.z >= s.low.z && q.x <= s.high.x && q.y <= s.high.y && q.z <= s.high.z;
    const float t = dot(s.d, n) + along;
    return t > 0.0f && inside ? t : -1.0f;
}

// How far beyond the equator the middles of texels lie that a gather asks, as an angle over the texel's side in (u, v): a look-up
// blends texels up to one away, along both axes (passes/gather).
const float splat_rim = 2.8285f;

// Whether a node or disc may cover texels of the half where its centre, at d, is not: its sphere crosses the equator, or comes as near
// as the texels reach over it that a look-up in that half blends. Their middles are directions of the other half.
MYRIAD_FN bool splat_in_both(vec3 d, float radius, uint size) {
    return abs(d.x) <= radius + splat_rim / float(size) * sqrt(dot(d, d));
}

// The texels of one axis whose middles may lie in [middle - radius, middle + radius]: first, and one past the last.
MYRIAD_FN uint splat_first(float u, uint size) {
    const float t = (u + 1.0f) * 0.5f * float(size) - 0.5f;
    const uint x = uint(clamp(t, 0.0f, float(size)));  // clamped first: beyond 2^32 there is no conversion
    return min(x + (float(x) < t ? 1u : 0u), size);
}
MYRIAD_FN uint splat_end(float u, uint size) {
    const float t = (u + 1.0f) * 0.5f * float(size) + 0.5f;
    return uint(clamp(t, 0.0f, float(size)));
}

// ---- Nodes smaller than a texel ----
//
// "Full": the node is a point, its middle. "Stochastic": a point is thrown evenly into the square of a texel's side around the footprint's
// middle, which holds all of the footprint; where the node covers that point, the texel around the point gets the depth there. So each texel
// gets it with the probability of the node's area in it, and node and view alone decide.

MYRIAD_FN bool splat_is_small(float diameter) { return diameter < 1.0f; }  // in texels; NaN is not

MYRIAD_FN uint splat_dice(uint node, uint view) { return hash_pair(node, view); }
// In [-1/2, 1/2)^2.
MYRIAD_FN vec2 splat_throw(uint dice) { return vec2(float(dice >> 16), float(dice & 0xffffu)) * (1.0f / 65536.0f) - 0.5f; }

// The one texel that may be covered, and its depth; negative: none is.
struct SmallSplat {
    float depth;
    uint x, y;
};

// `at` in texels, may lie outside of the map of columns x rows.
MYRIAD_FN SmallSplat splat_small_at(vec2 at, float depth, uint columns, uint rows) {
    SmallSplat small;
    const bool inside = at.x >= 0.0f && at.y >= 0.0f && at.x < float(columns) && at.y < float(rows);
    small.depth = inside ? depth : -1.0f;
    small.x = inside ? uint(at.x) : 0u;
    small.y = inside ? uint(at.y) : 0u;
    return small;
}

// `middle` is the footprint's, (u, v) of the half.
MYRIAD_FN SmallSplat splat_small(Splat s, uint half_index, vec2 middle, uint size, uint coverage, uint dice) {
    const bool full = coverage == coverage_full;
    const vec2 uv = full ? middle : middle + splat_throw(dice) * (2.0f / float(size));
    const float depth = full ? sqrt(dot(s.d, s.d)) : splat_depth(s, unproject(half_index, uv));
    return splat_small_at((uv + 1.0f) * (0.5f * float(size)), depth, size, size);
}

// The same for a parallel view; `middle` in texels.
MYRIAD_FN SmallSplat splat_small_parallel(Splat s, View view, ParallelFrame frame, vec2 middle, uint size, uint coverage, uint dice) {
    const bool full = coverage == coverage_full;
    const vec2 off = full ? vec2(0.0f) : splat_throw(dice);
    const float texel = parallel_texel(view, size);
    const float depth = full ? dot(s.d, view.direction) : splat_parallel_depth(s, view.direction, (off.x * texel) * frame.across + (off.y * texel) * frame.down);
    return splat_small_at(middle + off, depth, parallel_columns(view), parallel_rows(view, size));
}
MYRIAD_END

#endif
