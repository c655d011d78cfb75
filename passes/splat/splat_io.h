// What the splat kernel, its host and its twin share.
#ifndef MYRIAD_PASSES_SPLAT_IO_H
#define MYRIAD_PASSES_SPLAT_IO_H

#include "compute/bsh/bsh_io.h"
#include "compute/manylods/cut_io.h"
#include "compute/views/paraboloid.h"

MYRIAD_BEGIN
const uint atlas_nothing = 0x7f800000u;  // +infinity: no surface in this texel

// Up to this half-angle of its normal cone a node is drawn as a piece of a plane. A plane through a patch that turns by
// theta to either side errs by r sin(theta) inside a sphere of radius r, and the middle of the sphere by r: at 30 degrees
// the plane errs half as much.
const float splat_flat_cos = 0.866f;

struct SplatPush {
    Uint2s groups;
    Uints count;
    BshRef tree;
    Views views;
    Uints atlas;
    uint capacity, map_size, first_view;
    float grow, flat_cos;
};

// A node as one view sees it.
struct Splat {
    vec3 d;          // centre - view
    float radius;
    vec3 normal;
    float height;    // d . normal: how far the view lies off the node's plane
    float tangent2;  // L^2 - r^2
    bool flat_patch;
};

MYRIAD_FN Splat splat_of(View view, Sphere sphere, uint cone, float grow, float flat_cos) {
    Splat s;
    s.d = sphere.center - view.position;
    s.radius = sphere.radius;
    s.normal = bsh_cone_axis(cone);
    s.height = dot(s.d, s.normal);
    s.tangent2 = dot(s.d, s.d) - sphere.radius * sphere.radius;
    s.flat_patch = bsh_cone_cos_sin(cone).x >= flat_cos;
    if (s.flat_patch) s.radius *= grow;
    return s;
}

// The depth (metres along the unit direction w) that the node gives to a texel with its middle at w; negative: none.
MYRIAD_FN float splat_depth(Splat s, vec3 w) {
    const float along = dot(w, s.d);
    if (!s.flat_patch) {
        // Inside the outline: the angle between w and d is at most beta, cos(beta) = sqrt(L^2 - r^2) / L.
        return s.tangent2 > 0.0f && along > 0.0f && along * along >= s.tangent2 ? along : -1.0f;
    }
    const float slope = dot(w, s.normal);
    const float t = s.height / slope;  // may be infinite or NaN: the comparisons below then fail
    if (!(t > 0.0f)) return -1.0f;
    const vec3 off = t * w - s.d;
    return dot(off, off) <= s.radius * s.radius ? t : -1.0f;
}

// The texels of one axis whose middles may lie in [middle - radius, middle + radius]: first, and one past the last.
MYRIAD_FN uint splat_first(float u, uint size) {
    const float t = (u + 1.0f) * 0.5f * float(size) - 0.5f;
    return t > 0.0f ? min(uint(t) + (float(uint(t)) < t ? 1u : 0u), size) : 0u;
}
MYRIAD_FN uint splat_end(float u, uint size) {
    const float t = (u + 1.0f) * 0.5f * float(size) + 0.5f;
    return t > 0.0f ? min(uint(t), size) : 0u;
}
MYRIAD_END

#endif
