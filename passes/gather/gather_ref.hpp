// The plain CPU twin of the gather, in doubles.
#pragma once

#include <functional>

#include "passes/gather/gather_io.h"
#include "passes/gather/host_gbuffer.hpp"
#include "passes/geometry/geometry_ref.hpp"

namespace myriad::passes {

// The share of a VPL's light that a receiver gets, 0 to 1, and how far floats may be from it.
struct Seen {
    double share = 0, slack = 0;
};
inline constexpr Seen seen_not{0, 0}, seen_whole{1, 0}, seen_unsure{0.5, 0.5};

// The kernel's result lies within `slack` of `irradiance`: what VPLs bring of which it is unsure whether they are seen, and what
// rounding of positions and cosines may move.
struct GatherRef {
    glm::dvec3 irradiance{0}, slack{0};
    glm::dvec3 mirrored{0}, mirrored_slack{0};
};

using SeenRef = std::function<Seen(size_t pixel, size_t vpl)>;
std::vector<GatherRef> gather_ref(const HostGBuffer& gbuffer, const std::vector<Vpl>& vpls, uint block, double bound,
                                  const SeenRef& seen = [](size_t, size_t) { return seen_whole; });

// The same of lights that are infinitely far (far_light).
std::vector<GatherRef> far_gather_ref(const HostGBuffer& gbuffer, const std::vector<Vpl>& lights, uint block,
                                      const SeenRef& seen = [](size_t, size_t) { return seen_whole; });

// The same of lights that shine alike in all directions (omni_light).
std::vector<GatherRef> omni_gather_ref(const HostGBuffer& gbuffer, const std::vector<Vpl>& lights, uint block,
                                       const SeenRef& seen = [](size_t, size_t) { return seen_whole; });

// What the map of a parallel view lets its light see of the receiver x.
Seen parallel_seen_ref(const glm::dvec3& x, const glm::dvec3& n_g, const View& view, const uint* map, uint size, double bias);

// What a VPL's map (map_texels(size) words) lets it see of the receiver x of geometric normal n_g.
Seen map_seen_ref(const glm::dvec3& x, const glm::dvec3& n_g, const glm::dvec3& vpl, const uint* map, uint size, double bias);

// The map of exact depths: each texel's ray against every triangle.
std::vector<uint> exact_map(const vec3& from, const scenes::Triangles& triangles, uint size);

// Whether nothing lies between the points, by every triangle. Unsure where an edge, or either end, is close.
Seen ray_seen_ref(const glm::dvec3& from, const glm::dvec3& to, const scenes::Triangles& triangles, const ThereRef& there = {});

}  // namespace myriad::passes
