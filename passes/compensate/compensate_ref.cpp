#include "passes/compensate/compensate_ref.hpp"

#include <algorithm>
#include <numbers>

#include "passes/compensate/compensate_io.h"
#include "passes/direct/direct_ref.hpp"
#include "passes/geometry/lights.hpp"
#include "passes/vpl/vpl_sampling.h"

namespace myriad::passes {
namespace {

using glm::dot;
using glm::dvec3;

struct Walk {
    const scenes::Scene& scene;
    const scenes::Triangles& triangles;
    const LightData table = light_data(scene, triangles, geometry_data(scene, triangles));
    const ThereRef there = there_ref(scene, triangles);
    const double offset = 2e-6 * std::max(glm::length(triangles.lo), glm::length(triangles.hi));

    uint32_t index = 0, seed = 0;
    vec2 choice(uint32_t vertex, uint32_t which) const { return path_bounce_point(index, 3 * vertex + which, seed); }
    dvec3 direction(uint32_t vertex, const dvec3& n) const { return dvec3(cosine_direction(choice(vertex, 0), vec3(n))); }

    // What one light brings to y, over pi.
    dvec3 light_on(const SurfaceRef& y, uint32_t vertex) const {
        const float selection = std::min(choice(vertex, 1).x, 0.99999994f);
        uint32_t chosen = 0;
        while (table.lights[chosen].cdf <= selection) ++chosen;
        const Light& light = table.lights[chosen];
        const double share = double(light.cdf) - (chosen ? double(table.lights[chosen - 1].cdf) : 0);
        const dvec3 from = y.position + offset * y.geometric_normal;
        dvec3 way, across;
        double far;
        if (light.type == light_triangle) {
            const vec2 place = triangle_point(choice(vertex, 2));
            if (!there(light.triangle, double(place.x), double(place.y))) return dvec3(0);
            SurfaceRef s = surface_ref(scene, triangles, light.triangle, double(place.x), double(place.y));
            s = face_towards_ref(s, glm::normalize(s.position - y.position));
            way = s.position + offset * s.geometric_normal - from;
            far = glm::length(way);
            const uvec4 t = triangles.triangles[light.triangle];
            const dvec3 p(triangles.positions[t.x]);
            const double area = 0.5 * glm::length(glm::cross(dvec3(triangles.positions[t.y]) - p, dvec3(triangles.positions[t.z]) - p));
            across = s.emission * area * std::max(-dot(s.geometric_normal, way), 0.0) / (far * far * far);
        } else {
            const IncidentRef incident = incident_ref(scene.lights[chosen], y.position);
            way = incident.to_light, far = 0.9999 * incident.distance, across = incident.irradiance;
        }
        const double cosine = dot(y.geometric_normal, glm::normalize(way));
        if (cosine <= 0 || closest_ref(triangles, from, glm::normalize(way), 0, far, there)) return dvec3(0);
        return across * cosine / (std::numbers::pi * share);
    }

    dvec3 irradiance(const HostGBuffer& g, size_t pixel, double bound, uint32_t bounces) const {
        const dvec3 n(g.shading(pixel)), n_g(g.geometric(pixel));
        dvec3 way = direction(0, n);
        if (dot(way, n_g) <= 0) return dvec3(0);
        HitRef hit = closest_ref(triangles, dvec3(g.position(pixel)) + offset * n_g, way, 0, 1 / std::sqrt(bound), there);
        if (!hit) return dvec3(0);
        SurfaceRef s = face_towards_ref(surface_ref(scene, triangles, hit.triangle, hit.u, hit.v), way);
        const double term = dot(n, way) * -dot(s.geometric_normal, way) / (hit.t * hit.t);
        if (!(term > bound)) return dvec3(0);
        const BrdfRef f = brdf_ref(g.gloss_ref(pixel), n, g.gloss.empty() ? n : dvec3(g.lobe(pixel).view), way);
        const double weight = (term - bound) / term * f.diffuse * std::numbers::pi * std::numbers::pi;
        dvec3 radiance = s.emission, carried(1);
        for (uint32_t bounce = 1; bounce <= bounces; ++bounce) {
            carried *= s.albedo;
            radiance += carried * light_on(s, bounce);
            way = direction(bounce, s.geometric_normal);
            hit = closest_ref(triangles, s.position + offset * s.geometric_normal, way, 0, 1e30, there);
            if (!hit) break;
            s = face_towards_ref(surface_ref(scene, triangles, hit.triangle, hit.u, hit.v), way);
        }
        return radiance * weight;
    }
};

}  // namespace

std::vector<dvec3> compensate_ref(const scenes::Scene& scene, const scenes::Triangles& triangles, const HostGBuffer& gbuffer, float bound, uint32_t rays, uint32_t bounces,
                                  uint32_t seed) {
    Walk walk{scene, triangles};
    std::vector<dvec3> sums(gbuffer.pixels(), dvec3(0));
    for (uint32_t i = 0; i < gbuffer.pixels(); ++i)
        for (uint32_t ray = 0; ray < rays && gbuffer.hit(i); ++ray) {
            walk.index = compensate_index(i % gbuffer.width, i / gbuffer.width, ray);
            walk.seed = compensate_seed(i % gbuffer.width, i / gbuffer.width, seed);
            sums[i] += walk.irradiance(gbuffer, i, double(bound), bounces) / double(rays);
        }
    return sums;
}

}  // namespace myriad::passes
