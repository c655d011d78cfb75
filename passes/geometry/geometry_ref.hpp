// Plain CPU twins: a surface, and rays against all triangles, in double precision and straight from the scene.
#pragma once
#include <functional>
#include <limits>
#include "compute/opacity/opacity_io.h"
#include "passes/brdf/brdf_ref.hpp"
#include "scenes/scene.hpp"
namespace myriad::passes {

struct SurfaceRef {
    glm::dvec3 position{0}, geometric_normal{0}, shading_normal{0}, albedo{0}, emission{0};
    GlossRef gloss;
    bool double_sided = false;
};
// A filtered texel, decoded if it is a colour; alpha never is.
glm::dvec4 texture_ref(const scenes::Texture& texture, glm::dvec2 uv, bool srgb);
SurfaceRef surface_ref(const scenes::Scene& scene, const scenes::Triangles& triangles, uint32_t triangle, double u, double v);
SurfaceRef face_towards_ref(SurfaceRef surface, const glm::dvec3& direction);

struct HitRef {
    double t = std::numeric_limits<double>::infinity();
    uint32_t triangle = scenes::none;
    double u = 0, v = 0;
    explicit operator bool() const { return triangle != scenes::none; }
};
// Where triangles are: cut-outs and blended surfaces, by the hash that kernels throw. No function: everywhere.
double alpha_ref(const scenes::Scene& scene, const scenes::Triangles& triangles, uint32_t triangle, double u, double v);
using ThereRef = std::function<bool(uint32_t triangle, double u, double v)>;
ThereRef there_ref(const scenes::Scene& scene, const scenes::Triangles& triangles, uint dice = opacity_alone);

HitRef closest_ref(const scenes::Triangles& triangles, const glm::dvec3& origin, const glm::dvec3& direction, double t_min, double t_max,
                   const ThereRef& there = {});

}  // namespace myriad::passes
