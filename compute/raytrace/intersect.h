// One ray against one box and one triangle: the device's formulae, which the twin runs too.
#ifndef MYRIAD_COMPUTE_RAYTRACE_INTERSECT_H
#define MYRIAD_COMPUTE_RAYTRACE_INTERSECT_H

#include "engine/shared.h"

#ifdef __cplusplus
#define precise
#endif

MYRIAD_BEGIN
// Boxes are tested with a slack of 16 ulp of the distance, which covers the three roundings of a slab's plane (Ize 2013,
// "Robust BVH ray traversal") and those of the triangle test that grow with the distance.
const float box_slack = 1.0f + 1.0f / 1048576.0f;

struct TraceRay {
    vec3 origin, direction, inverse;  // 1 / direction, but finite
    float t_min, t_max;     // t_max shrinks to the closest hit so far
    uint axis;              // the largest component of the direction; the next two follow it cyclically
    vec3 shear;             // of those two, and 1 / that component
};

// min() and max() without their care for NaN, which costs lavapipe two instructions more.
MYRIAD_FN float lesser(float a, float b) { return a < b ? a : b; }
MYRIAD_FN float greater(float a, float b) { return a > b ? a : b; }

MYRIAD_FN float ray_inverse(float d, float tiny) { return 1.0f / (abs(d) < tiny ? tiny : d); }

// The components turned so that the given axis comes last: an even permutation, which keeps orientations.
MYRIAD_FN vec3 axis_last(vec3 p, uint axis) {
    return axis == 2u ? p : axis == 1u ? vec3(p.z, p.x, p.y) : vec3(p.y, p.z, p.x);
}

// The components of 1 / direction. One of 0 becomes 2^-64 of the largest one, so that no slab is 0 * inf: a box that reaches past the origin in that
// axis by any float is then left at the far end of the world (bvh_box sees to the strictness). Directions need not be unit,
// but longer than 2^-62.
MYRIAD_FN vec3 ray_inverses(vec3 direction) {
    const vec3 size = abs(direction);
    const float tiny = greater(greater(size.x, greater(size.y, size.z)) * 5.421011e-20f, 1.1754944e-38f);  // 2^-64, 2^-126
    return vec3(ray_inverse(direction.x, tiny), ray_inverse(direction.y, tiny), ray_inverse(direction.z, tiny));
}

MYRIAD_FN TraceRay trace_ray(vec3 origin, vec3 direction, float t_min, float t_max) {
    TraceRay ray;
    ray.origin = origin;
    ray.direction = direction;
    ray.t_min = t_min;
    ray.t_max = t_max;
    const vec3 size = abs(direction);
    const float largest = greater(size.x, greater(size.y, size.z));
    ray.inverse = ray_inverses(direction);
    ray.axis = size.z == largest ? 2u : size.y == largest ? 1u : 0u;
    const vec3 d = axis_last(direction, ray.axis);
    ray.shear = vec3(d.x / d.z, d.y / d.z, 1.0f / d.z);
    return ray;
}

// Where the ray enters the box, or a negative number when it does not.
MYRIAD_FN float box_entry(vec3 lo, vec3 hi, vec3 origin, vec3 inverse, float t_min, float t_max) {
    const vec3 a = (lo - origin) * inverse, b = (hi - origin) * inverse;
    const float enter = greater(greater(lesser(a.x, b.x), lesser(a.y, b.y)), greater(lesser(a.z, b.z), t_min));
    const float leave = lesser(lesser(greater(a.x, b.x), greater(a.y, b.y)), lesser(greater(a.z, b.z), t_max));
    return enter <= leave * box_slack ? enter : -1.0f;
}

// The rounding error of a * b, exactly (Dekker 1971), without the fused multiply-add that lavapipe has not.
MYRIAD_FN float product_error(float a, float b) {
    precise const float ta = a * 4097.0f, tb = b * 4097.0f;
    precise const float ah = ta - (ta - a), bh = tb - (tb - b), al = a - ah, bl = b - bh;
    precise const float error = ((ah * bh - a * b) + ah * bl + al * bh) + al * bl;
    return error;
}

// Twice the signed area of (0, b, a): its sign is exact, for rounding is monotonic and ties are settled by the errors.
MYRIAD_FN float edge_function(float ax, float ay, float bx, float by) {
    precise const float area = ax * by - ay * bx;
    return area;
}
MYRIAD_FN float edge_tie(float ax, float ay, float bx, float by) { return product_error(ax, by) - product_error(ay, bx); }

// Watertight (Woop, Benthin, Wald 2013, "Watertight ray/triangle intersection"): vertices are sheared into the plane in
// which the ray is a point, each in the same way whatever triangle asks, and the edge functions of the two triangles at an
// edge are exact negatives; `precise` forbids the fused forms that are not. A point on an edge belongs to both. Signs are
// exact: without that, a triangle too small for its distance is hit by rays that pass anywhere.
// The distance is the plane's, as in Embree: the paper's mean of the vertices' depths is off by the triangle's length where
// a long one is met at a low angle. It is clamped to those depths, which is all that is known of a triangle seen edge-on.
// `weights` are of p1 and p2; z is positive when the ray meets the side that sees p0, p1, p2 counter-clockwise.
MYRIAD_FN bool triangle_hit(TraceRay ray, vec3 p0, vec3 p1, vec3 p2, MYRIAD_INOUT(float) t, MYRIAD_INOUT(vec3) weights) {
    const vec3 a = axis_last(p0 - ray.origin, ray.axis), b = axis_last(p1 - ray.origin, ray.axis), c = axis_last(p2 - ray.origin, ray.axis);
    precise const float ax = a.x - ray.shear.x * a.z, ay = a.y - ray.shear.y * a.z;
    precise const float bx = b.x - ray.shear.x * b.z, by = b.y - ray.shear.y * b.z;
    precise const float cx = c.x - ray.shear.x * c.z, cy = c.y - ray.shear.y * c.z;
    float u = edge_function(cx, cy, bx, by), v = edge_function(ax, ay, cx, cy), w = edge_function(bx, by, ax, ay);
    if (u == 0.0f || v == 0.0f || w == 0.0f) {
        if (u == 0.0f) u = edge_tie(cx, cy, bx, by);
        if (v == 0.0f) v = edge_tie(ax, ay, cx, cy);
        if (w == 0.0f) w = edge_tie(bx, by, ax, ay);
    }
    precise const float area = u + v + w;
    precise const vec3 normal = cross(p1 - p0, p2 - p0);
    precise const float plane = dot(normal, p0 - ray.origin) / dot(normal, ray.direction);
    const float ta = a.z * ray.shear.z, tb = b.z * ray.shear.z, tc = c.z * ray.shear.z;
    t = lesser(greater(plane, lesser(ta, lesser(tb, tc))), greater(ta, greater(tb, tc)));
    weights = vec3(v / area, w / area, area * ray.shear.z);
    const bool inside = lesser(u, lesser(v, w)) >= 0.0f || greater(u, greater(v, w)) <= 0.0f;
    return inside && area != 0.0f && t > ray.t_min;
}
MYRIAD_END

#ifdef __cplusplus
#undef precise
#endif

#endif
