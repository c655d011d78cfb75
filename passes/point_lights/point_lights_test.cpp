#include "passes/point_lights/point_lights.hpp"

#include "compute/views/paraboloid.h"
#include "engine/testing.hpp"
#include "passes/geometry/test_scene.hpp"
#include "passes/vpl/vpl.hpp"
#include "passes/vpl/vpl_ref.hpp"

namespace myriad::passes {
namespace {

using Type = scenes::Light::Type;

class PointLightsTest : public engine::DeviceTest {
protected:
    // Points among others, of which the last two stand for an environment.
    static TestScene mixed() {
        TestScene test;
        test.material(vec3(0.5f));
        test.room(vec3(-2), vec3(2), 0);
        for (const auto& [type, x] : {std::pair{Type::point, 0.1f}, {Type::spot, 0.2f}, {Type::point, 0.3f}, {Type::directional, 0.4f}, {Type::point, 0.5f}, {Type::directional, 0.6f}, {Type::directional, 0.7f}})
            test.light(type, {x, 0, 0}, {0, -1, 0}, vec3(x));
        test.scene.lights[4].intensity = vec3(0), test.scene.lights[2].radius = 0.25f;
        test.scene.environment.emplace();
        test.scene.environment->solid_angles = {1, 1};
        return test;
    }
};

TEST_F(PointLightsTest, points_come_last_in_their_order_and_the_others_in_theirs) {
    const TestScene test = mixed();
    const UploadedScene scene(device, test, true);
    const LightData& data = scene.lights.data();
    EXPECT_EQ(data.order, (std::vector<uint32_t>{1, 3, 5, 6, 0, 2, 4}));
    EXPECT_EQ(scene.lights.lamps(), 2u);
    EXPECT_EQ(data.guided(), 4u);
    ASSERT_EQ(scene.lights.points_apart().size(), 3u);
    for (const Light& light : scene.lights.points_apart()) EXPECT_EQ(light.type, light_point);
    const UploadedScene together(device, test);
    EXPECT_TRUE(together.lights.data().order.empty() && together.lights.points_apart().empty());
    EXPECT_EQ(together.lights.lamps(), 5u);
    EXPECT_EQ(together.lights.power(), scene.lights.power());
}

TEST_F(PointLightsTest, lights_and_views_are_the_tables_and_follow_it) {
    const TestScene test = mixed();
    UploadedScene scene(device, test, true);
    PointLights points(device, scene.lights);
    std::vector<scenes::Light> now = test.scene.lights;
    for (int move = 0; move < 3; ++move) {
        const auto lights = engine::download(device, points.lights());
        const auto views = engine::download(device, points.views());
        EXPECT_EQ(engine::download(device, points.count()), std::vector<uint>{3});
        for (size_t i = 0; i < 3; ++i) {
            const scenes::Light& from = now[std::array<size_t, 3>{0, 2, 4}[i]];
            EXPECT_EQ(lights[i].position, from.position);
            EXPECT_EQ(omni_radius(lights[i]), from.radius);
            EXPECT_LT(glm::length(lights[i].flux / 3.14159265f - from.intensity), 1e-6f);
            if (i == 2) {
                EXPECT_EQ(views[i].position, view_of_nothing().position) << "it is dark";
                continue;
            }
            EXPECT_EQ(views[i].position, from.position);
            for (const vec3& d : {vec3(1, 0, 0), vec3(-1, 0, 0), vec3(0, 3, 0), vec3(-2, 0.1f, 5)}) EXPECT_FALSE(outside_frustum(views[i], d, 0));
        }
        for (scenes::Light& light : now) light.position += vec3(0.1f, -0.2f, 0.3f);
        scene.lights.move(now);
        points.follow(scene.lights);
    }
}

// Paths start at all lights, guided where the guide has cells, and the twin takes the same.
TEST_F(PointLightsTest, vpls_of_points_apart_have_their_power) {
    TestScene test;
    test.material(vec3(0.5f));
    test.room(vec3(-2), vec3(2), 0);
    test.light(Type::spot, vec3(0), {0, -1, 0}, vec3(3));
    for (int i = 0; i < 500; ++i) test.light(Type::point, {0.003f * float(i) - 0.7f, 0.1f, 0.2f}, {0, -1, 0}, vec3(float(i % 7)));
    const UploadedScene apart(device, test, true), together(device, test);
    const auto fluxes = [&](const UploadedScene& scene) {
        VplPass pass(device, 4096, scene.bvh.constants());
        engine::Recorder recorder(device);
        pass.prepare(recorder, scene.geometry, scene.bvh, scene.lights, 1, 1);
        EXPECT_EQ(pass.guide()->data().cells.size(), size_t(scene.lights.data().guided()) * guide_floats);
        pass.record(recorder, scene.geometry, scene.bvh, scene.lights, 1, 1);
        recorder.submit_and_wait();
        const auto count = engine::download(device, pass.count());
        EXPECT_GT(count[1], 3000u);
        double sum = 0;
        for (const Vpl& v : engine::download(device, pass.vpls(), count[0])) sum += double(v.flux.x);
        return sum;
    };
    // All light meets the walls, of which half is reflected.
    EXPECT_NEAR(fluxes(apart) / (0.5 * apart.lights.power()), 1, 0.01);
    EXPECT_NEAR(fluxes(together) / (0.5 * apart.lights.power()), 1, 0.01);
}

}  // namespace
}  // namespace myriad::passes
