#include "compute/surface_sampling/surface_sampling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "compute/opacity/opacity_testing.hpp"

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

// A chequered square, a whole one, one that is nowhere, and a tree of small cards.
TEST(SurfaceSamplingTest, samples_stand_where_the_surface_is) {
    std::mt19937 random(2);
    OpacityScene s;
    s.texels = {0xff000000, 0, 0, 0xff000000};
    const TextureRef checks{0, 2, 2, 0, {8, 0}, {0, 8}, {0, 0}};
    s.square(0, s.material({checks, 1, 0.5f}));
    s.square(1, s.material(Opacity::opaque()));
    s.square(2, s.material({.alpha = 0.2f, .cutoff = 0.5f}));
    const TextureRef disc = s.texture(16, 16, random, wrap_clamp | wrap_clamp << 2, 0);
    for (uint i = 0; i < 256; ++i)
        if (const float x = float(i % 16) - 7.5f, y = float(i / 16) - 7.5f; x * x + y * y < 36) s.texels[disc.first + i] |= 0xff000000;
    const uint leaf = s.material({disc, 1, 0.5f});
    for (int i = 0; i < 4000; ++i) {  // 16 m^2 of cards
        const vec3 at(0.1f * float(i % 60), 5 + 0.1f * float(i / 60), 0);
        s.triangle({at, at + vec3(0.0632f, 0, 0), at + vec3(0.0632f, 0.0632f, 0)}, {{0, 1}, {1, 1}, {1, 0}}, leaf);
        s.triangle({at, at + vec3(0.0632f, 0.0632f, 0), at + vec3(0, 0.0632f, 0)}, {{0, 1}, {1, 0}, {0, 0}}, leaf);
    }
    const double in_disc = std::numbers::pi * 36 / 256, expected = 2 + 4 + 16 * in_disc;
    for (uint32_t d : {8u, 12u, 15u}) {
        const SurfaceSampling sampling = sample_surface(s.world(), d, 1);
        ASSERT_EQ(sampling.samples.size(), size_t(1) << d);
        EXPECT_NEAR(sampling.area, expected, 0.03 * expected) << d;
        EXPECT_NEAR(sampling.radius, surface_sample_cover * std::sqrt(sampling.area / std::ldexp(std::numbers::pi, int(d))), 1e-6);
        std::array<double, 4> share{};
        for (const SurfaceSample& sample : sampling.samples) {
            ASSERT_TRUE(s.world().is_there(sample.triangle, sample.u, sample.v));
            share[std::min(sample.triangle / 2, 3u)] += 1 / std::ldexp(1.0, int(d));
        }
        const double tolerance = 0.01 + 2 / std::ldexp(1.0, int(d));
        EXPECT_NEAR(share[0], 2 / expected, tolerance) << d;
        EXPECT_NEAR(share[1], 4 / expected, tolerance) << d;
        EXPECT_EQ(share[2], 0) << d;
        EXPECT_NEAR(share[3], 16 * in_disc / expected, tolerance) << d;
    }
    for (OpacityMaterial& m : s.materials) m = {.alpha = 0.1f, .cutoff = 0.5f};  // nothing is anywhere
    EXPECT_EQ(sample_surface(s.world(), 5, 1).radius, 0);
    EXPECT_EQ(sample_surface(s.world(), 5, 1).samples.size(), 32u);
}

TEST(SurfaceSamplingTest, what_is_everywhere_is_sampled_as_if_nobody_asked) {
    std::mt19937 random(2);
    OpacityScene s = OpacityScene::soup(300, 0.3f, random);
    s.colors.clear();
    const TextureRef full = s.texture(3, 3, random, 0, 255);
    for (OpacityMaterial& m : s.materials) m = {full, 1, opacity_blended};
    const SurfaceSampling asked = sample_surface(s.world(), 12, 1), plain = sample_surface({s.positions, s.triangles}, 12, 1);
    EXPECT_EQ(asked.area, plain.area);
    for (size_t i = 0; i < plain.samples.size(); ++i) {
        ASSERT_EQ(asked.samples[i].triangle, plain.samples[i].triangle);
        ASSERT_EQ(asked.samples[i].u, plain.samples[i].u);
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
