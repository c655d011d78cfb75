// The dual-paraboloid map and the exact geometry of spheres in it: criterion, culling, footprint. See view_io.h.
//
// With d = centre - view, L = |d|, alpha the angle of d from the half's axis and beta = asin(r / L), the sphere's outline
// lies at tan((alpha + beta) / 2) and tan((alpha - beta) / 2) on its meridian. Since
//     tan((a + b) / 2) - tan((a - b) / 2) = 2 sin b / (cos a + cos b)   and
//     tan((a + b) / 2) + tan((a - b) / 2) = 2 sin a / (cos a + cos b),
// both the disc's radius and its centre need one square root and no trigonometry:
//     radius = r / (d.axis + sqrt(L^2 - r^2)),   centre = (d.y, d.z) / (d.axis + sqrt(L^2 - r^2)).
#ifndef MYRIAD_COMPUTE_PARABOLOID_H
#define MYRIAD_COMPUTE_PARABOLOID_H

#include "compute/views/view_io.h"

MYRIAD_BEGIN
const uint half_front = 0u;  // d.x >= 0
const uint half_back = 1u;

MYRIAD_FN uint half_of(vec3 d) { return d.x < 0.0f ? half_back : half_front; }

// Direction (any length > 0) to (u, v) in the half that half_of names; inside the unit disc.
MYRIAD_FN vec2 project(vec3 d) {
    const float scale = 1.0f / (sqrt(dot(d, d)) + abs(d.x));
    return vec2(d.y * scale, d.z * scale);
}

// The inverse: a unit direction. Points outside the unit disc belong to directions of the other half.
MYRIAD_FN vec3 unproject(uint half_index, vec2 uv) {
    const float q = uv.x * uv.x + uv.y * uv.y;
    const float scale = 1.0f / (1.0f + q);
    const float axis = (1.0f - q) * scale;
    return vec3(half_index == half_front ? axis : -axis, 2.0f * uv.x * scale, 2.0f * uv.y * scale);
}

// (u, v) of the middle of texel (x, y), and the texel that holds (u, v).
MYRIAD_FN vec2 texel_middle(uint x, uint y, uint size) {
    return vec2((2.0f * float(x) + 1.0f) / float(size) - 1.0f, (2.0f * float(y) + 1.0f) / float(size) - 1.0f);
}
MYRIAD_FN uint texel_coordinate(float u, uint size) {
    const float t = (u + 1.0f) * 0.5f * float(size);
    return t > 0.0f ? min(uint(t), size - 1u) : 0u;
}
MYRIAD_FN uint texel_index(uint half_index, uint x, uint y, uint size) { return (half_index * size + y) * size + x; }
// The texel that a direction falls in.
MYRIAD_FN uint texel_towards(vec3 d, uint size) {
    const vec2 uv = project(d);
    return texel_index(half_of(d), texel_coordinate(uv.x, size), texel_coordinate(uv.y, size), size);
}
// Half the diagonal of a texel at direction (u, v), as the angle it subtends (radians): du subtends 2 du / (1 + u^2 + v^2).
MYRIAD_FN float texel_angle(vec2 uv, uint size) {
    return 2.82842712f / (float(size) * (1.0f + uv.x * uv.x + uv.y * uv.y));
}

// c(N, V) of the spec: the diameter, in texels, of the disc that a sphere projects to, in the half where its centre lies;
// infinite when the centre of projection is inside the sphere or on it.
MYRIAD_FN float criterion(vec3 d, float r, uint size) {
    MYRIAD_PRECISE const float tangent2 = d.x * d.x + d.y * d.y + d.z * d.z - r * r;
    if (!(tangent2 > 0.0f)) return uintBitsToFloat(0x7f800000u);
    MYRIAD_PRECISE const float c = float(size) * r / (abs(d.x) + sqrt(tangent2));
    return c;
}

