// The plain CPU twin of the filter, in doubles.
#pragma once
#include "passes/filter/filter_io.h"
#include "passes/gather/host_gbuffer.hpp"
namespace myriad::passes {
std::vector<glm::dvec3> filter_ref(const HostGBuffer& gbuffer, const std::vector<vec4>& irradiance, uint block, double pixel_angle);
}  // namespace myriad::passes
