#include "passes/direct/direct_ref.hpp"

#include <algorithm>
#include <cmath>

namespace myriad::passes {

using glm::dvec3;

IncidentRef incident_ref(const scenes::Light& light, const dvec3& p) {
    if (light.type == scenes::Light::Type::directional) return {-dvec3(light.direction), dvec3(light.intensity), 1e30};
    const dvec3 d = dvec3(light.position) - p;
    IncidentRef incident{glm::normalize(d), dvec3(light.intensity) / std::max(glm::dot(d, d), double(light.radius) * double(light.radius)), glm::length(d)};
    if (light.type == scenes::Light::Type::spot) {
        // KHR_lights_punctual, in the words of its sample code.
        const double scale = 1 / std::max(0.001, std::cos(double(light.inner_cone)) - std::cos(double(light.outer_cone)));
        const double offset = -std::cos(double(light.outer_cone)) * scale;
        const double attenuation = std::clamp(glm::dot(dvec3(light.direction), -incident.to_light) * scale + offset, 0.0, 1.0);
        incident.irradiance *= attenuation * attenuation;
    }
    return incident;
}

std::vector<dvec3> direct_ref(const scenes::Scene& scene, const scenes::Triangles& triangles, const std::vector<PixelRef>& gbuffer) {
    const ThereRef there = there_ref(scene, triangles);
    std::vector<dvec3> radiance;
    for (const PixelRef& pixel : gbuffer) {
        dvec3 sum(0);
        for (const scenes::Light& light : scene.lights) {
            if (!(pixel.depth > 0)) break;
            const SurfaceRef& s = pixel.surface;
            const IncidentRef incident = incident_ref(light, s.position);
            const double cosine = glm::dot(s.shading_normal, incident.to_light);
            if (cosine <= 0 || glm::dot(s.geometric_normal, incident.to_light) <= 0) continue;
            if (closest_ref(triangles, s.position, incident.to_light, 1e-5, incident.distance, there)) continue;
            const BrdfRef f = brdf_ref(s.gloss, s.shading_normal, -pixel.direction, incident.to_light);
            sum += (s.albedo * f.diffuse + f.glossy * f.fresnel) * cosine * incident.irradiance;
        }
        radiance.push_back(sum);
    }
    return radiance;
}

}  // namespace myriad::passes
