#include "compute/raytrace/raytrace_ref.hpp"

#include <algorithm>
#include <limits>

#include "compute/raytrace/intersect.h"

namespace myriad::compute {

RayHitRecord closest_ref(std::span<const BvhTriangle> triangles, const Ray& r, const WorldTriangles& world) {
    const TraceRay ray = trace_ray(r.origin, r.direction, r.t_min, r.t_max);
    RayHitRecord best{.t = r.t_max, .triangle = ~0u, .u = 0, .v = 0, .front = 0};
    for (const BvhTriangle& triangle : triangles) {
        float t = 0;
        vec3 weights{0};
        if (!triangle_hit(ray, triangle.p0, triangle.p1, triangle.p2, t, weights)) continue;
        const uint id = triangle.id & ~bvh_asks;
        if (!world.is_there(id, weights.x, weights.y)) continue;
        if (t < best.t || (t == best.t && best.triangle != ~0u && id < best.triangle))
            best = {t, id, weights.x, weights.y, weights.z > 0 ? 1u : 0u};
    }
    return best;
}

bool occluded_ref(std::span<const BvhTriangle> triangles, const Ray& ray, const WorldTriangles& world) {
    return closest_ref(triangles, ray, world).triangle != ~0u;
}

ExactHit closest_exact(std::span<const glm::vec3> positions, std::span<const glm::uvec4> triangles, const Ray& ray) {
    using glm::dvec3;
    ExactHit best{std::numeric_limits<double>::infinity(), ~0u, 0, 0, 0};
    double nearly = -std::numeric_limits<double>::infinity();  // the largest margin of all misses
    const dvec3 o(ray.origin), d(ray.direction);
    for (uint i = 0; i < triangles.size(); ++i) {
        const dvec3 p0(positions[triangles[i].x]), e1 = dvec3(positions[triangles[i].y]) - p0, e2 = dvec3(positions[triangles[i].z]) - p0;
        const dvec3 p = cross(d, e2);
        const double det = dot(e1, p);
        if (det == 0) continue;
        const dvec3 s = o - p0, q = cross(s, e1);
        const double u = dot(s, p) / det, v = dot(d, q) / det, t = dot(e2, q) / det;
        const double margin = std::min({u, v, 1 - u - v});
        if (t <= ray.t_min || t >= std::min(best.t, double(ray.t_max))) continue;
        if (margin >= 0) best = {t, i, u, v, margin};
        else nearly = std::max(nearly, margin);
    }
    if (best.triangle == ~0u) best.margin = nearly;
    return best;
}

}  // namespace myriad::compute
