#include "passes/glow/glow_ref.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "passes/glow/glow_io.h"

namespace myriad::passes {

using glm::dvec3;

// Written for clarity and without the kernel's own formulae, so that the two check each other.
std::vector<GlowRef> glow_ref(const HostGBuffer& gbuffer, const scenes::Camera& camera, const std::vector<scenes::Light>& lights) {
    std::vector<GlowRef> out(gbuffer.pixels());
    const dvec3 eye(camera.to_world[3]), right = normalize(dvec3(camera.to_world[0])), up = normalize(dvec3(camera.to_world[1])), back = normalize(dvec3(camera.to_world[2]));
    const double pixels_at_1 = gbuffer.height / 2.0 / std::tan(double(camera.yfov) / 2);  // pixels that a metre takes at a metre's distance
    double most = 0, count = 0;
    for (const scenes::Light& light : lights) {
        if (light.type != scenes::Light::Type::point || !(light.radius > 0)) continue;
        const double area = std::numbers::pi * double(light.radius) * light.radius;
        for (int c = 0; c < 3; ++c) most = std::max(most, double(light.intensity[c]) / area);
        ++count;
    }
    const double unit = most * count / 4294967295.0;
    for (const scenes::Light& light : lights) {
        if (light.type != scenes::Light::Type::point || !(light.radius > 0)) continue;
        const dvec3 d = dvec3(light.position) - eye;
        const double depth = -dot(d, back);
        if (depth <= double(light.radius)) continue;
        const double x = gbuffer.width / 2.0 + dot(d, right) / depth * pixels_at_1, y = gbuffer.height / 2.0 - dot(d, up) / depth * pixels_at_1;
        const double own = light.radius / depth * pixels_at_1, radius = std::clamp(std::sqrt(3.0) * own, double(glow_least), double(glow_reach));
        const dvec3 radiance = dvec3(light.intensity) / (std::numbers::pi * light.radius * light.radius) * std::min(1.0, 3 * own * own / (radius * radius));
        for (size_t i = 0; i < out.size(); ++i) {
            const double dx = double(i % gbuffer.width) + 0.5 - x, dy = double(i / gbuffer.width) + 0.5 - y, s2 = (dx * dx + dy * dy) / (radius * radius);
            if (s2 > 1.001) continue;
            const double surface = gbuffer.hit(i) ? double(gbuffer.positions[i].w) : 1e30;
            const double falloff = std::pow(std::max(1 - s2, 0.0), 2);
            const bool unsure = std::abs(surface - depth) <= 1e-6 * (depth + length(d));
            // Places are good to 1e-6 of the image or so, which falloff's slope of at most 2 / radius multiplies.
            const double rounding = 4e-6 * (gbuffer.width + gbuffer.height + std::abs(x) + std::abs(y)) / radius + 4e-6;
            if (unsure) out[i].radiance += 0.5 * falloff * radiance, out[i].slack += (0.5 * falloff + rounding) * radiance + unit;
            else if (surface > depth) out[i].radiance += falloff * radiance, out[i].slack += rounding * radiance + unit;
        }
    }
    return out;
}

}  // namespace myriad::passes
