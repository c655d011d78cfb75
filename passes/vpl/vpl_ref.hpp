// The plain CPU twin of the VPLs: one loop over paths, rays in double precision, the points of vpl_sampling.h.
#pragma once
#include <vector>
#include "passes/vpl/vpl_io.h"
#include "scenes/scene.hpp"
namespace myriad::passes {
std::vector<Vpl> vpl_ref(const scenes::Scene& scene, const scenes::Triangles& triangles, uint32_t max_vpls, uint32_t bounces, uint32_t seed);
}  // namespace myriad::passes
