// The plain CPU twins of the traversal: every triangle is tested, there is no tree.
#pragma once

#include <span>
#include <vector>

#include "compute/instances/world.hpp"
#include "compute/raytrace/raytrace_io.h"

namespace myriad::compute {

// With the device's own triangle test in floats: the tree and its traversal must agree with it to the bit.
// `world`: what says where triangles are, if they are not everywhere.
RayHitRecord closest_ref(std::span<const BvhTriangle> triangles, const Ray& ray, const WorldTriangles& world = {});
bool occluded_ref(std::span<const BvhTriangle> triangles, const Ray& ray, const WorldTriangles& world = {});

// In doubles, by another method (Moeller and Trumbore 1997): what the floats are to be near to. `margin` is the least
// distance of the hit from the triangle's edges, as a weight; a miss has t = infinity, and the margin by which the nearest
// triangle was missed.
struct ExactHit {
    double t;
    uint triangle;
    double u, v, margin;
};
ExactHit closest_exact(std::span<const glm::vec3> positions, std::span<const glm::uvec4> triangles, const Ray& ray);

}  // namespace myriad::compute
