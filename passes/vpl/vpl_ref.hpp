// The plain CPU twin of the VPLs: one loop over paths, rays in double precision, the points of vpl_sampling.h.
#pragma once
#include <vector>
#include "passes/vpl/guide.hpp"
#include "scenes/scene.hpp"
namespace myriad::passes {
// By power, max_vpls / (VPLs a path) paths; with a guide, as many as it says.
std::vector<Vpl> vpl_ref(const scenes::Scene& scene, const scenes::Triangles& triangles, uint32_t max_vpls, uint32_t bounces, uint32_t seed,
                         const GuideData* guide = nullptr, uint32_t guided_paths = 0);

// Where the guide moves a point of a punctual light's domain, and how much denser points are there.
struct GuidedPlace {
    vec2 place;
    double density;
};
GuidedPlace guided_place_ref(const GuideData& guide, uint32_t light, const vec2& x);

// Who has which place, frame after frame.
struct PlacesRef {
    uint32_t max_vpls;
    std::vector<uint32_t> owners = {};  // slots, by place
    std::vector<bool> alive = {};       // by place
    size_t homeless = 0;

    void step(const std::vector<uint32_t>& living);  // slots, ascending
};
}  // namespace myriad::passes
