// The plain CPU twin: every triangle, tested against every texel of every view's map.
#pragma once

#include <span>
#include <vector>

#include "compute/instances/world.hpp"
#include "passes/brute/brute_io.h"

namespace myriad::passes {

// The atlas of views [first, first + maps).
std::vector<uint> brute_ref(const compute::WorldTriangles& world, std::span<const View> views, uint first, uint maps, uint map_size);

}  // namespace myriad::passes
