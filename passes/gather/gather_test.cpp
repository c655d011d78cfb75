// Sums, sets and bounds; visibility is in gather_maps_test.cpp and gather_rays_test.cpp.
#include <limits>
#include <numbers>

#include "passes/gather/gather_testing.hpp"

namespace myriad::passes {
namespace {

using engine::same;
using glm::dvec3;
constexpr float pi = std::numbers::pi_v<float>;

TEST_F(GatherTest, twin_and_kernel_know_one_vpl_over_a_plane) {
    HostGBuffer g(4, 1);
    const vec3 up(0, 1, 0);
    g.put(0, {0, 0, 0}, up);           // straight below at distance 2: G = 1 / 4
    g.put(1, {2, 0, 0}, up);           // at 45 degrees: cosines of 1 / sqrt 2, d^2 = 8, G = 1 / 16
    g.put(2, {0, 0, 2}, -up);          // turned away
    g.put(3, {0, 4, 0}, -up);          // behind the VPL
    const std::vector<Vpl> vpls{vpl({0, 2, 0}, -up, pi * vec3(1, 2, 4))};
    const std::vector<dvec3> by_hand{0.25 * dvec3(1, 2, 4), 0.0625 * dvec3(1, 2, 4), dvec3(0), dvec3(0)};
    const auto twin = gather_ref(g, vpls, 1, 1e30);
    const auto got = run(g, vpls, {});
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_LE(length(twin[i].irradiance - by_hand[i]), 1e-6) << i;
        EXPECT_LE(length(dvec3(got[i]) - by_hand[i]), 1e-6) << i;
    }
}

TEST_F(GatherTest, equals_the_twin_at_all_sizes_and_blocks) {
    const std::pair<uint32_t, uint32_t> sizes[] = {{1, 1}, {7, 5}, {64, 1}, {1, 65}, {33, 17}, {40, 24}};
    for (uint block : {1u, 2u, 3u, 4u, 8u})
        for (const auto& [width, height] : sizes) {
            SCOPED_TRACE(testing::Message() << width << "x" << height << ", block " << block);
            const HostGBuffer g = random_gbuffer(width, height);
            const auto vpls = random_vpls(100);
            const auto expected = gather_ref(g, vpls, block, 3);
            if (width * height > 100) {
                ASSERT_LT(doubt(expected), 1e-3);
            }
            ASSERT_TRUE(near(expected, run(g, vpls, {.block = block, .bound = 3})));
        }
}

TEST_F(GatherTest, glossy_receivers_equal_the_twin) {
    for (uint block : {1u, 2u, 4u})
        for (float bound : {0.3f, 3.0f, 1e3f, 1e30f}) {
            SCOPED_TRACE(testing::Message() << "block " << block << ", bound " << bound);
            HostGBuffer g = random_gbuffer(33, 17);
            polish(g);
            const auto vpls = random_vpls(100);
            const auto got = run(g, vpls, {.block = block, .bound = bound});
            ASSERT_EQ(got.size(), 2 * g.pixels());
            const auto expected = gather_ref(g, vpls, block, bound);
            ASSERT_TRUE(near(expected, got));
            double light = 0, slack = 0, diffuse = 0;
            for (const GatherRef& r : expected) light += r.mirrored.x, slack += r.mirrored_slack.x, diffuse += r.irradiance.x / std::numbers::pi;
            EXPECT_LT(slack, 5e-3 * light);
            EXPECT_GT(light, 0.05 * diffuse);
            // Split, and where some pixels are matte: the same bits.
            ASSERT_TRUE(same(got, run(g, vpls, {.block = block, .bound = bound, .parts = {block * block, 5 * block * block}})));
        }
}

// What makes VPLs sparkle: one near a mirror. A patch is reflected as brightly as it is, and no more, whatever the lobe.
TEST_F(GatherTest, no_patch_is_brighter_in_a_mirror_than_itself) {
    const float bound = 100, area = pi / bound;
    HostGBuffer g(64, 16);
    std::vector<Vpl> vpls{vpl({0, 0.5f, 0}, {0, -1, 0}, vec3(pi * area))};  // of radiance 1
    for (size_t i = 0; i < g.pixels(); ++i) {
        const vec3 x(std::pow(10.0f, -5 + 0.1f * float(i % 64)), 0, 0), to_vpl = normalize(vpls[0].position - x);
        g.put(i, x, {0, 1, 0});
        const vec3 mirror(-to_vpl.x, to_vpl.y, to_vpl.z);
        g.shine(i, vec3(1), std::max(float(i / 64) / 16, brdf_least_roughness), i % 3 ? mirror : normalize(vec3(-1, 0.02f, 0)));
    }
    const auto got = run(g, vpls, {.bound = bound});
    for (size_t i = 0; i < g.pixels(); ++i) ASSERT_LE(got[g.pixels() + i].x, 1.001f) << i;
    // Without the bound it would be a thousand times as bright as that.
    float most = 0;
    for (const vec4& v : run(g, vpls, {})) most = std::max(most, v.x);
    EXPECT_GT(most, 1000);
}

// A wall of VPLs of radiance 1 in the mirror of a floor: even, though each pixel's lobe is narrower than the VPLs' distance.
TEST_F(GatherTest, mirrors_show_surfaces_and_not_vpls) {
    const int n = 64;
    std::vector<Vpl> wall;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) wall.push_back(vpl({(float(x) + 0.5f) / n * 8 - 4, (float(y) + 0.5f) / n * 8, -2}, {0, 0, 1}, vec3(pi * 64 / (n * n))));
    HostGBuffer g(80, 1);
    const vec3 eye(0, 2, 3);
    for (size_t i = 0; i < g.pixels(); ++i) {
        const vec3 x(0.5f * uniform(), 0, 0.5f + uniform(0, 0.5f));
        g.put(i, x, {0, 1, 0});
        g.shine(i, vec3(1), brdf_least_roughness, normalize(eye - x));
    }
    const auto spread = [&](float bound) {
        double sum = 0, squares = 0;
        const auto got = run(g, wall, {.bound = bound});
        for (size_t i = 0; i < g.pixels(); ++i) sum += got[g.pixels() + i].x, squares += double(got[g.pixels() + i].x) * got[g.pixels() + i].x;
        const double mean = sum / double(g.pixels());
        std::printf("bound %g: mean %.3f, deviation %.3f\n", bound, mean, std::sqrt(std::max(squares / double(g.pixels()) / mean / mean - 1, 0.0)));
        return std::pair{mean, std::sqrt(std::max(squares / double(g.pixels()) / mean / mean - 1, 0.0))};
    };
    const auto [mean, deviation] = spread(pi * n * n / 64);
    EXPECT_NEAR(mean, 1, 0.06);
    EXPECT_LT(deviation, 0.05);
    EXPECT_GT(spread(1e30f).second, 1);
}

