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

// Whether the triangle meets the cell made larger by `reach` of its sides in each direction, in double, by clipping the triangle against its planes one after the
// other: nothing in common with separating axes. A negative reach asks whether it surely meets the cell.
// What is left of the triangle, in leaf cells from the cell's corner; nothing where they do not meet.
std::vector<glm::dvec3> clipped_to_cell(const Corners& triangle, const OctreeCube& cube, uvec3 cell, double reach);
bool meets_cell(const Corners& triangle, const OctreeCube& cube, uvec3 cell, double reach);

}  // namespace myriad::compute
