// Whole frames under an environment: a sky of known radiance, the integral over a picture, maps against rays.
#include <cmath>
#include <functional>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/testing.hpp"
#include "passes/frame.hpp"
#include "passes/geometry/geometry_ref.hpp"
#include "scenes/moment.hpp"
#include "tests/frame_testing.hpp"
#include "tests/scene_kit.hpp"

namespace myriad::tests {
namespace {

using engine::same;
using glm::dvec3;
using passes::Visibility;

class EnvironmentFrameTest : public engine::DeviceTest {
protected:
    static scenes::Environment picture(uint32_t height, const std::function<vec3(uint32_t, uint32_t)>& radiance) {
        scenes::Environment e;
        e.name = "test.exr", e.width = 2 * height, e.height = height;
        for (uint32_t y = 0; y < height; ++y)
            for (uint32_t x = 0; x < e.width; ++x) e.texels.push_back(radiance(x, y));
        return e;
    }
    // A blue sky with a bright and a warm side, darker below.
    static scenes::Environment daylight() {
        return picture(16, [](uint32_t x, uint32_t y) {
            const float side = 1 + std::cos(float(x) * 0.19635f), bright = x / 3 == 2 && y / 3 == 1 ? 20.0f : 1.0f;
            return y < 8 ? bright * vec3(0.3f + side, 0.5f + 0.5f * side, 1.2f) : vec3(0.2f, 0.15f, 0.1f);
        });
    }
    static passes::FrameSettings settings(Visibility visibility, uint32_t vpls = 0) {
        passes::FrameSettings s;
        s.width = 64, s.height = 48, s.vpls = vpls, s.subset = 0, s.visibility = visibility, s.log2_samples = 14;
        return s;
    }
    std::vector<vec4> render(const scenes::Scene& scene, const passes::FrameSettings& s) {
        scenes::Scene copy = scene;
        const scenes::Triangles triangles = scenes::flatten(copy);
        passes::Frame frame(device, copy, triangles, s);
        frame.render(copy.cameras[0]);
        return engine::download(device, frame.beauty());
    }
    // A floor, and on it a block and a wall.
    static Kit yard() {
        Kit kit;
        kit.material(vec3(0.8f));
        kit.quad(0, {-2, 0, -2}, {0, 0, 4}, {4, 0, 0});
        kit.box(0, {-0.6f, 0, -0.4f}, {0.2f, 0.9f, 0.5f});
        kit.quad(0, {1, 0, -1}, {0, 0, 2}, {0, 1.4f, 0});
        kit.look({-1.5f, 2, 3}, {0, 0.3f, 0});
        return kit;
    }
};

// Under a sky of radiance 1 all around, a surface that sees its hemisphere whole is as bright as its albedo, whatever it hides behind itself.
TEST_F(EnvironmentFrameTest, a_furnace_without_walls) {
    Kit kit;
    kit.material(vec3(0.5f, 0.25f, 1));
    kit.quad(0, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
    kit.look({0, 1, 2}, {0, 0, 0});
    scenes::apply_environment(kit.scene, picture(16, [](uint32_t, uint32_t) { return vec3(1); }), 1024, 1);
    for (Visibility v : {Visibility::manylods, Visibility::rays, Visibility::none})
        for (uint32_t subset : {0u, 256u}) {
            passes::FrameSettings s = settings(v);
            s.subset = subset;
            size_t sky = 0, floor = 0;
            for (const vec4& p : render(kit.scene, s)) {
                const bool is_sky = p.x == 1 && p.y == 1;
                ++(is_sky ? sky : floor);
                if (is_sky) continue;
                EXPECT_LT(glm::length(dvec3(p) - dvec3(0.5, 0.25, 1)), 0.05) << int(v) << " " << subset;
            }
            EXPECT_TRUE(sky > 500 && floor > 500) << sky << " " << floor;
        }
}

// The light of 4096 lights, by rays and by maps, is the integral over the picture of what is seen of it.
TEST_F(EnvironmentFrameTest, light_is_the_integral_of_what_is_seen_of_the_picture) {
    Kit kit = yard();
    const scenes::Environment e = daylight();
    scenes::apply_environment(kit.scene, e, 4096, 1);
    const scenes::Triangles triangles = scenes::flatten(kit.scene);
    const passes::FrameSettings s = settings(Visibility::rays);
    passes::Frame frame(device, kit.scene, triangles, s);
    frame.render(kit.scene.cameras[0]);
    const auto rays = engine::download(device, frame.beauty());
    const auto positions = engine::download(device, frame.gbuffer().positions);
    const auto normals = engine::download(device, frame.gbuffer().normals);
    passes::FrameSettings fine = settings(Visibility::manylods);
    fine.maps.map_size = 64, fine.log2_samples = 16;
    const auto maps = render(kit.scene, fine);
    double error = 0, map_error = 0, light = 0, open = 0;
    int tested = 0;
    for (size_t i = 7; i < rays.size(); i += 61) {
        if (positions[i].w == 0) continue;
        const dvec3 n(unpack_direction(normals[i].y)), from = dvec3(positions[i]) + 1e-4 * n;
        dvec3 irradiance(0), without(0);
        for (uint32_t y = 0; y < e.height; ++y)
            for (uint32_t x = 0; x < e.width; ++x)
                for (int part = 0; part < 4; ++part) {
                    const dvec3 d = e.direction(x + 0.25 + part % 2 * 0.5, y + 0.25 + part / 2 * 0.5);
                    const double cosine = glm::dot(d, n);
                    if (cosine <= 0) continue;
                    const dvec3 here = 0.25 * cosine * e.solid_angle(y) * dvec3(e.texels[y * e.width + x]);
                    without += here;
                    if (!passes::closest_ref(triangles, from, d, 0, 1e9)) irradiance += here;
                }
        const dvec3 truth = 0.8 / std::numbers::pi * irradiance;
        error += glm::length(dvec3(rays[i]) - truth), map_error += glm::length(dvec3(maps[i]) - truth);
        light += glm::length(truth), open += glm::length(0.8 / std::numbers::pi * without);
        ++tested;
    }
    EXPECT_GT(tested, 20);
    EXPECT_LT(light, 0.9 * open) << "nothing is hidden: not a test";
    EXPECT_LT(error, 0.02 * light);
    EXPECT_LT(map_error, 0.04 * light);
    std::printf("rays %.4f, maps %.4f of the light; %.2f of it is not hidden\n", error / light, map_error / light, light / open);
}

TEST_F(EnvironmentFrameTest, maps_are_near_to_rays) {
    Kit kit = yard();
    scenes::apply_environment(kit.scene, daylight(), 256, 1);
    for (uint32_t vpls : {0u, 256u}) {
        const auto rays = render(kit.scene, settings(Visibility::rays, vpls)), maps = render(kit.scene, settings(Visibility::manylods, vpls)),
                   none = render(kit.scene, settings(Visibility::none, vpls));
        const double of_maps = difference(maps, rays), of_none = difference(none, rays);
        EXPECT_LT(of_maps, 0.04) << vpls;
        EXPECT_GT(of_none, 3 * of_maps) << vpls;
    }
    // Light that bounces makes it brighter.
    const auto once = render(kit.scene, settings(Visibility::rays)), more = render(kit.scene, settings(Visibility::rays, 256));
    double sum = 0, sum_more = 0;
    for (size_t i = 0; i < once.size(); ++i) sum += once[i].y, sum_more += more[i].y;
    EXPECT_GT(sum_more, 1.01 * sum);
}

// A mirror shows the sky, at the angle that it mirrors, and nothing where only light from below would be mirrored.
TEST_F(EnvironmentFrameTest, metal_reflects_the_environment) {
    Kit kit;
    kit.material(vec3(1));
    kit.scene.materials[0].metallic = 1, kit.scene.materials[0].roughness = 0.3f;
    kit.quad(0, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
    kit.look({0, 1, 2}, {0, 0, 0});
    scenes::apply_environment(kit.scene, picture(16, [](uint32_t, uint32_t y) { return vec3(y < 8 ? 1.0f : 0.0f); }), 2048, 1);
    for (Visibility v : {Visibility::manylods, Visibility::rays}) {
        double mean = 0;
        size_t floor = 0;
        passes::FrameSettings s = settings(v);
        const auto image = render(kit.scene, s);
        for (size_t i = image.size() / 2; i < image.size(); ++i)
            if (image[i].x > 0 && image[i].x != 1) mean += image[i].x, ++floor;
        EXPECT_NEAR(mean / double(floor), 0.95, 0.07) << int(v);
        s.brdf = passes::Brdf::diffuse;
        const auto black = render(kit.scene, s);
        for (size_t i = black.size() / 2; i < black.size(); ++i) ASSERT_EQ(black[i].x, 0) << i;
    }
}

// While blocks move, cuts that are carried are those from the roots, so images are the same to the bit; views of the environment rest.
TEST_F(EnvironmentFrameTest, carried_cuts_are_those_from_the_roots) {
    Kit kit = yard();
    scenes::Scene& scene = kit.scene;
    Kit block;
    block.material(vec3(0.7f));
    block.box(0, vec3(-0.3f), vec3(0.3f));
    scene.meshes.push_back(block.scene.meshes[0]);
    scene.nodes = {{.name = "block", .rest = {.translation = {-1, 1.5, 0}}}};
    scene.instances.push_back({1, glm::translate(glm::mat4(1), vec3(-1, 1.5f, 0)), 0});
    scene.clips = {{"all", {{.width = 3, .times = {0, 1}, .values = {-1, 1.5f, 0, 1, 0.8f, 1}}}, {{0, 0, scenes::Path::translation}}}};
    scenes::apply_environment(scene, daylight(), 64, 1);
    const scenes::Triangles triangles = scenes::flatten(scene, scenes::Sharing::automatic, {{0}});
    ASSERT_GT(triangles.motion.count(), 0u);
    passes::FrameSettings s = settings(Visibility::manylods);
    passes::Frame basic(device, scene, triangles, s);
    s.maps.update = passes::CutUpdate::incremental;
    passes::Frame carried(device, scene, triangles, s);
    uint64_t evaluated = 0, needed = 0;
    std::vector<vec4> before;
    for (const double seconds : {0.0, 0.1, 0.1, 0.12, 0.9, 0.5, 0.51}) {
        const scenes::Moment moment = scenes::moment_at(scene, triangles.motion, seconds);
        for (passes::Frame* frame : {&basic, &carried}) frame->move_to(moment), frame->render(scene.cameras[0]);
        const auto image = engine::download(device, carried.beauty());
        EXPECT_TRUE(same(engine::download(device, basic.beauty()), image)) << seconds;
        EXPECT_EQ(basic.counters().maps->cut, carried.counters().maps->cut);
        if (!before.empty()) evaluated += carried.counters().maps->node_views, needed += basic.counters().maps->node_views;
        before = image;
    }
    EXPECT_LT(evaluated, needed / 3);
}

}  // namespace
}  // namespace myriad::tests
