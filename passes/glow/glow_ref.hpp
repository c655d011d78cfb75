// The plain CPU twin of glow, in doubles.
#pragma once

#include "passes/gather/host_gbuffer.hpp"
#include "passes/geometry/lights.hpp"
#include "scenes/scene.hpp"

namespace myriad::passes {

// What is added to a pixel's emitted light, and how far floats and units may be from it.
struct GlowRef {
    glm::dvec3 radiance{0}, slack{0};
};
std::vector<GlowRef> glow_ref(const HostGBuffer& gbuffer, const scenes::Camera& camera, const std::vector<scenes::Light>& lights);

}  // namespace myriad::passes
