// Rays against the scene's triangles, by Embree.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "tools/reference/surface.hpp"

namespace myriad::reference {

struct Hit {
    uint32_t triangle;
    float u, v;  // the point is (1 - u - v) p0 + u p1 + v p2
};

// A surface that is there in part is met with the probability of its opacity, decided by the ray's dice and the triangle: the same ray has
// the same answer, whatever the order in which triangles are asked.
class Tracer {
public:
    // Throws OutOfMemory. The tree is built by one thread: so it is the same tree each time, on any number of them.
    Tracer(const scenes::Triangles& triangles, const Surfaces& surfaces);
    ~Tracer();
    Tracer(const Tracer&) = delete;

    std::optional<Hit> closest(const vec3& origin, const vec3& direction, uint32_t dice) const;
    // Whether there is anything between origin and origin + part * way.
    bool occluded(const vec3& origin, const vec3& way, float part, uint32_t dice) const;

private:
    struct Embree;
    std::unique_ptr<Embree> embree_;
};

}  // namespace myriad::reference
