// The topology of the hierarchy: in which order samples become leaves (ManyLoDs 4.1).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace myriad::compute {

// The leaf order of a complete binary tree over 2^d points: order[i] is the point in leaf i. Each node is split at the
// median of the axis that gives the least summed volume of its halves. `threads` 0: one per core; the result is the same.
std::vector<uint32_t> bsh_order(std::span<const glm::vec3> points, uint32_t threads = 0);

}  // namespace myriad::compute
