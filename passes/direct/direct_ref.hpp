// The plain CPU twin of the direct light.
#pragma once
#include <vector>
#include "passes/gbuffer/gbuffer_ref.hpp"
namespace myriad::passes {
// What a light sends to a point along the unit direction `to_light`, per area across it; nothing is in the way.
struct IncidentRef {
    glm::dvec3 to_light{0}, irradiance{0};
    double distance = 0;
};
IncidentRef incident_ref(const scenes::Light& light, const glm::dvec3& p);

std::vector<glm::dvec3> direct_ref(const scenes::Scene& scene, const scenes::Triangles& triangles, const std::vector<PixelRef>& gbuffer);
}  // namespace myriad::passes
