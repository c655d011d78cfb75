#include "compute/surface_sampling/surface_sampling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace myriad::compute {
namespace {

using glm::dvec3, glm::uvec4, glm::vec3;

struct Mesh {
    std::vector<vec3> positions;
    std::vector<uvec4> triangles;

    void add(vec3 a, vec3 b, vec3 c) {
        const uint first = uint(positions.size());
        positions.insert(positions.end(), {a, b, c});
        triangles.push_back({first, first + 1, first + 2, 0});
    }
    dvec3 at(uint32_t triangle, double u, double v) const {
        const uvec4 t = triangles[triangle];
        return (1 - u - v) * dvec3(positions[t.x]) + u * dvec3(positions[t.y]) + v * dvec3(positions[t.z]);
    }
    double area(uint32_t t) const {
        return 0.5 * glm::length(glm::cross(at(t, 1, 0) - at(t, 0, 0), at(t, 0, 1) - at(t, 0, 0)));
    }
    SurfaceSampling sample(uint32_t log2_count, uint32_t seed = 1) const { return sample_surface({positions, triangles}, log2_count, seed); }
};

Mesh grid(int n) {
    Mesh mesh;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            mesh.add(vec3(i, j, 0), vec3(i + 1, j, 0), vec3(i, j + 1, 0));
            mesh.add(vec3(i + 1, j + 1, 0), vec3(i, j + 1, 0), vec3(i + 1, j, 0));
        }
    return mesh;
}

// How much of the surface lies in discs of the samples' radius times `scale`, by random points and brute force.
double covered(const Mesh& mesh, const SurfaceSampling& sampling, double scale = 1) {
    std::vector<double> cumulative;
    double sum = 0;
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) cumulative.push_back(sum += mesh.area(t));
    std::vector<dvec3> samples;
    for (const SurfaceSample& s : sampling.samples) samples.push_back(mesh.at(s.triangle, s.u, s.v));
    const double reach = double(sampling.radius) * sampling.radius * scale * scale;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    int inside = 0;
    const int points = 20000;
    for (int i = 0; i < points; ++i) {
        const auto t = uint32_t(std::lower_bound(cumulative.begin(), cumulative.end(), unit(random) * sum) - cumulative.begin());
        const double r = std::sqrt(unit(random)), s = unit(random);
        const dvec3 p = mesh.at(t, r * s, r * (1 - s));
        for (const dvec3& q : samples)
            if (glm::dot(p - q, p - q) <= reach) {
                ++inside;
                break;
            }
    }
    return double(inside) / points;
}

TEST(SurfaceSamplingTest, fat_triangles_get_the_floor_or_ceiling_of_their_due) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0.5f, 40);
    Mesh mesh;
    for (int i = 0; i < 500; ++i) {
        const float size = unit(random) * (i % 50 == 0 ? 20.0f : 1.0f);
        const vec3 at(unit(random), unit(random), unit(random));
        mesh.add(at, at + vec3(size, 0, 0), at + vec3(0.3f * size, 0.8f * size, 0.1f * size));
    }
    for (uint32_t d : {0, 1, 5, 10, 14}) {
        const SurfaceSampling sampling = mesh.sample(d);
        ASSERT_EQ(sampling.samples.size(), size_t(1) << d);
        std::vector<int> count(mesh.triangles.size());
        double area = 0;
        for (const SurfaceSample& s : sampling.samples) {
            ++count[s.triangle];
            EXPECT_TRUE(s.u >= 0 && s.v >= 0 && s.u + s.v <= 1.000001f);
        }
        for (uint32_t t = 0; t < count.size(); ++t) area += mesh.area(t);
        EXPECT_NEAR(sampling.area, area, 1e-9 * area);
        for (uint32_t t = 0; t < count.size(); ++t) EXPECT_LT(std::abs(count[t] - std::ldexp(mesh.area(t) / area, int(d))), 1 + 1e-9) << t;
    }
}

TEST(SurfaceSamplingTest, discs_cover_the_surface) {
    Mesh triangle;
    triangle.add({0, 0, 0}, {1, 0, 0}, {0.2f, 0.7f, 0.1f});
    EXPECT_GE(covered(triangle, triangle.sample(11)), 0.999);
    for (int n : {1, 10, 32, 45, 100}) EXPECT_GE(covered(grid(n), grid(n).sample(11)), 0.998) << n;
    Mesh fan;  // needles of 1:100 with about a sample each: not a row of samples across their middles
    for (int i = 0; i < 1000; ++i) fan.add(vec3(0.1f * float(i), 0, 0), vec3(0.1f * float(i + 1), 0, 0), vec3(0.1f * float(i), 10, 0));
    for (int i = 0; i < 1000; ++i) fan.add(vec3(0.1f * float(i + 1), 0, 0), vec3(0.1f * float(i + 1), 10, 0), vec3(0.1f * float(i), 10, 0));
    EXPECT_GE(covered(fan, fan.sample(11)), 0.99);
    EXPECT_LT(covered(fan, fan.sample(11), 0.5), 0.9) << "the measure sees holes";
}

