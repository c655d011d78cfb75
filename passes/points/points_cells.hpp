// What part of the surface each leaf stands for.
#pragma once

#include <span>
#include <vector>

#include "compute/instances/world.hpp"
#include "compute/surface_sampling/surface_sample.h"

namespace myriad::passes {

// By leaf, and one more: where its cells begin in `cells` (PointsScene says what a cell is); the last is their number.
struct PointsCells {
    std::vector<uint> first;
    std::vector<uvec4> cells;
};

// Cuts every triangle that can be seen across its longest edge until no part is larger than two samples' shares, and gives each part to the leaf
// whose sample is nearest to the part's middle. So each point of the surface stands with one leaf. `samples`: of a tree, in leaf order; not empty. `share`: area over their number, m^2. Deterministic.
PointsCells points_cells(const compute::WorldTriangles& world, std::span<const SurfaceSample> samples, float share);

// The same for the same samples in another order, as a tree that was built anew has them.
PointsCells points_reorder(const PointsCells& from, std::span<const SurfaceSample> before, std::span<const SurfaceSample> now);

}  // namespace myriad::passes
