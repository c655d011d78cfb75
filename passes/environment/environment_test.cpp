// The background against the picture in doubles, and the views of an environment's lights.
#include "passes/environment/environment.hpp"

#include <cmath>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

#include "compute/views/parallel.h"
#include "engine/testing.hpp"
#include "passes/gather/host_gbuffer.hpp"

namespace myriad::passes {
namespace {

using glm::dvec2, glm::dvec3;

class EnvironmentTest : public engine::DeviceTest {
protected:
    float uniform(float lo = -1, float hi = 1) { return std::uniform_real_distribution<float>(lo, hi)(random); }
    vec3 direction() {
        for (;;)
            if (const vec3 d(uniform(), uniform(), uniform()); dot(d, d) > 0.01f && dot(d, d) < 1) return normalize(d);
    }
    scenes::Environment picture(uint32_t height, double rotation) {
        scenes::Environment e;
        e.width = 2 * height, e.height = height, e.rotation = rotation;
        for (uint32_t i = 0; i < e.width * height; ++i) e.texels.emplace_back(uniform(0, 2), uniform(0, 2), uniform(0, 2));
        return e;
    }
    // Bilinear between texels' middles, around the picture, up to the middles of the edge rows.
    static dvec3 looked_up(const scenes::Environment& e, const dvec3& d) {
        const double turn = (std::atan2(d.z, d.x) + e.rotation) / (2 * std::numbers::pi) + 0.5;
        const double x = (turn - std::floor(turn)) * e.width - 0.5, y = std::acos(std::clamp(d.y / length(d), -1.0, 1.0)) / std::numbers::pi * e.height - 0.5;
        dvec3 sum(0);
        for (int i = 0; i < 4; ++i) {
            const double column = std::floor(x) + i % 2, row = std::floor(y) + i / 2;
            const long c = (long(column) + e.width) % e.width, r = std::clamp(long(row), 0l, long(e.height) - 1);
            sum += (1 - std::abs(x - column)) * (1 - std::abs(y - row)) * dvec3(e.texels[size_t(r) * e.width + size_t(c)]);
        }
        return sum;
    }
};

TEST_F(EnvironmentTest, the_camera_sees_it_where_it_sees_nothing_else) {
    for (const auto& [height, rotation] : {std::pair{1u, 0.0}, {2u, 1.0}, {16u, -7.5}, {64u, 100.0}})
        for (const vec3& towards : {vec3(1, 0, 0), vec3(-1, 0.1f, 0.01f), vec3(0.01f, 1, 0), vec3(0, -1, 0.02f), direction()}) {
            SCOPED_TRACE(testing::Message() << height << ", " << towards.x << " " << towards.y << " " << towards.z);
            scenes::Scene scene;
            scene.environment = picture(height, rotation);
            EnvironmentPass pass(device, scene, vec3(0), vec3(1), 16);
            scenes::Camera camera;
            camera.yfov = 1.5f;
            camera.to_world = glm::inverse(glm::lookAt(vec3(3, 1, 2), vec3(3, 1, 2) + towards, std::abs(towards.y) > 0.9f ? vec3(0, 0, 1) : vec3(0, 1, 0)));
            HostGBuffer host(37, 21);
            for (size_t i = 0; i < host.pixels(); ++i) {
                host.emitted[i] = vec4(9);
                if (random() % 4 == 0) host.put(i, vec3(1), vec3(0, 1, 0));
            }
            const GBuffer gbuffer = host.on(device);
            engine::Recorder recorder(device);
            pass.record_background(recorder, gbuffer, camera);
            recorder.submit_and_wait();
            const auto got = engine::download(device, gbuffer.emitted);
            const CameraPush push = camera_push(camera, 37, 21);
            for (size_t i = 0; i < got.size(); ++i) {
                if (host.hit(i)) {
                    ASSERT_EQ(got[i], vec4(9)) << i;
                    continue;
                }
                const dvec3 expected = looked_up(*scene.environment, dvec3(camera_direction(push, uint(i % 37), uint(i / 37), 37, 21)));
                // Angles are good to some 1e-5, turns of many times around less.
                ASSERT_LE(length(dvec3(got[i]) - expected), 1e-4 + 3e-4 * height * (std::abs(rotation) > 10 ? 0.2 : 0.05)) << i;
            }
        }
}

// What shines from a place is seen there.
TEST_F(EnvironmentTest, directions_lie_where_their_light_comes_from) {
    const scenes::Environment e = picture(32, 0.7);
    for (int i = 0; i < 1000; ++i) {
        const double column = uniform(0, 64), row = std::floor(uniform(0, 32)) + 0.5;
        const vec2 place = environment_place(vec3(e.direction(column, row)), float(e.rotation / (2 * std::numbers::pi)));
        const double off = std::abs(place.x * 64 - column);
        EXPECT_LT(std::min(off, 64 - off), 1e-3) << row;
        EXPECT_LT(std::abs(place.y * 32 - row), 0.21) << row;  // rows are halved by solid angle, 1 / sqrt 2 of the way at the poles
    }
}

// All of the bounds lies within a view's rectangle, in front of it; and the rectangle is not much larger.
TEST_F(EnvironmentTest, views_hold_the_scene_and_little_else) {
    for (int i = 0; i < 3000; ++i) {
        const float scale = std::pow(10.0f, uniform(-6, 6)), far = random() % 4 ? 0 : 100 * scale;
        const uint size = 2u << random() % 8;
        const vec3 lo = far * direction() + scale * vec3(uniform(), uniform(), uniform());
        const vec3 hi = lo + scale * vec3(uniform(0, 1), uniform(0, 1), random() % 3 ? uniform(0, 1) : 0);
        const View view = parallel_view(random() % 4 ? direction() : vec3(0, random() % 2 ? 1 : -1, 0), lo, hi, size);
        ASSERT_TRUE(is_parallel(view));
        ASSERT_LE(parallel_columns(view) * parallel_rows(view, size), map_texels(size));
        const ParallelFrame frame = parallel_frame(view.direction);
        vec2 least(1e30f), most(-1e30f);
        float deepest = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const vec3 d = vec3(corner & 1 ? hi.x : lo.x, corner & 2 ? hi.y : lo.y, corner & 4 ? hi.z : lo.z) - view.position;
            ASSERT_GT(dot(d, view.direction), 0);
            deepest = std::max(deepest, dot(d, view.direction) / parallel_texel(view, size));
            const vec2 place = parallel_place(view, frame, d, size);
            least = glm::min(least, place), most = glm::max(most, place);
        }
        const vec2 sides(float(parallel_columns(view)), float(parallel_rows(view, size)));
        ASSERT_TRUE(least.x >= 0 && least.y >= 0 && most.x <= sides.x && most.y <= sides.y) << i << " " << size << ": " << least.x << " " << least.y << " " << most.x << " " << most.y;
        const vec2 used = (most - least) / sides;
        const vec2 extent = most - least;
        if (size >= 16 && std::min(extent.x, extent.y) > std::max({extent.x, extent.y, deepest}) / 7) {  // thinner ones are given some width
            ASSERT_GT(used.x * used.y, 0.7f) << i;
            ASSERT_GT(sides.x * sides.y / float(map_texels(size)), 0.8f) << i;
        }
    }
}

TEST_F(EnvironmentTest, lights_are_far_and_face_their_views) {
    scenes::Scene scene;
    scene.lights.resize(3);
    scenes::apply_environment(scene, picture(16, 0), 50, 1);
    const EnvironmentPass pass(device, scene, vec3(-1), vec3(1, 2, 3), 16);
    const auto lights = engine::download(device, pass.lights());
    const auto views = engine::download(device, pass.views());
    ASSERT_EQ(lights.size(), 50u);
    EXPECT_EQ(engine::download(device, pass.count())[0], 50u);
    for (size_t i = 0; i < 50; ++i) {
        EXPECT_EQ(far_direction(lights[i]), -scene.lights[3 + i].direction);
        EXPECT_EQ(views[i].direction, scene.lights[3 + i].direction);
        EXPECT_NEAR(lights[i].flux.y / std::numbers::pi, scene.lights[3 + i].intensity.y, 1e-5);
        EXPECT_EQ(far_solid_angle(lights[i]), scene.environment->solid_angles[i]);
    }
}

}  // namespace
}  // namespace myriad::passes
