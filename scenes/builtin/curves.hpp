// More of the kit: curves, arches, and what follows a curve. As in kit.hpp everything appends to a Primitive, front faces
// counter-clockwise, unit normals outward.
#pragma once

#include <array>

#include "scenes/builtin/kit.hpp"

namespace myriad::scenes::kit {

// A Catmull-Rom spline through the points, as a polyline of `per_span` segments a span. A point given twice is a corner,
// where the curve ends and begins anew: profiles of pots are a few points each. Without `corners` points may repeat, as
// widths along a rod do, and n points always give (n - 1) * per_span + 1. For vec2 and vec3.
template <class V>
std::vector<V> spline(const std::vector<V>& through, int per_span, bool corners = true);

template <class V>
V bezier(const std::array<V, 4>& p, float t) {
    const float s = 1 - t;
    return p[0] * (s * s * s) + p[1] * (3 * s * s * t) + p[2] * (3 * s * t * t) + p[3] * (t * t * t);
}

// A round thing along a polyline, with a radius at each point. Its ends are closed: by a disc, or where the radius is 0 by
// being a point. `sides` vertices around, shared, so that millions of them are cheap. Texture coordinates are
// (around, along), each from 0 to 1.
void tube(Primitive& out, const std::vector<glm::vec3>& points, const std::vector<float>& radii, int sides);

// Directions across a curve, carried along it without twist (Wang et al. 2008, "Computation of rotation minimizing
// frames"); across x up points ahead. `up` need not be perpendicular to the curve.
struct Frame {
    glm::vec3 at, across, up;
};
std::vector<Frame> frames_along(const std::vector<glm::vec3>& points, glm::vec3 up);

// A cross-section in the (across, up) plane, counter-clockwise where it is closed, carried along frames and scaled by
// `scale` at each: handles, spouts, spoons. Edges are hard where the profile turns, as in sweep(). `caps` closes the ends
// with fans around the section's mean, for sections that its mean sees all of.
void loft(Primitive& out, const Profile& section, const std::vector<Frame>& frames, const std::vector<glm::vec2>& scale, bool caps);

// An ellipse as a section for loft().
Profile ellipse(float a, float b, int sides);

// The pointed arch over |x| <= half: two arcs that spring from y = 0 and meet at y = rise >= half (equal: a semicircle).
struct Arch {
    float half, rise;

    float radius() const { return (half * half + rise * rise) / (2 * half); }
    float centre() const { return radius() - half; }  // the left arc's is at x = +centre, the right arc's at -centre
    float height(float x) const;                      // of the curve over x
    glm::vec2 at(float t) const;                      // 0: left springing, 0.5: apex, 1: right springing; even along each arc
};

// Profile (radial offset, z) along an arc of a circle, from angle `from` to `to`, clockwise (from > to) as in
// arch_moulding().
void arc_moulding(Primitive& out, const Profile& profile, glm::vec2 centre, float radius, float from, float to, int segments);

// Profile (radial offset, z) up from y = -drop along the left jamb, over the arch and down the right jamb, mitred at the
// apex.
void arch_moulding(Primitive& out, const Profile& profile, const Arch& arch, float drop, int segments);

// A wall panel between z = -thickness/2 and thickness/2, |x| <= width/2, 0 <= y <= height, with an opening that stands on
// `sill` and has its arch spring at `spring`. The ends, the top and, unless sill > 0, the underside stay open. Texture
// coordinates are (x, y) in metres on the faces, and along the depth in the opening.
struct Opening {
    Arch arch;
    float sill, spring;
};
void opening_panel(Primitive& out, float width, float height, const Opening& opening, float thickness, int segments);

// The web of a ribbed vault over |x| <= half.x, |z| <= half.y, springing at y = 0, seen from below. `arch` is the section
// over half.y, where arch.half = half.y; over half.x and along the groins, which are straight in plan, it is stretched.
// Texture coordinates: (along, across) the courses, in metres.
void ribbed_vault(Primitive& out, glm::vec2 half, const Arch& arch, int cells);

// The web over one side of a polygon, from its wall a-b to the centre, all three at the height of the springing, with
// half of the arch above the lines from a and b to the centre. Seen from below, with a on the left of who looks at the wall.
void polygon_vault(Primitive& out, glm::vec3 a, glm::vec3 b, glm::vec3 centre, const Arch& arch, int cells);

// What a rib of these vaults follows: from `springing` to above `apex`, which is given at the same height; half the arch,
// stretched to their distance.
std::vector<glm::vec3> rib_curve(glm::vec3 springing, glm::vec3 apex, const Arch& arch, int segments);

}  // namespace myriad::scenes::kit
