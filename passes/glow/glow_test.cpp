#include "passes/glow/glow.hpp"

#include <cmath>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/testing.hpp"
#include "passes/geometry/test_scene.hpp"
#include "passes/glow/glow_ref.hpp"

namespace myriad::passes {
namespace {

using glm::dvec3;

class GlowTest : public engine::DeviceTest {
protected:
    float uniform(float lo = -1, float hi = 1) { return std::uniform_real_distribution<float>(lo, hi)(random); }
    // Looks along -z from the origin.
    static scenes::Camera camera(const mat4& to_world = mat4(1)) {
        scenes::Camera c;
        c.to_world = to_world, c.yfov = 1;
        return c;
    }
    static scenes::Light ball(const vec3& at, float radius, const vec3& intensity) { return {.position = at, .intensity = intensity, .radius = radius}; }
    std::vector<vec4> run(const HostGBuffer& host, const scenes::Camera& camera, const std::vector<scenes::Light>& lights) {
        TestScene test;
        test.material(vec3(1));
        test.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
        test.scene.lights = lights;
        const UploadedScene scene(device, test);
        const GBuffer gbuffer = host.on(device);
        EXPECT_TRUE(GlowPass::needed(scene.lights));
        GlowPass pass(device, host.width, host.height);
        engine::Recorder recorder(device);
        pass.record(recorder, gbuffer, camera, scene.lights);
        recorder.submit_and_wait();
        return engine::download(device, gbuffer.emitted);
    }
    static ::testing::AssertionResult near(const HostGBuffer& host, const std::vector<GlowRef>& expected, const std::vector<vec4>& got) {
        for (size_t i = 0; i < got.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                const double value = double(host.emitted[i][c]) + expected[i].radiance[c];
                if (!(std::abs(value - double(got[i][c])) <= expected[i].slack[c] + 1e-6 * value))
                    return ::testing::AssertionFailure() << "pixel " << i % host.width << ", " << i / host.width << ": " << value << " +- " << expected[i].slack[c] << " expected, " << got[i][c] << " found";
            }
        return ::testing::AssertionSuccess();
    }
    // Surfaces at some depths, and sky.
    HostGBuffer random_gbuffer(uint32_t width, uint32_t height) {
        HostGBuffer g(width, height);
        for (size_t i = 0; i < g.pixels(); ++i) {
            if (random() % 4) g.put(i, vec3(0), {0, 0, 1}, {0, 0, 1}, uniform(1, 9));
            g.emitted[i] = vec4(uniform(0, 2), uniform(0, 2), uniform(0, 2), 0);
        }
        return g;
    }
    std::vector<scenes::Light> random_balls(size_t n) {
        std::vector<scenes::Light> lights;
        for (size_t i = 0; i < n; ++i) lights.push_back(ball({uniform(-6, 6), uniform(-4, 4), uniform(-9, 2)}, std::pow(10.0f, uniform(-2, -0.3f)), {uniform(0, 1), uniform(0, 3), 0.5f}));
        return lights;
    }
};

TEST_F(GlowTest, a_large_ball_has_its_radiance_in_the_middle_and_its_power_in_all) {
    HostGBuffer g(101, 101);
    const auto got = run(g, camera(), {ball({0, 0, -4}, 0.25f, {1, 2, 4})});
    const double radiance = 1 / (std::numbers::pi * 0.0625);
    EXPECT_NEAR(got[50 * 101 + 50].x, radiance, 1e-3 * radiance);
    // Pixels of solid angle (tan / 50.5)^2 where d is along the axis; intensity / d^2 falls on the lens.
    double sum = 0;
    for (const vec4& e : got) sum += double(e.y);
    const double pixel = std::pow(std::tan(0.5) / 50.5, 2);
    EXPECT_NEAR(sum * pixel, 2.0 / 16, 0.01 * 2.0 / 16);
}

TEST_F(GlowTest, far_balls_keep_their_power_wherever_they_are) {
    HostGBuffer g(101, 101);
    const double pixel = std::pow(std::tan(0.5) / 50.5, 2);
    for (int i = 0; i < 20; ++i) {
        const auto got = run(g, camera(), {ball({uniform(), uniform(), -40}, 0.02f, vec3(1))});
        double sum = 0;
        for (const vec4& e : got) sum += double(e.x);
        EXPECT_NEAR(sum * pixel * 1600, 1, 0.25);  // a few pixels sample the disc
    }
}

TEST_F(GlowTest, equals_the_twin) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {63u, 5u}, {65u, 48u}})
        for (size_t n : {1, 63, 65, 300}) {
            const HostGBuffer g = random_gbuffer(width, height);
            const auto lights = random_balls(n);
            const auto c = camera(glm::rotate(glm::translate(mat4(1), vec3(0.1f, 0.2f, 0.3f)), 0.4f, vec3(0.2f, 1, 0.1f)));
            const auto expected = glow_ref(g, c, lights);
            EXPECT_TRUE(near(g, expected, run(g, c, lights))) << width << "x" << height << ", " << n;
            double light = 0, slack = 0;
            for (const GlowRef& r : expected) light += r.radiance.y, slack += r.slack.y;
            if (n == 300 && width > 1) { EXPECT_TRUE(light > 0 && slack < 5e-3 * light) << slack << " of " << light; }
        }
}

