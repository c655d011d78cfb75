#include "passes/compensate/compensate.hpp"

#include <map>
#include <set>

#include "engine/testing.hpp"
#include "passes/compensate/compensate_ref.hpp"
#include "passes/geometry/test_scene.hpp"

namespace myriad::passes {
namespace {

using glm::dvec3;
using Type = scenes::Light::Type;

class CompensateTest : public engine::DeviceTest {
protected:
    struct Given {
        float bound = 1;
        uint32_t rays = 1, bounces = 1, seed = 1;
    };
    std::vector<vec4> run(const TestScene& test, const HostGBuffer& g, const Given& given, bool filter = false) {
        const UploadedScene scene(device, test);
        const GBuffer gbuffer = g.on(device);
        const auto exhausted = on_device(std::vector<uint>{0});
        CompensatePass pass(device, g.width, g.height, given.rays, filter, scene.bvh.constants({{glossy_constant, gbuffer.glossy()}}));
        engine::Recorder recorder(device);
        pass.record(recorder, {gbuffer, scene.geometry, scene.bvh, scene.lights, given.bound, given.bounces, given.seed}, 0.01f, exhausted);
        recorder.submit_and_wait();
        EXPECT_EQ(engine::download(device, exhausted)[0], 0u);
        return engine::download(device, pass.irradiance());
    }
    static std::vector<dvec3> twin(const TestScene& test, const HostGBuffer& g, const Given& given) {
        return compensate_ref(test.scene, test.triangles, g, given.bound, given.rays, given.bounces, given.seed);
    }
    static size_t differing(const std::vector<dvec3>& expected, const std::vector<vec4>& got) {
        size_t wrong = 0;
        for (size_t i = 0; i < expected.size(); ++i) wrong += !(glm::length(expected[i] - dvec3(got[i])) <= 1e-6 + 1e-3 * glm::length(expected[i]));
        return wrong;
    }

    // Receivers on the triangles of a soup, a few of them nowhere.
    HostGBuffer receivers(const TestScene& test, uint32_t width, uint32_t height) {
        std::uniform_real_distribution<float> unit(0.1f, 0.45f);
        HostGBuffer g(width, height);
        const auto& p = test.triangles.positions;
        for (size_t i = 0; i < g.pixels(); ++i) {
            const uvec4& t = test.triangles.triangles[random() % test.triangles.triangles.size()];
            const float u = unit(random), v = unit(random);
            const vec3 n = (random() % 2 ? 1.0f : -1.0f) * glm::normalize(glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x]));
            if (random() % 8 == 0) continue;
            g.put(i, (1 - u - v) * p[t.x] + u * p[t.y] + v * p[t.z], glm::normalize(n + 0.3f * vec3(unit(random), unit(random), unit(random))), n);
            g.albedo[i].w = ray_reach(p[t.x], p[t.y], p[t.z]);
        }
        return g;
    }
    static double sum(const std::vector<dvec3>& light) {
        double all = 0;
        for (const dvec3& v : light) all += v.x + v.y + v.z;
        return all;
    }

    // A patch that shines, 1 x 1, at this height over a receiver of w x h pixels that are all the same.
    static TestScene patch(float height, const vec3& emission) {
        TestScene test;
        test.quad({-0.5f, height, -0.5f}, {1, 0, 0}, {0, 0, 1}, test.material(vec3(0), emission));
        return test;
    }
};

// Integrated over the patch: radiance times what of the geometry term is above the bound.
TEST_F(CompensateTest, a_shining_patch_by_quadrature) {
    for (const auto& [height, bound] : {std::pair{0.5f, 0.5f}, {0.5f, 2.0f}, {0.2f, 1.0f}, {1.0f, 1.01f}}) {
        double wanted = 0;
        constexpr int steps = 300;
        for (int i = 0; i < steps; ++i)
            for (int j = 0; j < steps; ++j) {
                const double x = (i + 0.5) / steps - 0.5, z = (j + 0.5) / steps - 0.5, d2 = x * x + z * z + double(height * height);
                wanted += std::max(double(height * height) / (d2 * d2) - double(bound), 0.0) / (double(steps) * steps);
            }
        HostGBuffer g(64, 64);
        for (size_t i = 0; i < g.pixels(); ++i) g.put(i, vec3(0), {0, 1, 0});
        const TestScene test = patch(height, vec3(1, 2, 3));
        const Given given{.bound = bound, .rays = 4, .bounces = 0};
        dvec3 mean(0), mean_twin(0);
        for (const vec4& v : run(test, g, given)) mean += dvec3(v) / double(g.pixels());
        for (const dvec3& v : twin(test, g, given)) mean_twin += v / double(g.pixels());
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(mean[c], (c + 1) * wanted, 0.01 * (c + 1) * wanted + 1e-5) << height << " " << bound;
            EXPECT_NEAR(mean_twin[c], (c + 1) * wanted, 0.01 * (c + 1) * wanted + 1e-5);
        }
    }
}

TEST_F(CompensateTest, what_is_far_is_not_cut_off) {
    HostGBuffer g(16, 16);
    for (size_t i = 0; i < g.pixels(); ++i) g.put(i, vec3(0), {0, 1, 0});
    for (const vec4& v : run(patch(1, vec3(1)), g, {.bound = 1.0001f, .rays = 3})) EXPECT_EQ(v, vec4(0));
    double light = 0;
    for (const vec4& v : run(patch(1, vec3(1)), g, {.bound = 0.9f, .rays = 3})) light += double(v.x);
    EXPECT_GT(light, 0);
}

