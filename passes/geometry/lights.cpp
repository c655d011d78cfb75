#include "passes/geometry/lights.hpp"

#include <algorithm>
#include <numbers>

#include "engine/transfer.hpp"
#include "passes/geometry/geometry.hpp"

namespace myriad::passes {
namespace {

using glm::dvec3;

double mean(const dvec3& rgb) { return (rgb.x + rgb.y + rgb.z) / 3; }

// In W. Double: a hundred thousand small shares are summed.
double power_of(const Light& light) {
    const dvec3 intensity(light.intensity);
    switch (light.type) {
        case light_spot: return mean(intensity) * double(spot_solid_angle(light));
        case light_directional: {
            const vec3 areas = directional_areas(light);
            return mean(intensity) * (double(areas.x) + areas.y + areas.z);
        }
        default: return mean(intensity) * 4 * std::numbers::pi;
    }
}

Light punctual_light(const scenes::Light& from, const scenes::Triangles& triangles) {
    Light light{.position = from.position, .type = uint(from.type), .direction = from.direction, .cdf = 0,
                .intensity = from.intensity, .triangle = scenes::none, .extent = vec3(0), .cos_outer = 0};
    if (light.type == light_spot) {
        light.cos_outer = float(std::cos(double(from.outer_cone)));
        light.extent.x = float(std::max(0.001, std::cos(double(from.inner_cone)) - std::cos(double(from.outer_cone))));
    } else if (light.type == light_directional) {
        light.position = triangles.lo;
        light.extent = triangles.hi - triangles.lo;
    }
    return light;
}

// The emission of a material, with the mean of all texels standing for its texture.
dvec3 mean_radiance(const scenes::Scene& scene, const scenes::Material& material) {
    dvec3 radiance(material.emissive);
    if (radiance == dvec3(0) || material.emissive_texture.texture == scenes::none) return radiance;
    const scenes::Texture& texture = scene.textures[material.emissive_texture.texture];
    if (texture.rgba.empty()) return radiance;
    double linear[256];
    for (int code = 0; code < 256; ++code) linear[code] = srgb_to_linear(uint8_t(code));
    dvec3 sum(0);
    for (size_t i = 0; i + 3 < texture.rgba.size(); i += 4)
        sum += dvec3(linear[texture.rgba[i]], linear[texture.rgba[i + 1]], linear[texture.rgba[i + 2]]);
    return radiance * sum / double(texture.rgba.size() / 4);
}

double area_of(const Corners& c) {
    const dvec3 p(c.p0);
    return 0.5 * glm::length(glm::cross(dvec3(c.p1) - p, dvec3(c.p2) - p));
}

}  // namespace

LightData light_data(const scenes::Scene& scene, const scenes::Triangles& triangles) {
    LightData data;
    for (const scenes::Light& light : scene.lights) {
        data.lights.push_back(punctual_light(light, triangles));
        data.powers.push_back(power_of(data.lights.back()));
    }
    data.punctual = uint32_t(data.lights.size());

    std::vector<dvec3> radiance;
    for (const scenes::Material& material : scene.materials) radiance.push_back(mean_radiance(scene, material));
    const bool emits = std::any_of(radiance.begin(), radiance.end(), [](const dvec3& r) { return r != dvec3(0); });
    if (emits) world_triangles(triangles).for_each([&](uint32_t i, uint32_t stored, const Corners& corners) {
        const uint32_t material = triangles.triangles[stored].w;
        if (radiance[material] == dvec3(0)) return;
        const double area = (scene.materials[material].double_sided ? 2 : 1) * area_of(corners);
        const double power = mean(radiance[material]) * std::numbers::pi * area;
        if (!(power > 0)) return;
        data.lights.push_back({.position = vec3(0), .type = light_triangle, .direction = vec3(0), .cdf = 0,
                               .intensity = vec3(radiance[material]), .triangle = uint(i), .extent = vec3(float(area), 0, 0), .cos_outer = 0});
        data.powers.push_back(power);
    });
    for (double power : data.powers) data.power += power;
    share_out(data.lights, data.powers);
    return data;
}

void share_out(std::vector<Light>& lights, const std::vector<double>& weights) {
    double total = 0, sum = 0;
    for (double weight : weights) total += weight;
    for (size_t i = 0; i < lights.size(); ++i) {
        sum += weights[i];
        lights[i].cdf = total > 0 ? float(sum / total) : 0;
    }
    // Rounding must not leave a gap at the end, nor give it to lights of no weight.
    for (size_t i = lights.size(); total > 0 && i-- > 0;) {
        lights[i].cdf = 1;
        if (weights[i] > 0) break;
    }
}

LightTable::LightTable(engine::Device& device, const scenes::Scene& scene, const scenes::Triangles& triangles)
    : LightTable(device, light_data(scene, triangles)) {}

LightTable::LightTable(engine::Device& device, LightData data)
    : data_(std::move(data)), lights_(engine::upload(device, "scene", "lights", data_.lights)) {}

}  // namespace myriad::passes
