// Views for tests. Tests only; the product never includes it.
#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "compute/views/view_io.h"

namespace myriad::compute {

// Exact where phi is pi / 2 or pi.
inline View view(const vec3& position, const vec3& direction, float phi) {
    constexpr float pi = std::numbers::pi_v<float>;
    return {position, phi == pi / 2 ? 0 : std::cos(phi), glm::normalize(direction), phi == pi ? 0 : std::sin(phi)};
}

// In a cube of +-`scale`, in all directions, of these half-angles.
inline std::vector<View> random_views(std::mt19937& random, size_t n, float scale, const std::vector<float>& phis) {
    const auto uniform = [&] { return std::uniform_real_distribution<float>(-1, 1)(random); };
    const auto point = [&](float size) { return size * vec3(uniform(), uniform(), uniform()); };
    std::vector<View> views;
    for (size_t i = 0; i < n; ++i) views.push_back(view(point(scale), point(1), phis[random() % phis.size()]));
    return views;
}

}  // namespace myriad::compute
