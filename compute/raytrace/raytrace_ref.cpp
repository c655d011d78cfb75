#include "compute/raytrace/raytrace_ref.hpp"

#include <algorithm>
#include <limits>

#include "compute/raytrace/intersect.h"

namespace myriad::compute {

RayHitRecord closest_ref(std::span<const BvhTriangle> triangles, const Ray& r, const WorldTriangles& world) {
    const TraceRay ray = trace_ray(r.origin, r.direction, r.t_min, r.t_max);
    RayHitRecord best{.t = r.t_max, .triangle = ~0u, .u = 0, .v = 0, .front = 0};
    for (const BvhTriangle& triangle : triangles) {
        float t = 0;
        vec3 weights{0};
        if (!triangle_hit(ray, triangle.p0, triangle.p1, triangle.p2, t, weights)) continue;
        const uint id = triangle.id & ~bvh_asks;
        if (!world.is_there(id, weights.x, weights.y)) continue;
        if (t < best.t || (t == best.t && best.triangle != ~0u && id < best.triangle))
            best = {t, id, weights.x, weights.y, weights.z > 0 ? 1u : 0u};
    }
    return best;
}

bool occluded_ref(std::span<const BvhTriangle> triangles, const Ray& ray, const WorldTriangles& world) {
    return closest_ref(triangles, ray, world).triangle != ~0u;
}

ExactHit closest_exact(std::span<const glm::vec3> positions, std::span<const glm::uvec4> triangles, const Ray& ray) {
    using glm::dvec3;
    ExactHit best{std::numeric_limits<double>::infinity(), ~0u, 0, 0, 0};
    double nearly = -std::numeric_limits<double>::infinity();  // the largest margin of all misses
    const dvec3 o(ray.origin), d(ray.direction);
    for (uint i = 0; i < triangles.size(); ++i) {
        const dvec3 p0(positions[triangles[i].x]), e1 = dvec3(positions[triangles[i].y]) - p0, e2 = dvec3(positions[triangles[i].z]) - p0;
        const dvec3 p = cross(d, e2);
        const double det = dot(e1, p);
        if (det == 0) continue;
        const dvec3 s = o - p0, q = cross(s, e1);
        const double u = dot(s, p) / det, v = dot(d, q) / det, t = dot(e2, q) / det;
        const double margin = std::min({u, v, 1 - u - v});
        if (t <= ray.t_min || t >= std::min(best.t, double(ray.t_max))) continue;
        if (margin >= 0) best = {t, i, u, v, margin};
        else nearly = std::max(nearly, margin);
    }
    if (best.triangle == ~0u) best.margin = nearly;
    return best;
}

namespace {

// Around what is in or below a node; refits it.
BvhBox refit_node(BvhData& tree, uint index) {
    BvhNode& node = tree.nodes[index];
    BvhChildren children{};
    const uint count = bvh_children(node.frame);
    for (uint i = 0; i < count; ++i) {
        const uint triangles = node.child[i].x >> 24, first = node.first_triangle + (node.child[i].y >> 24);
        BvhBox& box = children.box[i];
        if (triangles == 0) {
            box = refit_node(tree, node.first_child + i);
            continue;
        }
        box = {vec3(INFINITY), vec3(-INFINITY)};
        for (uint k = first; k < first + triangles; ++k) {
            box = bvh_united(box, bvh_box(tree.triangles[k]));
        }
    }
    BvhBox all{vec3(INFINITY), vec3(-INFINITY)};
    for (uint i = 0; i < count; ++i) all = bvh_united(all, children.box[i]);
    if (count > 0) node = bvh_pack(node, children, count);
    return all;
}

struct Check {
    const BvhData& tree;
    std::vector<uint> seen, visited;  // how often, by triangle of the tree and by node
    std::string fault;

    bool fail(uint node, const std::string& what) {
        if (fault.empty()) fault = "node " + std::to_string(node) + ": " + what;
        return false;
    }
    bool visit(uint index, uint level, std::vector<BvhBox> around) {
        if (index >= tree.nodes.size()) return fail(index, "outside the tree");
        if (level > tree.depth) return fail(index, "deeper than the tree says");
        const BvhNode& node = tree.nodes[index];
        ++visited[index];
        if (bvh_children(node.frame) == bvh_is_instance) {
            const bool in_world = (tree.instances[node.first_triangle].flags & instance_in_world) != 0;
            if (!in_world && visited[node.first_child] > 0) return true;
            return visit(node.first_child, level, in_world ? around : std::vector<BvhBox>{});
        }
        for (uint i = 0; i < bvh_children(node.frame); ++i) {
            const vec3 scale = bvh_scale(node.frame);
            std::vector<BvhBox> boxes = around;
            boxes.push_back({bvh_corner(node.origin, scale, node.child[i].x), bvh_corner(node.origin, scale, node.child[i].y)});
            const uint count = node.child[i].x >> 24, first = node.first_triangle + (node.child[i].y >> 24);
            if (count == 0 && !visit(node.first_child + i, level + 1, boxes)) return false;
            for (uint k = first; k < first + count; ++k) {
                const BvhTriangle& t = tree.triangles[k];
                ++seen[k];
                for (const vec3& p : {t.p0, t.p1, t.p2})
                    for (const BvhBox& box : boxes)
                        for (int a = 0; a < 3; ++a)
                            if (!(box.lo[a] < p[a] && p[a] < box.hi[a])) return fail(index, "child " + std::to_string(i) + " holds what is outside a box above it");
            }
        }
        return true;
    }
};

}  // namespace

BvhData refit_ref(BvhData tree, const WorldTriangles& world, std::span<const glm::vec3> positions) {
    for (BvhTriangle& t : tree.triangles) {
        const glm::uvec4 corners = world.triangles[t.id & ~bvh_asks];
        t.p0 = positions[corners.x], t.p1 = positions[corners.y], t.p2 = positions[corners.z];
    }
    refit_node(tree, 0);
    return tree;
}

std::string bvh_check(const BvhData& tree) {
    Check check{tree, std::vector<uint>(tree.triangles.size()), std::vector<uint>(tree.nodes.size()), {}};
    check.visit(0, 1, {});
    if (!check.fault.empty()) return check.fault;
    for (uint k = 0; k < check.seen.size(); ++k)
        if (check.seen[k] != 1) return "triangle " + std::to_string(k) + " of the tree is in " + std::to_string(check.seen[k]) + " leaves";
    for (uint i = 0; i < check.visited.size(); ++i)
        if (check.visited[i] != 1) return "node " + std::to_string(i) + " is reached " + std::to_string(check.visited[i]) + " times";
    return {};
}

}  // namespace myriad::compute
