// What tests of the reference share. Tests only.
#pragma once

#include <cmath>

#include "tests/scene_kit.hpp"
#include "tools/reference/reference.hpp"

namespace myriad::reference {

// Few pixels, for closed cases.
inline Settings small(uint32_t samples, uint32_t bounces = 0) {
    return {.width = 8, .height = 8, .bounces = bounces, .samples = samples};
}

inline Film film_of(scenes::Scene& scene, const Settings& settings) {
    const scenes::Triangles triangles = scenes::flatten(scene, scenes::Sharing::never);
    Film film(settings.width, settings.height);
    Reference(scene, scene.lights, triangles, scene.cameras[0], settings).add_to(film);
    return film;
}

inline tools::Image image_of(scenes::Scene& scene, const Settings& settings) { return film_of(scene, settings).image(true); }

// Of a layer's green, over all pixels: the mean, and its standard error by the image's variance.
struct Estimate {
    double mean = 0, error = 0;
};
inline Estimate mean_of(const tools::Image& image, const std::string& channel = "G") {
    Estimate e;
    const auto& values = image.find(channel)->values;
    const auto& variance = image.find("variance.G")->values;
    for (size_t i = 0; i < values.size(); ++i) e.mean += double(values[i]), e.error += double(variance[i]);
    e.mean /= double(values.size()), e.error = std::sqrt(e.error) / double(values.size());
    return e;
}

// The world's point that the middle of pixel (x, y) sees on the plane through `at` perpendicular to `n`.
inline glm::dvec3 seen_on_plane(const scenes::Camera& c, const Settings& s, uint32_t x, uint32_t y, const glm::dvec3& at, const glm::dvec3& n) {
    const double t = std::tan(0.5 * double(c.yfov));
    const glm::dvec3 local((2 * (x + 0.5) / s.width - 1) * t * s.width / s.height, (1 - 2 * (y + 0.5) / s.height) * t, -1);
    const glm::dvec3 d = glm::dmat3(c.to_world) * local, eye(c.to_world[3]);
    return eye + d * (glm::dot(at - eye, n) / glm::dot(d, n));
}

}  // namespace myriad::reference