TEST(SurfaceSamplingTest, small_triangles_are_not_all_hit_at_one_place) {
    const SurfaceSampling sampling = grid(200).sample(10);
    double mean = 0, square = 0;
    for (const SurfaceSample& s : sampling.samples) mean += s.u / 1024, square += s.u * s.u / 1024;
    EXPECT_NEAR(mean, 1.0 / 3, 0.03);
    EXPECT_GT(square - mean * mean, 0.04);  // uniform: 1/18
}

TEST(SurfaceSamplingTest, deterministic_and_seeded) {
    auto equal = [](const SurfaceSampling& a, const SurfaceSampling& b) {
        return std::equal(a.samples.begin(), a.samples.end(), b.samples.begin(),
                          [](auto& x, auto& y) { return x.triangle == y.triangle && x.u == y.u && x.v == y.v; });
    };
    EXPECT_TRUE(equal(grid(40).sample(10, 3), grid(40).sample(10, 3)));
    EXPECT_FALSE(equal(grid(40).sample(10, 3), grid(40).sample(10, 4)));
}

// More triangles than a thread takes at a time: fat ones, thin ones that are cut, and copies, which tie on the curve.
TEST(SurfaceSamplingTest, the_same_whatever_the_threads) {
    Mesh mesh = grid(100);
    for (int i = 0; i < 20000; ++i) mesh.add(vec3(i % 50, 3, 1), vec3(i % 50, 90, 1), vec3(i % 50 + 0.1f, 90, 1));
    const SurfaceSampling one = sample_surface({mesh.positions, mesh.triangles}, 14, 1, 1);
    for (const uint32_t threads : {2, 3, 8}) {
        const SurfaceSampling some = sample_surface({mesh.positions, mesh.triangles}, 14, 1, threads);
        EXPECT_EQ(one.area, some.area);
        EXPECT_TRUE(std::ranges::equal(one.samples, some.samples, [](auto& x, auto& y) { return x.triangle == y.triangle && x.u == y.u && x.v == y.v; }));
    }
}

TEST(SurfaceSamplingTest, scenes_without_triangles_or_area) {
    EXPECT_TRUE(Mesh{}.sample(10).empty());
    Mesh points;
    points.add(vec3(1), vec3(1), vec3(1));
    points.add(vec3(0), vec3(1), vec3(2));
    const SurfaceSampling flat = points.sample(3);
    EXPECT_EQ(flat.samples.size(), 8u);
    EXPECT_EQ(flat.radius, 0);
    EXPECT_EQ(flat.area, 0);
    for (const SurfaceSample& s : flat.samples) EXPECT_TRUE(s.triangle < 2 && s.u + s.v <= 1);

    Mesh nowhere;
    nowhere.add(vec3(0), vec3(0), vec3(std::numeric_limits<float>::quiet_NaN()));
    EXPECT_TRUE(nowhere.sample(4).empty());

    // Degenerate and non-finite triangles among others get nothing.
    points.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    points.add({0, 0, 0}, {std::numeric_limits<float>::quiet_NaN(), 0, 0}, {0, 1, 0});
    points.add({0, 0, 0}, {std::numeric_limits<float>::infinity(), 0, 0}, {0, 1, 0});
    for (const SurfaceSample& s : points.sample(6).samples) EXPECT_EQ(s.triangle, 2u);
}

TEST(SurfaceSamplingTest, any_scale) {
    for (double scale : {1e-18, 1e-6, 1e6, 1e18}) {
        Mesh mesh = grid(10);
        for (vec3& p : mesh.positions) p *= float(scale);
        const SurfaceSampling sampling = mesh.sample(8);
        EXPECT_NEAR(sampling.radius / scale, surface_sample_cover * std::sqrt(100 / (256 * std::numbers::pi)), 1e-3) << scale;
    }
}

// A hair of a million triangles' length must not be cut into a million parts.
TEST(SurfaceSamplingTest, endless_needles_end) {
    Mesh mesh;
    for (int i = 0; i < 100; ++i) mesh.add({0, float(i), 0}, {1e9f, float(i), 0}, {1e9f, float(i) + 1e-6f, 0});
    mesh.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    EXPECT_EQ(mesh.sample(10).samples.size(), 1024u);
}

}  // namespace
}  // namespace myriad::compute
