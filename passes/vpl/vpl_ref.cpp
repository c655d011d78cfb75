#include "passes/vpl/vpl_ref.hpp"

#include <bit>
#include <map>
#include <numbers>

#include "passes/geometry/geometry_ref.hpp"
#include "passes/geometry/lights.hpp"
#include "passes/vpl/vpl_sampling.h"

namespace myriad::passes {

using glm::dvec3;

GuidedPlace guided_place_ref(const GuideData& guide, uint32_t light, const vec2& x) {
    GuidedPlace at{x, 1};
    uint32_t first = light * guide_floats;
    for (int axis = 0; axis < 2; ++axis) {
        uint32_t strip = 0;
        while (guide.cells[first + strip] <= x[axis]) ++strip;
        const double before = strip ? double(guide.cells[first + strip - 1]) : 0, width = double(guide.cells[first + strip]) - before;
        at.place[axis] = float((strip + (double(x[axis]) - before) / width) / guide_side);
        at.density *= width * guide_side;
        first = light * guide_floats + guide_side * (strip + 1);
    }
    return at;
}

std::vector<Vpl> vpl_ref(const scenes::Scene& scene, const scenes::Triangles& triangles, uint32_t max_vpls, uint32_t bounces, uint32_t seed,
                         const GuideData* guide, uint32_t guided_paths) {
    LightData table = light_data(scene, triangles, geometry_data(scene, triangles));
    const ThereRef there = there_ref(scene, triangles);
    if (guide) table.lights = guide->lights;
    const bool emissive = table.lights.size() > table.punctual;
    const uint32_t layers = bounces + emissive;
    if (table.power == 0 || layers == 0) return {};
    const uint32_t paths = guide ? guided_paths : max_vpls / layers, bits = uint32_t(std::bit_width(paths - 1));
    const double offset = 1e-6 * std::max(glm::length(triangles.lo), glm::length(triangles.hi));
    std::vector<std::vector<Vpl>> by_layer(layers);

    for (uint32_t path = 0; path < paths; ++path) {
        const float selection = path_selection(path, paths, seed);
        uint32_t chosen = 0;
        while (table.lights[chosen].cdf <= selection) ++chosen;
        const Light& light = table.lights[chosen];
        const float before = chosen ? table.lights[chosen - 1].cdf : 0;
        const double share = double(light.cdf) - before;
        const uint32_t index = path_index(path, bits);
        const vec4 x = path_emission_point(index, seed);

        dvec3 flux, at, normal, direction;
        uint32_t bounce = 0;
        const auto leave = [&] {
            if (flux == dvec3(0)) return false;
            by_layer[bounce - !emissive].push_back({vec3(at + offset * normal), pack_direction(vec3(normal)), vec3(flux), bounce});
            return true;
        };
        if (light.type == light_triangle) {
            const vec2 place = triangle_point(vec2(x));
            if (!there(light.triangle, double(place.x), double(place.y))) continue;
            SurfaceRef s = surface_ref(scene, triangles, light.triangle, double(place.x), double(place.y));
            const double sides = s.double_sided ? 2 : 1, rest = (double(selection) - before) / share;
            const uvec4 t = triangles.triangles[light.triangle];
            const dvec3 p(triangles.positions[t.x]);
            const double area = 0.5 * glm::length(glm::cross(dvec3(triangles.positions[t.y]) - p, dvec3(triangles.positions[t.z]) - p));
            at = s.position;
            normal = s.double_sided && rest >= 0.5 ? -s.geometric_normal : s.geometric_normal;
            flux = s.emission * (std::numbers::pi * area * sides / (share * paths));
            if (!leave()) continue;
            direction = dvec3(cosine_direction(vec2(x.z, x.w), unpack_direction(pack_direction(vec3(normal)))));
        } else {
            const GuidedPlace from = guide && chosen < table.guided() ? guided_place_ref(*guide, chosen, vec2(x)) : GuidedPlace{vec2(x), 1};
            const Emission e = emit_punctual(light, from.place);
            at = dvec3(e.origin), direction = dvec3(e.direction), normal = dvec3(0);
            flux = dvec3(e.flux) / (share * paths * from.density);
        }
        while (++bounce <= bounces) {
            const HitRef hit = closest_ref(triangles, at + offset * normal, direction, 0, 1e30, there);
            if (!hit) break;
            const SurfaceRef s = face_towards_ref(surface_ref(scene, triangles, hit.triangle, hit.u, hit.v), direction);
            at = s.position, normal = s.geometric_normal, flux *= s.albedo;
            if (!leave()) break;
            direction = dvec3(cosine_direction(path_bounce_point(index, bounce, seed), unpack_direction(pack_direction(vec3(normal)))));
        }
    }
    std::vector<Vpl> vpls;
    for (const auto& layer : by_layer) vpls.insert(vpls.end(), layer.begin(), layer.end());
    return vpls;
}

void PlacesRef::step(const std::vector<uint32_t>& living) {
    std::map<uint32_t, uint32_t> dead;  // slot to place
    for (uint32_t place = 0; place < owners.size(); ++place) dead[owners[place]] = place;
    alive.assign(owners.size(), false);
    std::vector<uint32_t> asking;
    for (uint32_t slot : living) {
        const auto own = dead.find(slot);
        if (own == dead.end()) {
            asking.push_back(slot);
            continue;
        }
        alive[own->second] = true;
        dead.erase(own);
    }
    homeless = 0;
    for (uint32_t slot : asking) {
        if (!dead.empty()) {
            owners[dead.begin()->second] = slot, alive[dead.begin()->second] = true;
            dead.erase(dead.begin());
        } else if (owners.size() < max_vpls) {
            owners.push_back(slot), alive.push_back(true);
        } else {
            ++homeless;
        }
    }
}

}  // namespace myriad::passes
