// Whole frames whose camera sees points in place of rays.
#include <cmath>

#include "engine/testing.hpp"
#include "passes/frame.hpp"
#include "scenes/moment.hpp"
#include "tests/frame_testing.hpp"
#include "tests/scene_kit.hpp"

namespace myriad::tests {
namespace {

using engine::same;
using passes::Primary, passes::Visibility;

class PointsFrameTest : public engine::DeviceTest {
protected:
    static passes::FrameSettings settings(Primary primary, Visibility visibility = Visibility::manylods) {
        passes::FrameSettings s;
        s.width = 96, s.height = 72, s.vpls = 256, s.subset = 0, s.log2_samples = 13, s.visibility = visibility, s.primary = primary;
        return s;
    }
    struct Picture {
        std::vector<vec4> beauty, positions, albedo;
        passes::FrameCounters counters;
        passes::SceneSize size;
    };
    Picture take(passes::Frame& frame, const scenes::Camera& camera) {
        frame.render(camera);
        return {engine::download(device, frame.beauty()), engine::download(device, frame.gbuffer().positions), engine::download(device, frame.gbuffer().albedo),
                frame.counters(), frame.size()};
    }
    Picture render(const scenes::Scene& scene, const passes::FrameSettings& s, scenes::Sharing sharing = scenes::Sharing::automatic) {
        scenes::Scene copy = scene;
        const scenes::Triangles triangles = scenes::flatten(copy, sharing);
        passes::Frame frame(device, copy, triangles, s);
        return take(frame, scenes::pick_camera(copy, triangles, ""));
    }
    // The share of pixels that see another depth than they should.
    static double deep(const Picture& exact, const Picture& found) {
        double wrong = 0;
        for (size_t i = 0; i < exact.positions.size(); ++i)
            wrong += !(std::abs(exact.positions[i].w - found.positions[i].w) <= 1e-3f * exact.positions[i].w);
        return wrong / double(exact.positions.size());
    }
    static double difference(const Picture& exact, const Picture& found) { return tests::difference(found.beauty, exact.beauty); }
};

TEST_F(PointsFrameTest, a_room_looks_as_rays_see_it) {
    const Kit kit = Kit::room();
    for (const Visibility v : {Visibility::manylods, Visibility::rays, Visibility::none, Visibility::ism}) {
        const Picture exact = render(kit.scene, settings(Primary::rays, v)), found = render(kit.scene, settings(Primary::points, v));
        EXPECT_LT(deep(exact, found), 0.005) << int(v);
        EXPECT_LT(difference(exact, found), 0.1) << int(v);
        EXPECT_FALSE(exact.counters.points);
        ASSERT_TRUE(found.counters.points);
        EXPECT_GT(found.counters.points->drawn, 1000u);
        EXPECT_EQ(found.size.samples, 1u << 13);
        if (v == Visibility::rays) { EXPECT_EQ(exact.size.samples, 0u) << "no tree where nothing needs one"; }
    }
}

TEST_F(PointsFrameTest, the_same_bits_again_and_in_both_append_modes) {
    const Kit kit = Kit::room();
    passes::FrameSettings s = settings(Primary::points);
    s.primary_pixels = 2;
    const Picture first = render(kit.scene, s), again = render(kit.scene, s);
    s.maps.append = compute::AppendMode::atomic;
    const Picture atomic = render(kit.scene, s);
    EXPECT_TRUE(same(first.beauty, again.beauty));
    EXPECT_TRUE(same(first.beauty, atomic.beauty));
}

// Under a camera that moves, and goes back.
TEST_F(PointsFrameTest, cameras_come_and_go) {
    const Kit kit = Kit::room();
    scenes::Scene scene = kit.scene;
    const scenes::Triangles triangles = scenes::flatten(scene);
    passes::Frame frame(device, scene, triangles, settings(Primary::points));
    scenes::Camera other = scene.cameras[0];
    other.to_world[3] += glm::vec4(-0.3f, 0.2f, -0.2f, 0);
    const Picture first = take(frame, scene.cameras[0]), away = take(frame, other), back = take(frame, scene.cameras[0]);
    EXPECT_TRUE(same(first.positions, back.positions));
    EXPECT_FALSE(same(first.positions, away.positions));
}

// A block that flies through the room is seen where it is.
TEST_F(PointsFrameTest, what_moves_is_seen_where_it_is) {
    Kit kit;
    kit.material(vec3(0.7f));
    kit.box(0, vec3(-2), vec3(2));
    kit.point_light({0, 1.5f, 0}, vec3(5));
    kit.look({0.1f, 0.3f, 1.9f}, {0, 0, 0});
    scenes::Scene scene = kit.scene;
    Kit block;
    block.material(vec3(0.7f));
    block.box(0, vec3(-0.3f), vec3(0.3f));
    scene.meshes.push_back(block.scene.meshes[0]);
    scene.nodes = {{.name = "block"}};
    scene.instances.push_back({1, glm::mat4(1), 0});
    scene.clips = {{"flight", {{.width = 3, .times = {0, 1}, .values = {-1, 0, 0, 1, 0.5f, -0.5f}}}, {{0, 0, scenes::Path::translation}}}};
    const scenes::Triangles triangles = scenes::flatten(scene, scenes::Sharing::automatic, {{0}});
    ASSERT_GT(triangles.motion.count(), 0u);
    passes::Frame exact(device, scene, triangles, settings(Primary::rays));
    for (const bool rebuilds : {false, true}) {  // by refits, or a new tree at every move
        passes::FrameSettings s = settings(Primary::points);
        if (rebuilds) s.rebuild = 0;
        passes::Frame points(device, scene, triangles, s);
        Picture last;
        for (const double seconds : {0.0, 0.4, 1.0}) {
            const scenes::Moment moment = scenes::moment_at(scene, triangles.motion, seconds);
            exact.move_to(moment), points.move_to(moment);
            const Picture found = take(points, scene.cameras[0]);
            EXPECT_LT(deep(take(exact, scene.cameras[0]), found), 0.005) << seconds << rebuilds;
            if (!last.beauty.empty()) { EXPECT_GT(deep(last, found), 0.01) << seconds; }
            last = found;
        }
        EXPECT_EQ(points.tree()->rebuilds() > 0, rebuilds);
    }
}

// Meshes that instances share, one of them mirrored.
TEST_F(PointsFrameTest, shared_meshes_are_those_written_out) {
    Kit kit;
    kit.material(vec3(0.6f));
    for (int i = 0; i < 12; ++i) {
        const float a = float(i) * 0.5235988f;
        kit.triangle(0, {0, 0.8f, 0}, {std::cos(a), 0, std::sin(a)}, {std::cos(a + 0.5235988f), 0, std::sin(a + 0.5235988f)});
    }
    kit.point_light({0, 3, 2}, vec3(9));
    kit.look({0.5f, 2, 6}, {0, 0, 0});
    scenes::Scene scene = kit.scene;
    scene.instances.clear();
    for (int i = 0; i < 9; ++i) {
        glm::mat4 at = glm::translate(glm::mat4(1), vec3(2.2f * float(i % 3 - 1), 0, 2.2f * float(i / 3 - 1)));
        scene.instances.push_back({0, i % 2 ? glm::scale(at, vec3(-1, 1.3f, 1)) : at});
    }
    const Picture shared = render(scene, settings(Primary::points), scenes::Sharing::always), flat = render(scene, settings(Primary::points), scenes::Sharing::never);
    EXPECT_GT(shared.size.instances, 0u);
    EXPECT_TRUE(same(shared.positions, flat.positions));
    EXPECT_LT(deep(render(scene, settings(Primary::rays), scenes::Sharing::always), shared), 0.02);
}

TEST_F(PointsFrameTest, nothing_at_all) {
    Kit kit;
    kit.material(vec3(1));
    kit.look({0, 0, 1}, {0, 0, 0});
    for (const bool triangle : {false, true}) {
        if (triangle) kit.triangle(0, vec3(0.1f), vec3(0.1f), vec3(0.1f));  // without area
        for (const vec4& p : render(kit.scene, settings(Primary::points)).positions) EXPECT_EQ(p.w, 0);
    }
}

}  // namespace
}  // namespace myriad::tests