TEST_F(GatherTest, vpl_counts_at_boundaries) {
    const HostGBuffer g = random_gbuffer(19, 13);
    for (uint block : {1u, 2u, 4u, 8u})
        for (int about : {-1, 0, 1})
            for (uint beyond : {0u, 1u, 5000u}) {
                const auto vpls = random_vpls(block * block + about);
                SCOPED_TRACE(testing::Message() << vpls.size() << " VPLs, block " << block << ", limit " << beyond << " beyond");
                ASSERT_TRUE(near(gather_ref(g, vpls, block, 10), run(g, vpls, {.block = block, .bound = 10, .beyond = beyond})));
            }
}

TEST_F(GatherTest, no_vpls_and_no_surface_bring_nothing) {
    for (const vec4& e : run(random_gbuffer(9, 9), {}, {.block = 2, .beyond = 64})) EXPECT_EQ(e, vec4(0));
    for (const vec4& e : run(HostGBuffer(9, 9), random_vpls(50), {})) EXPECT_EQ(e, vec4(0));
    const HostGBuffer some = random_gbuffer(32, 32);
    const auto got = run(some, random_vpls(50), {});
    for (size_t i = 0; i < got.size(); ++i)
        EXPECT_TRUE(some.hit(i) || got[i] == vec4(0));
}

TEST_F(GatherTest, splitting_the_vpls_changes_no_bit) {
    const HostGBuffer g = random_gbuffer(24, 18);
    const auto vpls = random_vpls(133);
    for (uint block : {1u, 2u, 4u}) {
        const auto whole = run(g, vpls, {.block = block});
        const uint b2 = block * block;
        for (const std::vector<uint32_t>& parts : {std::vector<uint32_t>{b2}, {3 * b2, b2}, {64}, {112}})
            ASSERT_TRUE(same(whole, run(g, vpls, {.block = block, .parts = parts}))) << "block " << block << ", parts of " << parts[0];
    }
}

// Over a block of equal receivers, the pixels' mean is what one pixel gets that gathers all: each VPL counts once.
TEST_F(GatherTest, each_vpl_counts_once_over_a_block) {
    for (uint block : {2u, 3u, 4u, 8u})
        for (size_t n : {size_t(1), size_t(block * block - 1), size_t(block * block + 1), size_t(200)}) {
            HostGBuffer g(3 * block, 2 * block), one(1, 1);
            const vec3 x = point(), normal = direction();
            one.put(0, x, normal);
            for (size_t i = 0; i < g.pixels(); ++i) g.put(i, x, normal);
            const auto vpls = random_vpls(n);
            const dvec3 expected(run(one, vpls, {})[0]);
            const auto got = run(g, vpls, {.block = block});
            for (uint by = 0; by < 2; ++by)
                for (uint bx = 0; bx < 3; ++bx) {
                    dvec3 sum(0);
                    for (uint y = 0; y < block; ++y)
                        for (uint x2 = 0; x2 < block; ++x2) sum += dvec3(got[(by * block + y) * g.width + bx * block + x2]);
                    ASSERT_LE(length(sum / double(block * block) - expected), 1e-5 * length(expected) + 1e-12) << n << " VPLs, block " << block;
                }
        }
}

