#include "compute/voxels/voxels_ref.hpp"

#include <functional>

namespace myriad::compute {

std::vector<Voxel> voxels_ref(const std::vector<Corners>& triangles, const OctreeCube& cube, uint depth) {
    std::vector<Voxel> voxels;
    for (uint i = 0; i < triangles.size(); ++i) {
        const VoxelTriangle t = voxel_triangle(triangles[i], cube, depth);
        const std::function<void(uint64_t, uint)> visit = [&](uint64_t key, uint level) {
            if (level == depth) return voxels.push_back({key, i});
            for (uint found = voxel_children(t, {uint(key), uint(key >> 32)}, level, depth), octant = 0; octant < 8; ++octant)
                if (found >> octant & 1) visit(key << 3 | octant, level + 1);
        };
        visit(0, 0);
    }
    return voxels;
}

std::vector<glm::dvec3> clipped_to_cell(const Corners& triangle, const OctreeCube& cube, uvec3 cell, double reach) {
    std::vector<glm::dvec3> polygon;
    for (const vec3& p : {triangle.p0, triangle.p1, triangle.p2})
        polygon.push_back((glm::dvec3(p) - glm::dvec3(cube.origin)) * double(cube.cells_per_length) - glm::dvec3(cell));
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {1.0, -1.0}) {
            const auto inside = [&](const glm::dvec3& p) { return sign > 0 ? p[axis] + reach : 1 + reach - p[axis]; };  // >= 0
            std::vector<glm::dvec3> rest;
            for (size_t i = 0; i < polygon.size(); ++i) {
                const glm::dvec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
                const double at_p = inside(p), at_q = inside(q);
                if (at_p >= 0) rest.push_back(p);
                if ((at_p < 0) != (at_q < 0)) rest.push_back(p + (q - p) * (at_p / (at_p - at_q)));
            }
            polygon = std::move(rest);
        }
    return polygon;
}
bool meets_cell(const Corners& triangle, const OctreeCube& cube, uvec3 cell, double reach) { return !clipped_to_cell(triangle, cube, cell, reach).empty(); }

}  // namespace myriad::compute
