// Pinhole views: what a camera sees, of which there is one (ManyLoDs 5, "single-view rendering": m = 1).
//
// The 32 bytes of a View hold one as well. `direction` is the camera's rotation as a rotation vector of length tan(angle / 4) (Rodrigues'
// parameters, modified): well conditioned for all angles, which a quaternion with its real part left out is not. `sin_phi` is the tangent of
// half the vertical angle of view. `cos_phi` is 1e15 times a margin in metres: what is as near as that to what is seen is not culled. No cone has
// such a cosine. `map_size` is the size of the image, pinhole_size; pixels are square.
//
// The outline of a sphere, seen through a pinhole, is an ellipse. With d = centre - eye, L = |d|, z = d . forward, its extents on the plane at
// the distance 1 are, for the angle a of d from the axis and b = asin(r / L),
//     tan(a + b) - tan(a - b) = sin(2 b) / (cos(a)^2 - sin(b)^2) = 2 r sqrt(L^2 - r^2) / (z^2 - r^2)   along the meridian
//     2 r / sqrt(z^2 - r^2)                                                                            across
// of which the first is never the smaller. No trigonometry, and nothing approximate.
#ifndef MYRIAD_COMPUTE_PINHOLE_H
#define MYRIAD_COMPUTE_PINHOLE_H

#include "compute/views/paraboloid.h"

MYRIAD_BEGIN
// Kernels look at views of one kind, which this specialisation constant says; see parallel_constant.
const uint pinhole_constant = 21u;
MYRIAD_END

#ifdef __cplusplus
namespace myriad {
inline bool is_pinhole(const View& view) { return view.cos_phi > 1.0f; }
}  // namespace myriad
#else
layout(constant_id = pinhole_constant) const bool pinhole_views = false;
bool is_pinhole(View view) { return pinhole_views; }
#endif

MYRIAD_BEGIN
MYRIAD_FN uint pinhole_size(uint width, uint height) { return width | (height << 16); }  // both below 2^16

// Unit axes, and the tangents of half the angles of view.
struct Pinhole {
    vec3 right, up, forward;
    float tan_x, tan_y;
    float pixel;   // the side of a pixel at distance 1
    float margin;
};
MYRIAD_FN Pinhole pinhole_of(View view, uint size) {
    // The quaternion of the rotation that takes +x, +y, -z to right, up, forward.
    const float p2 = dot(view.direction, view.direction);
    const vec3 q = (2.0f / (1.0f + p2)) * view.direction;
    const float w = (1.0f - p2) / (1.0f + p2);
    Pinhole p;
    p.right = vec3(1.0f - 2.0f * (q.y * q.y + q.z * q.z), 2.0f * (q.x * q.y + w * q.z), 2.0f * (q.x * q.z - w * q.y));
    p.up = vec3(2.0f * (q.x * q.y - w * q.z), 1.0f - 2.0f * (q.x * q.x + q.z * q.z), 2.0f * (q.y * q.z + w * q.x));
    p.forward = vec3(-2.0f * (q.x * q.z + w * q.y), -2.0f * (q.y * q.z - w * q.x), 2.0f * (q.x * q.x + q.y * q.y) - 1.0f);
    p.tan_y = view.sin_phi;
    p.tan_x = view.sin_phi * float(size & 0xffffu) / float(size >> 16);
    p.pixel = 2.0f * view.sin_phi / float(size >> 16);
    p.margin = view.cos_phi * 1e-15f;
    return p;
}

// Whether a sphere lies wholly outside the pyramid that the camera sees: beyond one of its sides, or behind the eye.
MYRIAD_FN bool pinhole_outside(Pinhole p, vec3 d, float r) {
    const float z = dot(d, p.forward);
    const float x = abs(dot(d, p.right)) - z * p.tan_x;
    const float y = abs(dot(d, p.up)) - z * p.tan_y;
    const float near = r + p.margin;
    return z < -near || x > near * sqrt(1.0f + p.tan_x * p.tan_x) || y > near * sqrt(1.0f + p.tan_y * p.tan_y);
}

// The larger diameter, in pixels, of a sphere's outline; infinite where the sphere reaches the plane through the eye.
MYRIAD_FN float pinhole_diameter(Pinhole p, vec3 d, float r) {
    const float z = dot(d, p.forward);
    const float clear = z * z - r * r;
    if (!(z > r) || !(clear > 0.0f)) return uintBitsToFloat(0x7f800000u);
    return 2.0f * r * sqrt(max(dot(d, d) - r * r, 0.0f)) / (clear * p.pixel);
}
MYRIAD_FN bool pinhole_fits(Pinhole p, vec3 d, float r, float epsilon) { return pinhole_diameter(p, d, r) < epsilon; }
MYRIAD_END

#ifdef __cplusplus
#include <algorithm>

#include <glm/gtc/quaternion.hpp>

namespace myriad {
// `forward` is unit, `up` as long as the tangent of half the vertical angle of view, as of a CameraPush; all are perpendicular.
inline View pinhole_view(const vec3& eye, const vec3& right, const vec3& up, const vec3& forward, float margin = 0) {
    glm::dquat q = glm::quat_cast(glm::dmat3(glm::normalize(glm::dvec3(right)), glm::normalize(glm::dvec3(up)), -glm::dvec3(forward)));
    if (q.w < 0) q = -q;
    return {eye, std::max(margin, 1e-14f) * 1e15f, vec3(glm::dvec3(q.x, q.y, q.z) / (1 + q.w)), float(glm::length(glm::dvec3(up)))};
}
}  // namespace myriad
#endif

#endif