TEST_F(CompensateTest, equals_the_twin_on_random_scenes) {
    for (const int lights : {0, 1, 2, 3})
        for (uint32_t bounces = 0; bounces <= 3; bounces += 1 + (lights > 1)) {
            TestScene test;
            test.material({0.8f, 0.6f, 0.4f});
            if (lights == 0 || lights == 3) test.material({0.2f, 0.9f, 0.7f}, vec3(1, 2, 3), true), test.material({0.5f, 0.5f, 0.5f}, vec3(2));
            test.soup(60, 1.5f, random);
            for (int i = 0; i < lights; ++i) test.light(Type((i + lights) % 3), {2.0f - float(i), 3, 1}, {-1, -2, 0.5f}, vec3(9, 5, 3), 0.2f, 1.2f);
            const HostGBuffer g = receivers(test, 19, 13);
            const Given given{.bound = 0.3f, .rays = 1 + bounces, .bounces = bounces, .seed = uint32_t(random())};
            const auto expected = twin(test, g, given);
            // An edge, of a triangle or of a shadow, may fall either way.
            EXPECT_LE(differing(expected, run(test, g, given)), g.pixels() / 50) << lights << " lights, " << bounces << " bounces";
            EXPECT_TRUE(sum(expected) > 0 || (lights > 0 && lights < 3 && bounces == 0));
            for (size_t i = 0; i < g.pixels(); ++i) EXPECT_TRUE(g.hit(i) || expected[i] == dvec3(0));
        }
}

TEST_F(CompensateTest, sizes) {
    TestScene test;
    test.material({0.8f, 0.6f, 0.4f}, vec3(1), true);
    test.soup(30, 1, random);
    for (const auto& [width, height] : {std::pair{1u, 1u}, {7u, 9u}, {64u, 1u}, {65u, 1u}}) {
        const HostGBuffer g = receivers(test, width, height);
        EXPECT_LE(differing(twin(test, g, {}), run(test, g, {})), g.pixels() / 50) << width << "x" << height;
    }
}

TEST_F(CompensateTest, glossy_receivers_and_holes) {
    TestScene test;
    test.material({0.8f, 0.6f, 0.4f});
    for (int i = 0; i < 2; ++i) test.textured(random).alpha = scenes::Material::Alpha::mask;
    test.soup(60, 1.5f, random);
    test.decorate(random);
    test.light(Type::directional, vec3(0), {-1, -2, 0.5f}, vec3(3));
    HostGBuffer g = receivers(test, 19, 13);
    for (size_t i = 0; i < g.pixels(); i += 2) g.shine(i, vec3(0.04f), 0.2f + 0.003f * float(i), glm::normalize(g.geometric(i) + vec3(0.3f, 0.2f, 0.1f)));
    const Given given{.bound = 0.3f, .rays = 2, .bounces = 2};
    EXPECT_LE(differing(twin(test, g, given), run(test, g, given)), g.pixels() / 30);
}

TEST_F(CompensateTest, the_same_bits_and_another_seed_another_noise) {
    TestScene test;
    test.material({0.8f, 0.6f, 0.4f}, vec3(1), true);
    test.soup(30, 1, random);
    const HostGBuffer g = receivers(test, 20, 20);
    const auto once = run(test, g, {});
    EXPECT_TRUE(engine::same(once, run(test, g, {})));
    EXPECT_FALSE(engine::same(once, run(test, g, {.seed = 2})));
}

// The points of a block, of all its rays, are each element of one set once; other blocks have sets of their own.
TEST(Compensate, blocks_have_each_point_of_a_set_of_their_own) {
    constexpr uint32_t rays = 3, side = 3 * compensate_block;
    std::map<uint32_t, std::multiset<uint32_t>> sets;
    for (uint32_t y = 0; y < side; ++y)
        for (uint32_t x = 0; x < side; ++x)
            for (uint32_t ray = 0; ray < rays; ++ray) sets[compensate_seed(x, y, 7)].insert(compensate_index(x, y, ray));
    std::multiset<uint32_t> all;
    for (uint32_t i = 0; i < rays * compensate_block * compensate_block; ++i) all.insert(i);
    EXPECT_EQ(sets.size(), 9u);
    for (const auto& [seed, indices] : sets) EXPECT_EQ(indices, all);
}

// What the filter averages is the set that a block of pixels shares, so a patch over a plane is even after it.
TEST_F(CompensateTest, blocks_share_a_set_that_the_filter_averages) {
    HostGBuffer g(32, 32);
    for (size_t i = 0; i < g.pixels(); ++i) g.put(i, vec3(0), {0, 1, 0});
    const auto deviation = [](const std::vector<vec4>& light) {
        double mean = 0, squares = 0;
        for (const vec4& v : light) mean += double(v.x), squares += double(v.x) * double(v.x);
        mean /= double(light.size());
        return std::sqrt(squares / double(light.size()) - mean * mean) / mean;
    };
    const TestScene test = patch(0.3f, vec3(1));
    // 16 independent rays would leave a quarter of the deviation.
    EXPECT_LT(deviation(run(test, g, {.bound = 1}, true)), 0.15 * deviation(run(test, g, {.bound = 1}, false)));
}

TEST_F(CompensateTest, comparator_sees_a_wrong_pixel) {
    TestScene test;
    test.material({0.8f, 0.6f, 0.4f}, vec3(1), true);
    test.soup(30, 1, random);
    const HostGBuffer g = receivers(test, 8, 8);
    const auto expected = twin(test, g, {});
    auto got = run(test, g, {});
    const size_t before = differing(expected, got);
    got[9] += 0.01f;
    EXPECT_EQ(differing(expected, got), before + 1);
}

}  // namespace
}  // namespace myriad::passes
