// Whole frames that many point lights light: by maps, by gathered rays and by a ray a light; where they move, and where memory is short.
#include <cmath>
#include <numbers>

#include "engine/testing.hpp"
#include "passes/frame.hpp"
#include "scenes/moment.hpp"
#include "tests/frame_testing.hpp"
#include "tests/scene_kit.hpp"

namespace myriad::tests {
namespace {

using engine::same;
using glm::dvec3;
using passes::PointLighting, passes::Visibility;

class ParticlesFrameTest : public engine::DeviceTest {
protected:
    static passes::FrameSettings settings(Visibility visibility, uint32_t vpls = 0) {
        passes::FrameSettings s;
        s.width = 64, s.height = 48, s.vpls = vpls, s.subset = 0, s.visibility = visibility, s.log2_samples = 14;
        return s;
    }
    struct Result {
        std::vector<vec4> beauty, direct, indirect;
        passes::FrameCounters counters;
        bool gathered = false;
    };
    static Result render(engine::Device& on, const scenes::Scene& scene, const passes::FrameSettings& s) {
        scenes::Scene copy = scene;
        const scenes::Triangles triangles = scenes::flatten(copy);
        passes::Frame frame(on, copy, triangles, s);
        frame.render(copy.cameras[0]);
        return {engine::download(on, frame.beauty()), frame.direct() ? engine::download(on, *frame.direct()) : std::vector<vec4>{}, engine::download(on, frame.indirect()), frame.counters(),
                frame.point_lights() != nullptr};
    }
    Result render(const scenes::Scene& scene, const passes::FrameSettings& s) { return render(device, scene, s); }

