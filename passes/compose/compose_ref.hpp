// The plain CPU twin of compose, in doubles.
#pragma once
#include "passes/gather/host_gbuffer.hpp"
namespace myriad::passes {
struct ComposedRef {
    glm::dvec3 indirect, beauty, direct;
};
// Null: there is no such light.
std::vector<ComposedRef> compose_ref(const HostGBuffer& gbuffer, const std::vector<vec4>* irradiance, const std::vector<vec4>* natural,
                                     const std::vector<vec4>* direct, const std::vector<vec4>* lamps = nullptr, const std::vector<vec4>* beyond = nullptr);
}  // namespace myriad::passes
