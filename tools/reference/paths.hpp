// Light paths, from the camera on: what one sample of a pixel is worth.
#pragma once

#include <optional>
#include <span>

#include "scenes/scene.hpp"
#include "tools/reference/brdf.hpp"
#include "tools/reference/lights.hpp"
#include "tools/reference/sampler.hpp"
#include "tools/reference/tracer.hpp"

namespace myriad::reference {

// Radiance to the camera, in the layers of `myriad render`.
struct Radiance {
    vec3 emission{0};   // of what is seen itself, and of what is behind everything
    vec3 direct{0};     // of punctual lights, reflected once
    vec3 indirect{0};   // all else: of emitters and surroundings reflected once, and of everything reflected more often
};

class Paths {
public:
    // `lights`: the scene's, where they stand at the moment; `bounces`: reflections before that to the camera; `bound`: see Settings.
    Paths(const scenes::Scene& scene, std::span<const scenes::Light> lights, const scenes::Triangles& triangles, uint32_t bounces, Model model, float bound);

    Radiance along(const vec3& origin, const vec3& direction, Sampler& sampler) const;

private:
    vec3 punctual(const Surface& s, const Brdf& brdf, Sampler& sampler) const;
    vec3 emitters(const Surface& s, const Brdf& brdf, float bound, Sampler& sampler) const;
    vec3 surroundings(const Surface& s, const Brdf& brdf, Sampler& sampler) const;

    const uint32_t bounces_;
    const Model model_;
    const float bound_;
    const vec3 background_;
    const Surfaces surfaces_;
    const Tracer tracer_;
    const Punctual punctual_;
    const Emitters emitters_;
    const std::optional<Surroundings> surroundings_;
};

}  // namespace myriad::reference
