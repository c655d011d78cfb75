// The plain CPU twins of the traversal: every triangle is tested, there is no tree.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "compute/instances/world.hpp"
#include "compute/raytrace/bvh_build.hpp"

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

// The tree of a scene without instances after its triangles have moved to `positions`, as Bvh::refit leaves it: all nodes anew, from the root down.
BvhData refit_ref(BvhData tree, const WorldTriangles& world, std::span<const glm::vec3> positions);

// The first violated invariant of a tree, or nothing: each of its triangles in one leaf, strictly within the box of each ancestor, each node
// in one place, no more levels than it says. Meshes that instances share are looked at in their own space.
std::string bvh_check(const BvhData& tree);

}  // namespace myriad::compute