TEST_F(GlowTest, only_balls_in_front_of_surfaces_are_seen) {
    HostGBuffer g(9, 9);
    for (size_t i = 0; i < g.pixels(); ++i) g.put(i, vec3(0), {0, 0, 1}, {0, 0, 1}, 3);
    for (const auto& [z, seen] : {std::pair{-2.0f, true}, {-4.0f, false}, {2.0f, false}}) EXPECT_EQ(run(g, camera(), {ball({0, 0, z}, 0.5f, vec3(1))})[40].x > 0, seen) << z;
    TestScene none;
    none.light(scenes::Light::Type::point, vec3(0), {0, 0, -1}, vec3(1));
    none.material(vec3(1));
    EXPECT_FALSE(GlowPass::needed(UploadedScene(device, none).lights));
}

TEST_F(GlowTest, balls_in_one_place_have_room_and_any_order_is_the_same) {
    HostGBuffer g(9, 9);
    std::vector<scenes::Light> lights(70000, ball({0, 0, -1}, 0.1f, vec3(1)));
    const double radiance = 70000 / (std::numbers::pi * 0.01);
    EXPECT_NEAR(run(g, camera(), lights)[40].x, radiance, 1e-4 * radiance);
    auto mixed = random_balls(500);
    const auto got = run(g, camera(), mixed);
    std::reverse(mixed.begin(), mixed.end());
    EXPECT_TRUE(engine::same(got, run(g, camera(), mixed)));
}

TEST_F(GlowTest, hard_balls_are_finite) {
    HostGBuffer g(17, 9);
    std::vector<scenes::Light> lights;
    for (float z : {0.0f, -1e-30f, -1e-6f, -1.0f, -1e9f})
        for (float x : {0.0f, 1e-20f, 1.0f, -1e9f})
            for (float radius : {1e-30f, 1e-9f, 0.5f, 1e9f})
                for (float intensity : {0.0f, 1e-30f, 1e20f}) lights.push_back(ball({x, -x, z}, radius, vec3(intensity)));
    for (const vec4& e : run(g, camera(), lights)) ASSERT_TRUE(std::isfinite(e.x) && e.x >= 0) << e.x;
}

TEST_F(GlowTest, comparator_sees_a_missing_ball) {
    const HostGBuffer g = random_gbuffer(65, 48);
    auto lights = random_balls(100);
    const auto got = run(g, camera(), lights);
    lights.erase(lights.begin(), lights.begin() + 50);
    EXPECT_FALSE(near(g, glow_ref(g, camera(), lights), got));
}

}  // namespace
}  // namespace myriad::passes
