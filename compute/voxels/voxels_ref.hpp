// The plain CPU twin of the voxelisation, and an independent test of overlap.
#pragma once

#include <vector>

#include "compute/voxels/voxels_io.h"

namespace myriad::compute {

// A leaf cell and a triangle.
struct Voxel {
    uint64_t key;
    uint triangle;
    auto operator<=>(const Voxel&) const = default;
};

// By recursion, triangle after triangle, in Morton order.
std::vector<Voxel> voxels_ref(const std::vector<Corners>& triangles, const OctreeCube& cube, uint depth);

// What the cell, made larger by `reach` of its sides in each direction, has of the triangle, in sides from the cell's corner, in double: clipped against its planes
// one after the other, which has nothing in common with separating axes. Nothing where they do not meet.
std::vector<glm::dvec3> clipped_to_cell(const Corners& triangle, const OctreeCube& cube, uvec3 cell, double reach);
// A negative reach asks whether it surely meets the cell.
bool meets_cell(const Corners& triangle, const OctreeCube& cube, uvec3 cell, double reach);

}  // namespace myriad::compute
