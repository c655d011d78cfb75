// The plain CPU twin of the G-buffer.
#pragma once
#include <vector>
#include "passes/geometry/geometry_ref.hpp"
namespace myriad::passes {
struct PixelRef {
    SurfaceRef surface;
    double depth = 0;       // 0: nothing is seen
    glm::dvec3 direction{0};// of the ray that sees it
};
std::vector<PixelRef> gbuffer_ref(const scenes::Scene& scene, const scenes::Triangles& triangles, const scenes::Camera& camera,
                                  uint32_t width, uint32_t height);
}  // namespace myriad::passes
