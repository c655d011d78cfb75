// Normals of faces, and in place of those that are none. For scenes/ only.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace myriad::scenes {

// The unit vector of `v`, or `fallback` where there is none. In double: squares of float coordinates overflow at 1e19.
inline glm::vec3 unit_or(const glm::dvec3& v, const glm::vec3& fallback) {
    const double length = glm::length(v);
    return length > 0 && std::isfinite(length) ? glm::vec3(v / length) : fallback;
}

// Its length is twice the area.
inline glm::dvec3 face_normal(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const glm::dvec3 o(a);
    return glm::cross(glm::dvec3(b) - o, glm::dvec3(c) - o);
}

// A normal of zero is replaced by the area-weighted mean of the faces around the vertex, up where that is none; returns how many
// were. `each_face` calls its argument with three indices of vertices, for all faces.
template <class EachFace>
size_t repair_normals(std::span<glm::vec3> normals, std::span<const glm::vec3> positions, EachFace each_face) {
    if (std::ranges::find(normals, glm::vec3(0)) == normals.end()) return 0;
    std::vector<glm::dvec3> sums(normals.size());
    each_face([&](uint32_t a, uint32_t b, uint32_t c) {
        const glm::dvec3 n = face_normal(positions[a], positions[b], positions[c]);
        for (const uint32_t i : {a, b, c}) sums[i] += n;
    });
    size_t count = 0;
    for (size_t i = 0; i < sums.size(); ++i)
        if (normals[i] == glm::vec3(0)) normals[i] = unit_or(sums[i], glm::vec3(0, 1, 0)), ++count;
    return count;
}

}  // namespace myriad::scenes
