// How far whole frames are apart.
#pragma once

#include <cmath>
#include <vector>

#include "engine/shared.h"

namespace myriad::tests {

// The root of the sum of squares that `a` is off, as a share of that of `b`, over the pixels' colours.
inline double difference(const std::vector<vec4>& a, const std::vector<vec4>& b) {
    double sum = 0, whole = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        const glm::dvec3 d = glm::dvec3(a[i]) - glm::dvec3(b[i]), r(b[i]);
        sum += glm::dot(d, d), whole += glm::dot(r, r);
    }
    return std::sqrt(sum / whole);
}

}  // namespace myriad::tests