    // A closed room with a block on its floor, and lights all over the air in it.
    Kit room(size_t lights, float radius = 0.02f) {
        Kit kit = Kit::room();
        kit.scene.lights.clear();
        for (size_t i = 0; i < lights; ++i) {
            std::uniform_real_distribution<float> unit(-0.9f, 0.9f);
            vec3 at(unit(random), unit(random), unit(random));
            while (at.x > -0.3f && at.x < 0.6f && at.y < 0.2f && at.z > -0.5f && at.z < 0.3f) at = {unit(random), unit(random), unit(random)};  // not in the block
            kit.point_light(at, vec3(1, 2, 3) / float(lights));
            kit.scene.lights.back().radius = radius;
        }
        return kit;
    }
};

// Each pixel's sum is the same whoever sums it up; without a radius nothing bounds it differently, and no ball is seen.
TEST_F(ParticlesFrameTest, gathered_rays_are_the_rays_of_direct_light) {
    const Kit kit = room(40, 0);
    passes::FrameSettings s = settings(Visibility::rays);
    const Result gathered = render(kit.scene, s);
    s.point_lights = PointLighting::direct;
    const Result direct = render(kit.scene, s);
    EXPECT_TRUE(gathered.gathered && !direct.gathered);
    EXPECT_EQ(*gathered.counters.point_lights, 40u);
    // Rays leave by reaches of their own, the scene's or the triangle's: at the very edge of a shadow they may part.
    size_t parted = 0;
    for (size_t i = 0; i < gathered.direct.size(); ++i) parted += !(glm::length(dvec3(gathered.direct[i]) - dvec3(direct.direct[i])) <= 1e-5 * glm::length(dvec3(direct.direct[i])));
    EXPECT_LT(parted, 6u) << "of " << gathered.direct.size();
    EXPECT_LT(difference(gathered.beauty, direct.beauty), 1e-3);
    for (const vec4& e : gathered.indirect) ASSERT_EQ(vec3(e), vec3(0)) << "it is direct light";
}

TEST_F(ParticlesFrameTest, few_lights_are_not_gathered_unless_asked_for) {
    for (size_t lights : {size_t(1), size_t(passes::most_direct_points), size_t(passes::most_direct_points) + 1}) {
        const Kit kit = room(lights);
        passes::FrameSettings s = settings(Visibility::rays);
        EXPECT_EQ(render(kit.scene, s).gathered, lights > passes::most_direct_points) << lights;
        s.visibility = Visibility::none;
        EXPECT_FALSE(render(kit.scene, s).gathered) << "shadows are not left out unasked";
        s.point_lights = PointLighting::gather;
        EXPECT_TRUE(render(kit.scene, s).gathered);
    }
    Kit kit = room(0);
    passes::FrameSettings s = settings(Visibility::manylods);
    s.point_lights = PointLighting::gather;
    const Result dark = render(kit.scene, s);
    EXPECT_TRUE(!dark.gathered && dark.direct.empty());
    // Spots and the sun stay as they are, and points among them leave only their own light.
    kit = room(40);
    const Result points = render(kit.scene, settings(Visibility::rays));
    kit.scene.lights.insert(kit.scene.lights.begin() + 7, {scenes::Light::Type::spot, "", {0.3f, 0.8f, 0}, {0, -1, 0}, vec3(2), 0.1f, 0.9f});
    const Result both = render(kit.scene, settings(Visibility::rays));
    kit.scene.lights = {kit.scene.lights[7]};
    const Result spot = render(kit.scene, settings(Visibility::rays));
    std::vector<vec4> sum = points.direct;
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += spot.direct[i];
    EXPECT_LT(difference(both.direct, sum), 1e-5);
    EXPECT_GT(difference(points.direct, sum), 0.01);
}

// All ways of drawing maps: what is left is their resolution, which is finer with larger maps. VPLs of the same lights are beside the point.
TEST_F(ParticlesFrameTest, maps_are_near_to_rays) {
    const Kit kit = room(300);
    passes::FrameSettings unshadowed = settings(Visibility::none);
    unshadowed.point_lights = PointLighting::gather;
    const Result rays = render(kit.scene, settings(Visibility::rays)), none = render(kit.scene, unshadowed);
    const double hidden = difference(none.direct, rays.direct);
    for (Visibility v : {Visibility::manylods, Visibility::megaviews, Visibility::brute, Visibility::ism}) {
        passes::FrameSettings s = settings(v);
        const Result maps = render(kit.scene, s);
        const double error = difference(maps.direct, rays.direct);
        std::printf("visibility %d: %.4f of the light is wrong; without shadows %.4f\n", int(v), error, hidden);
        EXPECT_LT(error, v == Visibility::ism ? 0.10 : 0.05) << int(v);
        EXPECT_LT(error, (v == Visibility::ism ? 0.9 : 0.5) * hidden) << int(v);  // few points, and holes
        EXPECT_TRUE(same(maps.beauty, render(kit.scene, s).beauty)) << int(v);
        for (const vec4& p : maps.beauty) ASSERT_TRUE(std::isfinite(p.x) && p.x >= 0);
        if (v != Visibility::megaviews) continue;
        s.maps.asks = true;  // shared maps as they are
        EXPECT_LT(difference(render(kit.scene, s).direct, rays.direct), 0.05);
        s.maps.asks = false, s.octree_levels = 7;
        const double by_octree = difference(render(kit.scene, s).direct, rays.direct);
        std::printf("the scene's octree: %.4f\n", by_octree);
        EXPECT_LT(by_octree, 0.05);
    }
}

TEST_F(ParticlesFrameTest, little_memory_makes_the_same_image) {
    const Kit kit = room(700);
    for (Visibility v : {Visibility::manylods, Visibility::megaviews}) {
        passes::FrameSettings s = settings(v, 256);
        const Result whole = render(kit.scene, s);
        engine::Device little({.select = "", .validation = true, .memory_limit = 24 << 20});
        const Result parts = render(little, kit.scene, s);
        EXPECT_GT(parts.counters.maps->batches, whole.counters.maps->batches) << int(v);
        EXPECT_TRUE(same(parts.beauty, whole.beauty)) << int(v);
        EXPECT_EQ(little.validation_messages(), 0u);
    }
}

// Blocks of pixels that gather subsets, filtered, have the mean of all; and bounced light is there beside it.
TEST_F(ParticlesFrameTest, subsets_and_bounces) {
    const Kit kit = room(1000, 0.2f);
    passes::FrameSettings s = settings(Visibility::megaviews, 512);
    const Result all = render(kit.scene, s);
    s.subset = 250;
    const Result subsets = render(kit.scene, s);
    EXPECT_LT(difference(subsets.direct, all.direct), 0.1);
    double direct = 0, indirect = 0;
    for (size_t i = 0; i < all.direct.size(); ++i) direct += double(all.direct[i].y), indirect += double(all.indirect[i].y);
    // A closed room of albedo 0.7, after one bounce.
    EXPECT_GT(indirect, 0.4 * direct);
    EXPECT_LT(indirect, 1.0 * direct);
}

// At a moment the image is that of lights that were put there; and again, bit by bit.
TEST_F(ParticlesFrameTest, lights_that_move_are_where_they_are) {
    Kit kit = room(200);
    scenes::Clip clip{.name = "up"};
    for (uint32_t i = 0; i < 200; ++i) {
        scenes::Light& light = kit.scene.lights[i];
        kit.scene.nodes.push_back({.rest = {.translation = dvec3(light.position)}});
        light.node = i;
        const vec3 p = light.position, q = p * vec3(-0.9f, 1, 1) + vec3(0, 0.05f, 0);
        clip.channels.push_back({i, i, scenes::Path::translation});
        clip.tracks.push_back({.width = 3, .times = {0, 1, 2}, .values = {p.x, p.y, p.z, q.x, q.y, q.z, p.x, p.y, p.z}});
    }
    kit.scene.clips = {clip};
    for (Visibility v : {Visibility::rays, Visibility::megaviews, Visibility::manylods}) {
        scenes::Scene scene = kit.scene;
        const scenes::Triangles triangles = scenes::flatten(scene, scenes::Sharing::automatic, {.clips = {0}});
        passes::FrameSettings s = settings(v);
        passes::Frame frame(device, scene, triangles, s);
        std::vector<std::vector<vec4>> images;
        for (double seconds : {0.0, 1.0, 0.0}) {
            frame.move_to(scenes::moment_at(scene, triangles.motion, seconds));
            frame.render(scene.cameras[0]);
            images.push_back(engine::download(device, frame.beauty()));
        }
        EXPECT_TRUE(same(images[0], images[2])) << int(v);
        EXPECT_GT(difference(images[0], images[1]), 0.02) << int(v);
        scenes::Scene moved = kit.scene;
        moved.lights = scenes::moment_at(scene, triangles.motion, 1).lights;
        EXPECT_TRUE(same(render(moved, s).beauty, images[1])) << int(v);
    }
}

// Lights in surfaces, at the eye, all in one place, and dark ones: finite, and what of it is in free air is lit.
TEST_F(ParticlesFrameTest, hard_lights) {
    Kit kit = room(0);
    for (int i = 0; i < 20; ++i) kit.point_light({0.1f * float(i) - 0.95f, -1, 0.6f}, vec3(1));             // on the floor
    for (int i = 0; i < 20; ++i) kit.point_light({-0.2f, -0.5f, 0}, vec3(1));                               // on the block's side, in one place
    for (int i = 0; i < 20; ++i) kit.point_light({1, 1, 1}, vec3(1));                                       // in a corner
    for (int i = 0; i < 20; ++i) kit.point_light(vec3(kit.scene.cameras[0].to_world[3]), vec3(0.5f));       // at the eye
    for (int i = 0; i < 20; ++i) kit.point_light({0.1f, -0.5f, -0.1f}, vec3(1));                            // inside the block
    for (int i = 0; i < 20; ++i) kit.point_light({0, 0.5f, 0}, vec3(0));                                    // dark
    for (auto& light : kit.scene.lights) light.radius = 0.01f;
    const Result rays = render(kit.scene, settings(Visibility::rays));
    for (Visibility v : {Visibility::manylods, Visibility::megaviews, Visibility::brute, Visibility::ism, Visibility::none}) {
        const Result maps = render(kit.scene, settings(v, 64));
        double light = 0;
        for (const vec4& p : maps.beauty) ASSERT_TRUE(std::isfinite(p.x + p.y + p.z) && p.x >= 0) << int(v);
        for (const vec4& p : maps.direct) light += double(p.x);
        EXPECT_GT(light, 0) << int(v);
        std::printf("visibility %d: %.3f off rays\n", int(v), difference(maps.direct, rays.direct));
    }
}

}  // namespace
}  // namespace myriad::tests
