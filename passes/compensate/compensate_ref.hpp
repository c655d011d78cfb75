// The plain CPU twin of compensate: rays in double precision against all triangles, the points of vpl_sampling.h.
#pragma once
#include <vector>
#include "passes/gather/host_gbuffer.hpp"
#include "passes/geometry/geometry_ref.hpp"
namespace myriad::passes {
std::vector<glm::dvec3> compensate_ref(const scenes::Scene& scene, const scenes::Triangles& triangles, const HostGBuffer& gbuffer, float bound, uint32_t rays, uint32_t bounces,
                                       uint32_t seed);
}  // namespace myriad::passes