// c < epsilon, as cuts ask it. Where a view is all but inside a sphere (r > 0.968 L) L^2 - r^2 cancels, and the answer is no; elsewhere c is
// good to 45 units in the last place. A sphere with another inside it has the larger c; so where it leaves the other 2^-16 of its radius,
// as bounds of the tree do (bsh_slack), `fits` of the outer one implies `fits` of the inner one in floating point too (spec, section 2).
MYRIAD_FN bool fits(vec3 d, float r, uint size, float epsilon) {
    MYRIAD_PRECISE const float l2 = d.x * d.x + d.y * d.y + d.z * d.z;
    MYRIAD_PRECISE const float tangent2 = l2 - r * r;
    return tangent2 > 0.0625f * l2 && criterion(d, r, size) < epsilon;
}

// Signed distance of the point d from the view's frustum cone, d relative to its apex; negative inside. (a, b) are its coordinates along
// the axis and away from it; -a sin(phi) + b cos(phi) is the distance from the cone's *side* (MegaViews, figure 4, with the apex case
// of the spec: behind the apex of a cone of phi < pi/2 the nearest point is the apex itself). Good to 2^-20 |d|.
MYRIAD_FN float frustum_distance(View view, vec3 d) {
    const vec3 n = view.direction;
    MYRIAD_PRECISE const float a = n.x * d.x + n.y * d.y + n.z * d.z;
    MYRIAD_PRECISE float distance = -a * view.sin_phi;
    if (view.cos_phi != 0.0f) {  // not a half-space
        MYRIAD_PRECISE const vec3 off = d - a * n;
        MYRIAD_PRECISE const float b = sqrt(off.x * off.x + off.y * off.y + off.z * off.z);  // sqrt(d^2 - a^2) would be off by 3e-4 |d| near the axis
        MYRIAD_PRECISE const float beyond = a * view.cos_phi + b * view.sin_phi;
        distance = distance + b * view.cos_phi;
        if (view.cos_phi > 0.0f && beyond < 0.0f) distance = sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
    }
    return distance;
}

// At least |d| + r, and no less for a sphere than for those inside it.
MYRIAD_FN float reach_of(vec3 d, float r) {
    MYRIAD_PRECISE const float reach = abs(d.x) + abs(d.y) + abs(d.z) + 2.0f * r;
    return reach;
}

// The radius that a node is culled with, `height` levels above the leaves: larger by what rounding may do to a distance (2^-20 of it in the
// node's and as much in its child's) for each level. The tree's own slack goes with the radius and is nothing for small far spheres: without
// this a culled node could have a child that is not, and a cut that is updated would lose it.
const float cull_margin = 1.0f / 262144.0f;
MYRIAD_FN float cull_radius(vec3 d, float r, uint height) {
    MYRIAD_PRECISE const float radius = r + float(height) * (cull_margin * reach_of(d, r));
    return radius;
}

// Whether a sphere lies wholly outside the view's frustum.
MYRIAD_FN bool outside_frustum(View view, vec3 d, float r) { return frustum_distance(view, d) > r; }

// The footprint of a sphere in one half: a disc. `exists` is false where the sphere does not reach that half, `whole` is true
// where the half has to be scanned whole: the view is inside the sphere, or the sphere covers the direction opposite
// to the axis, so that the footprint is the outside of a disc.
struct Footprint {
    vec2 center;
    float radius;
    bool exists, whole;
};
MYRIAD_FN Footprint footprint(uint half_index, vec3 d, float r) {
    Footprint f;
    const float axis = half_index == half_front ? d.x : -d.x;
    const float tangent = sqrt(max(dot(d, d) - r * r, 0.0f));
    const float denominator = axis + tangent;
    f.exists = axis >= -r;
    f.whole = !(denominator > 0.0f) || !(tangent > 0.0f);
    const float scale = f.whole ? 0.0f : 1.0f / denominator;
    f.center = vec2(d.y * scale, d.z * scale);
    f.radius = f.whole ? 2.0f : r * scale;
    return f;
}
MYRIAD_END

#endif
