// The plain CPU twin: every node that is drawn, tested against every texel of its view's map.
#pragma once

#include <span>
#include <vector>

#include "compute/bsh/bsh_ref.hpp"
#include "passes/splat/splat_io.h"

namespace myriad::passes {

// The atlas of views [first_view, first_view + maps). All groups belong to these.
std::vector<uint> splat_ref(const compute::BshArrays& tree, std::span<const uvec2> groups, std::span<const View> views, uint first_view, uint maps,
                            uint map_size, uint coverage = coverage_exact);

}  // namespace myriad::passes