TEST_F(GatherTest, no_more_than_the_bound_and_no_less_where_it_does_not_bind) {
    const HostGBuffer g = random_gbuffer(32, 32);
    const auto vpls = random_vpls(64);
    dvec3 flux(0);
    for (const Vpl& v : vpls) flux += dvec3(v.flux);
    const auto unbounded = run(g, vpls, {});
    std::vector<vec4> before(g.pixels(), vec4(0));
    for (float bound : {0.0f, 1e-3f, 0.1f, 1.0f, 10.0f}) {
        const auto got = run(g, vpls, {.bound = bound});
        for (size_t i = 0; i < got.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                ASSERT_LE(got[i][c], flux[c] / std::numbers::pi * bound * 1.00001) << bound;
                ASSERT_GE(got[i][c], before[i][c]) << "falls with the bound";
                ASSERT_LE(got[i][c], unbounded[i][c]);
            }
        before = got;
    }
    EXPECT_TRUE(same(unbounded, run(g, vpls, {.bound = 1e20f})));
}

// The README's argument: a patch of area a and flux F brings nowhere more than its exitance F / a. A disc of many small patches,
// each bounded by pi / its area, must not exceed that anywhere, and must reach the closed form sin^2 away from it.
TEST_F(GatherTest, bounded_patches_bring_no_more_than_their_exitance) {
    const int rings = 40;
    std::vector<Vpl> disc;
    for (int y = -rings; y < rings; ++y)
        for (int x = -rings; x < rings; ++x) {
            const vec3 at(float(x + 0.5) / rings, 0, float(y + 0.5) / rings);
            if (dot(at, at) < 1) disc.push_back(vpl(at, {0, 1, 0}, vec3(1.0f / (rings * rings))));  // exitance 1
        }
    HostGBuffer g(64, 1);
    for (size_t i = 0; i < 64; ++i) g.put(i, {0, std::pow(10.0f, -4 + float(i) / 12), 0}, {0, -1, 0});
    const auto got = run(g, disc, {.bound = pi * rings * rings});
    for (size_t i = 0; i < 64; ++i) {
        const double h = g.position(i).y, closed = 1 / (1 + h * h);
        EXPECT_LE(got[i].x, 4.1) << h;  // four patches meet below the receiver
        EXPECT_TRUE(h < 0.1 || std::abs(got[i].x - closed) < 0.02 * closed) << h;
    }
}

TEST_F(GatherTest, hard_places_stay_finite) {
    const float tiny[] = {0, 1e-45f, 1e-40f, 1e-30f, 1e-22f, 1e-19f, 1e-10f, 1e-3f, 1, 1e6f, 1e12f};
    HostGBuffer g(11, 11);
    std::vector<Vpl> vpls;
    for (size_t y = 0; y < 11; ++y) {
        for (size_t x = 0; x < 11; ++x) {
            g.put(y * 11 + x, {tiny[x], -tiny[y], x % 2 ? 1.0f : 0.0f}, y % 3 ? vec3(0, 1, 0) : direction());
            g.shine(y * 11 + x, vec3(1), x % 4 ? brdf_least_roughness : 0.5f, x % 3 ? g.shading(y * 11 + x) : direction());
        }
        for (float flux : {0.0f, 1e-40f, 1.0f, 1e30f, 3e38f}) {
            vpls.push_back(vpl({0, tiny[y], 0}, {0, -1, 0}, vec3(flux)));
            vpls.push_back(vpl({1, 0, tiny[y]}, {1e-3f, -1, 0}, vec3(flux)));  // grazing
            vpls.push_back(vpl(g.position(y * 12), -g.shading(y * 12), vec3(flux)));  // exactly at a receiver
        }
    }
    const std::vector<uint> atlas(vpls.size() * map_texels(4), floatBitsToUint(0.5f));
    for (float bound : {0.0f, 1.0f, 1e30f, std::numeric_limits<float>::infinity()})
        for (uint block : {1u, 4u})
            for (bool maps : {false, true})
                for (const vec4& e : run(g, vpls, {.block = block, .bound = bound, .atlas = maps ? &atlas : nullptr, .map_size = 4, .bias = 0.5f}))
                    for (int c = 0; c < 3; ++c) ASSERT_TRUE(e[c] >= 0 && e[c] <= gather_most) << e[c] << ", bound " << bound;
}

TEST_F(GatherTest, comparator_sees_a_wrong_pixel) {
    const HostGBuffer g = random_gbuffer(16, 16);
    const auto vpls = random_vpls(40);
    const auto expected = gather_ref(g, vpls, 1, 3);
    auto got = run(g, vpls, {.bound = 3});
    ASSERT_TRUE(near(expected, got));
    size_t lit = 0;
    while (!(got[lit].y > 0)) ++lit;
    got[lit].y *= 1.01f;
    EXPECT_FALSE(near(expected, got));
    got[lit].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(near(expected, got));
}

}  // namespace
}  // namespace myriad::passes
