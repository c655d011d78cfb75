// Polygons into triangles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace myriad::scenes::importing {

// Appends the triangles of one polygon, as numbers of its corners, three a triangle, turning as the polygon turns. It may
// be concave and need not be quite flat. What crosses itself is still cut into count - 2 triangles, some of them turned
// over; so is, as a fan, one of more than 10,000 corners that is not convex, for cutting ears takes quadratic time.
void triangulate(std::span<const glm::vec3> corners, std::vector<uint32_t>& out);

}  // namespace myriad::scenes::importing
