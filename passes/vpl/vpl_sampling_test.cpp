#include "passes/vpl/vpl_sampling.h"

#include <array>
#include <bit>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "passes/geometry/test_scene.hpp"

namespace myriad::passes {
namespace {

using glm::dvec3;
constexpr double pi_d = std::numbers::pi;

TEST(VplSampling, sobol_dimensions_are_sobols) {
    // Joe and Kuo's table (new-joe-kuo-6): degree, inner coefficients of the polynomial, first direction numbers.
    struct Row {
        uint degree, a;
        std::vector<uint> m;
    };
    const Row rows[4] = {{1, 0, {1}}, {2, 1, {1, 3}}, {3, 1, {1, 3, 1}}, {3, 2, {1, 1, 1}}};
    std::mt19937 random(2);
    for (uint d = 1; d <= 4; ++d) {
        const Row& row = rows[d - 1];
        std::vector<uint> v;
        for (uint k = 0; k < 32; ++k) {
            if (k < row.degree) {
                v.push_back(row.m[k] << (31 - k));
                continue;
            }
            v.push_back(v[k - row.degree] ^ (v[k - row.degree] >> row.degree));
            for (uint i = 1; i < row.degree; ++i)
                if (row.a >> (row.degree - 1 - i) & 1) v[k] ^= v[k - i];
        }
        for (uint n = 0; n < 1000; ++n) {
            const uint index = n < 64 ? n : uint(random());
            uint expected = 0;
            for (uint k = 0; k < 32; ++k)
                if (index >> k & 1) expected ^= v[k];
            ASSERT_EQ(sobol(index, d), expected) << d << " " << index;
        }
    }
}

// Whether the points are one to each elementary interval of `bits` bits, split between the two coordinates in every way
// down to `slack` bits.
bool is_net(const std::vector<std::array<float, 2>>& points, int bits, int slack) {
    for (int first = 0; first <= bits - slack; ++first) {
        const int second = bits - slack - first;
        std::map<std::pair<int, int>, int> cells;
        for (const auto& p : points) ++cells[{int(p[0] * float(1 << first)), int(p[1] * float(1 << second))}];
        if (cells.size() != size_t(1) << (bits - slack)) return false;
        for (const auto& cell : cells)
            if (cell.second != 1 << slack) return false;
    }
    return true;
}

TEST(VplSampling, ranges_and_interleaved_sets_of_paths_are_nets) {
    const uint paths = 4096, bits = 12;
    for (const auto& [first, step] : {std::pair{0u, 1u}, {5u, 16u}, {0u, 2u}, {63u, 64u}, {2048u, 1u}, {256u, 1u}}) {
        const uint count = first >= step && step == 1 ? (first == 2048 ? 2048u : 256u) : paths / step;
        std::vector<std::array<float, 2>> place, direction, bounce, selection;
        for (uint k = 0; k < count; ++k) {
            const uint path = first + k * step, index = path_index(path, bits);
            const vec4 x = path_emission_point(index, 9);
            const vec2 y = path_bounce_point(index, 3, 9);
            place.push_back({x.x, x.y});
            direction.push_back({x.z, x.w});
            bounce.push_back({y.x, y.y});
            selection.push_back({path_selection(path, paths, 9), x.z});
        }
        const int n = std::countr_zero(count);
        EXPECT_TRUE(is_net(place, n, 2)) << first << " " << step;
        EXPECT_TRUE(is_net(direction, n, 4)) << first << " " << step;
        if (step > 1 || first == 0) {
            EXPECT_TRUE(is_net(bounce, n, 0)) << first << " " << step;
            EXPECT_TRUE(is_net(selection, n, 3)) << first << " " << step;
        }
    }
}

TEST(VplSampling, comparator_sees_random_points) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<std::array<float, 2>> points(256);
    for (auto& p : points) p = {unit(random), unit(random)};
    EXPECT_FALSE(is_net(points, 8, 4));
}

TEST(VplSampling, selection_visits_each_stratum_once) {
    for (uint paths : {1u, 2u, 63u, 1000u, 1u << 24})
        for (uint path : {0u, paths / 2, paths - 1}) {
            const float x = path_selection(path, paths, 5);
            EXPECT_GE(double(x), double(path) / paths - 1e-7);
            EXPECT_LE(double(x), (path + 1.0) / paths + 1e-7);
            EXPECT_LT(x, 1.0f);
        }
}

TEST(VplSampling, own_functions_are_accurate) {
    for (int i = 0; i <= 100000; ++i) {
        const float x = float(i) / 100000;
        const vec2 cs = cos_sin_turns(x);
        ASSERT_NEAR(cs.x, std::cos(2 * pi_d * double(x)), 5e-7) << x;
        ASSERT_NEAR(cs.y, std::sin(2 * pi_d * double(x)), 5e-7) << x;
        if (i > 0) { ASSERT_NEAR(cube_root(x), std::cbrt(double(x)), 1e-6 * std::cbrt(double(x))) << x; }
    }
    EXPECT_LT(cube_root(0), 1e-10f);
    EXPECT_GE(cube_root(0), 0.0f);
}

TEST(VplSampling, directions_have_the_density_they_claim) {
    const uint n = 1 << 14;
    for (const vec3& axis : {vec3(0, 0, 1), vec3(0, 0, -1), vec3(1, 0, 0), glm::normalize(vec3(1, -2, 0.5f)), glm::normalize(vec3(1e-4f, 0, -1))}) {
        dvec3 sum(0);
        double squares = 0;
        for (uint i = 0; i < n; ++i) {
            const vec2 x(to_unit(sobol(i, 0)), to_unit(sobol(i, 1)));
            const vec3 d = cosine_direction(x, axis);
            ASSERT_NEAR(glm::length(d), 1, 1e-6);
            ASSERT_GE(glm::dot(d, axis), -1e-6f);
            sum += dvec3(d) / double(n);
            squares += double(glm::dot(d, axis)) * glm::dot(d, axis) / n;
        }
        EXPECT_LT(glm::length(sum - 2.0 / 3.0 * dvec3(axis)), 1e-3);  // E cos = 2/3, E cos^2 = 1/2
        EXPECT_NEAR(squares, 0.5, 1e-3);
    }
}

TEST(VplSampling, point_lights_go_everywhere_alike) {
    const Light light{.position = {1, 2, 3}, .type = light_point, .direction = {0, 0, -1}, .cdf = 1, .intensity = {1, 2, 3}};
    dvec3 sum(0), squares(0);
    const uint n = 1 << 14;
    for (uint i = 0; i < n; ++i) {
        const Emission e = emit_punctual(light, vec2(path_emission_point(i, 4)));
        EXPECT_EQ(e.origin, light.position);
        EXPECT_EQ(e.flux, 4 * pi * light.intensity);
        sum += dvec3(e.direction) / double(n);
        squares += dvec3(e.direction) * dvec3(e.direction) / double(n);
    }
    EXPECT_LT(glm::length(sum), 1e-3);
    EXPECT_LT(glm::length(squares - 1.0 / 3), 1e-3);
}

TEST(VplSampling, spots_follow_their_falloff) {
    for (const auto& [inner, outer] : {std::pair{0.0, 0.785398}, {0.3, 0.6}, {0.5, 0.5}, {0.0, 0.02}, {0.1, 1.57}}) {
        TestScene test;
        test.material(vec3(1));
        test.light(scenes::Light::Type::spot, vec3(0), {1, 2, -3}, vec3(1), float(inner), float(outer));
        const Light light = light_data(test.scene, test.triangles, geometry_data(test.scene, test.triangles)).lights[0];
        // The solid angle, by Simpson's rule over the cosine from the axis to the rim.
        const int steps = 100000;
        const double rim = double(light.cos_outer);
        double integral = 0;
        std::vector<double> below(11);  // the share of the flux within each tenth of the way from the axis to the rim
        for (int i = 0; i < steps; ++i) {
            const double c = 1 - (1 - rim) * (i + 0.5) / steps;
            const double t = std::clamp((c - rim) / std::max(0.001, std::cos(inner) - std::cos(outer)), 0.0, 1.0);
            integral += 2 * pi_d * t * t * (1 - rim) / steps;
            if ((i + 1) % (steps / 10) == 0) below[(i + 1) / (steps / 10)] = integral;
        }
        EXPECT_NEAR(spot_solid_angle(light), integral, 1e-3 * integral) << inner << " " << outer;
        const uint n = 1 << 13;
        std::vector<double> counts(11);
        for (uint i = 0; i < n; ++i) {
            const Emission e = emit_punctual(light, vec2(path_emission_point(i, 4)));
            ASSERT_NEAR(glm::length(e.direction), 1, 1e-5);
            const double from_axis = (1 - double(glm::dot(e.direction, light.direction))) / (1 - rim);
            ASSERT_LE(from_axis, 1 + 2e-6 / (1 - rim));
            for (int k = 1; k <= 10; ++k) counts[k] += from_axis <= 0.1 * k || k == 10;
            ASSERT_NEAR(e.flux.x, integral, 1e-3 * integral);
        }
        for (int k = 1; k <= 10; ++k) EXPECT_NEAR(counts[k] / n, below[k] / integral, 0.01) << inner << " " << outer << " " << k;
    }
}

TEST(VplSampling, triangle_points_are_inside_and_even) {
    const uint n = 1 << 14;
    vec2 sum(0);
    for (uint i = 0; i < n; ++i) {
        const vec2 p = triangle_point({to_unit(sobol(i, 0)), to_unit(sobol(i, 1))});
        ASSERT_GE(std::min(p.x, p.y), 0.0f);
        ASSERT_LE(p.x + p.y, 1.0f);
        sum += p / float(n);
    }
    EXPECT_NEAR(sum.x, 1.0 / 3, 1e-3);
    EXPECT_NEAR(sum.y, 1.0 / 3, 1e-3);
}

}  // namespace
}  // namespace myriad::passes
