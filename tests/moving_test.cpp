// Whole frames of scenes that move: at a moment they are those of a scene that was made so.

#include <glm/gtc/matrix_transform.hpp>

#include "compute/bsh/bsh_ref.hpp"
#include "engine/testing.hpp"
#include "engine/transfer.hpp"
#include "passes/frame.hpp"
#include "scenes/moment.hpp"
#include "tests/frame_testing.hpp"

namespace myriad::tests {
namespace {

using engine::same;
using glm::vec3;
using passes::Visibility;

scenes::Primitive box(const vec3& lo, const vec3& hi, uint32_t material, bool inside = false) {
    scenes::Primitive p;
    p.material = material;
    for (uint32_t i = 0; i < 8; ++i) p.positions.push_back({i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z});
    for (const auto& [a, b, c, d] : {std::array{0u, 4u, 6u, 2u}, {1u, 3u, 7u, 5u}, {0u, 1u, 5u, 4u}, {2u, 6u, 7u, 3u}, {0u, 2u, 3u, 1u}, {4u, 5u, 7u, 6u}})
        for (const uint32_t i : inside ? std::array{a, c, b, a, d, c} : std::array{a, b, c, a, c, d}) p.indices.push_back(i);
    return p;
}

// A closed room under a lit panel, a bar that bends and one that swells, a block that flies from wall to wall, and lamps.
scenes::Scene room(bool lamps) {
    scenes::Scene scene;
    scene.name = "test";
    for (const vec3& colour : {vec3(0.7f), vec3(0.7f, 0.3f, 0.2f), vec3(0.2f, 0.5f, 0.7f), vec3(0)}) {
        scenes::Material m;
        m.base_color = glm::vec4(colour, 1);
        m.metallic = 0;
        scene.materials.push_back(m);
    }
    scene.materials[3].emissive = vec3(6, 5, 4);
    scenes::Primitive panel;
    panel.material = 3;
    panel.positions = {{-1, 3.9f, -1}, {1, 3.9f, -1}, {1, 3.9f, 1}, {-1, 3.9f, 1}};
    panel.indices = {0, 1, 2, 0, 2, 3};
    scenes::Primitive bar = box({-0.3f, 0, -0.3f}, {0.3f, 3, 0.3f}, 1), swelling = box({1, 0.2f, 1}, {1.5f, 1, 1.5f}, 2);
    for (const vec3& p : bar.positions) {
        bar.joints[0].emplace_back(0, 1, 0, 0);
        bar.joint_weights[0].push_back(p.y > 1 ? glm::vec4(0.2f, 0.8f, 0, 0) : glm::vec4(1, 0, 0, 0));
    }
    swelling.targets = {{{}, {}}};
    for (const vec3& p : swelling.positions) swelling.targets[0].positions.push_back(0.8f * (p - vec3(1.25f, 0.2f, 1.25f)));
    scene.meshes = {{"room", {box({-3, 0, -3}, {3, 4, 3}, 0, true), panel}}, {"bar", {bar}}, {"swelling", {swelling}},
                    {"block", {box(vec3(-0.4f), vec3(0.4f), 2)}}};
    scene.nodes = {{.name = "low"}, {.name = "high", .parent = 0, .rest = {.translation = {0, 1.5, 0}}}, {.name = "bar"},
                   {.name = "swelling", .weights = {0}}, {.name = "block", .rest = {.translation = {-2.4, 1, -1}}}, {.name = "lamp"}};
    glm::mat4 inverse(1);
    inverse[3].y = -1.5f;
    scene.skins.push_back({"bar", {0, 1}, {glm::mat4(1), inverse}});
    scene.instances = {{0, glm::mat4(1)}, {1, glm::mat4(1), 2, 0}, {2, glm::mat4(1), 3}, {3, glm::translate(glm::mat4(1), vec3(-2.4f, 1, -1)), 4}};
    const float s = std::sin(0.5f), c = std::cos(0.5f);
    scene.clips = {{"all",
                    {{.width = 4, .times = {0, 1}, .values = {0, 0, 0, 1, 0, 0, s, c}},
                     {.width = 1, .times = {0, 1}, .values = {0, 1}},
                     {.width = 3, .times = {0, 1}, .values = {-2.4f, 1, -1, 2.4f, 2, -1.5f}},
                     {.width = 3, .times = {0, 1}, .values = {-1, 3, 2, 1, 2.5f, 2}}},
                    {{1, 0, scenes::Path::rotation}, {3, 1, scenes::Path::weights}, {4, 2, scenes::Path::translation}, {5, 3, scenes::Path::translation}}}};
    if (lamps) {
        scene.lights.push_back({.type = scenes::Light::Type::point, .position = {-1, 3, 2}, .intensity = vec3(9), .node = 5});
        scene.lights.push_back({.type = scenes::Light::Type::spot, .position = {0, 3.5f, 0}, .direction = {0, -1, 0}, .intensity = vec3(4)});
    }
    scene.cameras = {{"test", glm::mat4(glm::inverse(glm::lookAt(glm::dvec3(0, 2, 2.9), glm::dvec3(0, 1.6, 0), glm::dvec3(0, 1, 0)))), 1.2f}};
    return scene;
}

class MovingTest : public engine::DeviceTest {
protected:
    static passes::FrameSettings settings(Visibility visibility) {
        passes::FrameSettings s;
        s.width = 96, s.height = 72, s.vpls = 256, s.subset = 0, s.bounces = 2, s.visibility = visibility, s.log2_samples = 13;
        return s;
    }
    std::vector<vec4> image(const passes::Frame& frame) { return engine::download(device, frame.beauty()); }
    // Of a scene that was made so.
    std::vector<vec4> image_made_at(const scenes::Moment& moment, scenes::Scene scene, scenes::Triangles triangles, const passes::FrameSettings& s) {
        scenes::deform(triangles, moment);
        scene.lights = moment.lights;
        passes::Frame made(device, scene, triangles, s);
        made.render(scene.cameras[0]);
        return image(made);
    }
};

// What the camera and light's first rays see is to the bit that of a scene made so: exact rays know no tree. VPLs are those of the frame's own
// past, so their light is equal up to the order that they are summed in, whatever was rendered before; and to what another pattern brings.
TEST_F(MovingTest, with_rays_a_moment_is_the_scene_made_so) {
    scenes::Scene scene = room(true);
    const scenes::Triangles triangles = scenes::flatten(scene, scenes::Sharing::automatic, {{0}});
    ASSERT_GT(triangles.motion.count(), 0u);
    const passes::FrameSettings s = settings(Visibility::rays);
    passes::Frame frame(device, scene, triangles, s);
    for (const double seconds : {0.0, 0.4, 0.9, 0.0, 0.7}) {
        const scenes::Moment moment = scenes::moment_at(scene, triangles.motion, seconds);
        frame.move_to(moment);
        frame.render(scene.cameras[0]);
        EXPECT_FALSE(frame.moved());

        scenes::Scene lit = scene;
        lit.lights = moment.lights;
        scenes::Triangles then = triangles;
        scenes::deform(then, moment);
        passes::Frame made(device, lit, then, s), straight(device, scene, triangles, s);
        made.render(scene.cameras[0]);
        straight.move_to(moment);
        straight.render(scene.cameras[0]);
        const auto equal = [&](auto array) { return same(engine::download(device, array(frame)), engine::download(device, array(made))); };
        EXPECT_TRUE(equal([](const passes::Frame& f) -> auto& { return f.gbuffer().positions; })) << seconds;
        EXPECT_TRUE(equal([](const passes::Frame& f) -> auto& { return f.gbuffer().normals; })) << seconds;
        EXPECT_TRUE(equal([](const passes::Frame& f) -> auto& { return *f.direct(); })) << seconds;
        EXPECT_LT(difference(image(frame), image(straight)), 1e-5) << seconds;
        EXPECT_LT(difference(image(frame), image(made)), 0.1) << seconds;
        EXPECT_EQ(frame.counters().vpls, straight.counters().vpls);
    }
}

// With maps, up to what another topology changes; the refitted tree keeps all invariants.
TEST_F(MovingTest, with_maps_it_is_nearly_so) {
    scenes::Scene scene = room(true);
    const scenes::Triangles triangles = scenes::flatten(scene, scenes::Sharing::automatic, {{0}});
    const passes::FrameSettings s = settings(Visibility::manylods);
    passes::Frame frame(device, scene, triangles, s);
    frame.render(scene.cameras[0]);
    const auto start = image(frame);
    for (const double seconds : {0.3, 0.99, 0.0}) {
        const scenes::Moment moment = scenes::moment_at(scene, triangles.motion, seconds);
        frame.move_to(moment);
        EXPECT_TRUE(frame.moved());
        frame.render(scene.cameras[0]);
        const auto moved = image(frame);
        scenes::Triangles then = triangles;
        scenes::deform(then, moment);
        const compute::Bsh& tree = *frame.tree();
        EXPECT_EQ(compute::bsh_check(compute::bsh_download(device, tree),
                                     {engine::download(device, tree.samples()), then.positions, then.triangles, tree.sample_radius(), tree.sample_share()}), "");
        EXPECT_LT(difference(moved, image_made_at(moment, scene, triangles, s)), 0.08) << seconds;
        if (seconds == 0) EXPECT_LT(difference(moved, start), 1e-5);
        else EXPECT_GT(difference(moved, start), 0.15) << "not a test";
    }
}

// An octree is built anew of where things are.
TEST_F(MovingTest, an_octree_follows) {
    scenes::Scene scene = room(false);
    const scenes::Triangles triangles = scenes::flatten(scene, scenes::Sharing::automatic, {{0}});
    passes::FrameSettings s = settings(Visibility::megaviews);
    s.octree_levels = 6;
    passes::Frame frame(device, scene, triangles, s);
    frame.render(scene.cameras[0]);
    const auto start = image(frame);
    const uint64_t pairs = frame.size().octree.pairs;
    for (const double seconds : {0.3, 0.99, 0.0}) {
        const scenes::Moment moment = scenes::moment_at(scene, triangles.motion, seconds);
        frame.move_to(moment);
        frame.render(scene.cameras[0]);
        EXPECT_EQ(frame.size().octree.pairs == pairs, seconds == 0);
        EXPECT_EQ(std::ranges::count(frame.times(), "octree leaves", &engine::PassTime::name), 1);
        const auto moved = image(frame);
        EXPECT_LT(difference(moved, image_made_at(moment, scene, triangles, s)), 0.08) << seconds;
        if (seconds == 0) EXPECT_LT(difference(moved, start), 1e-5);
        else EXPECT_GT(difference(moved, start), 0.1) << "not a test";
        frame.render(scene.cameras[0]);
        EXPECT_EQ(std::ranges::count(frame.times(), "octree leaves", &engine::PassTime::name), 0) << "nothing has moved since";
    }
}

// A tree that has grown is built anew where that is asked for, in the frame after it was seen, and is as small as one made so.
TEST_F(MovingTest, trees_are_measured_and_built_anew) {
    scenes::Scene scene = room(false);
    const scenes::Triangles triangles = scenes::flatten(scene, scenes::Sharing::automatic, {{0}});
    for (const float rebuild : {std::numeric_limits<float>::infinity(), 1.0001f, 0.0f}) {
        passes::FrameSettings s = settings(Visibility::manylods);
        s.rebuild = rebuild;
        passes::Frame frame(device, scene, triangles, s);
        frame.move_to(scenes::moment_at(scene, triangles.motion, 0.9));
        frame.render(scene.cameras[0]);
        EXPECT_EQ(frame.tree()->rebuilds(), rebuild == 0 ? 1u : 0u);
        EXPECT_TRUE(rebuild == 0 || *frame.counters().tree_growth > 1.0001) << *frame.counters().tree_growth;
        const scenes::Moment moment = scenes::moment_at(scene, triangles.motion, 0.95);
        frame.move_to(moment);
        frame.render(scene.cameras[0]);
        EXPECT_EQ(frame.tree()->rebuilds(), rebuild == 0 ? 2u : rebuild < 2 ? 1u : 0u);
        EXPECT_GT(*frame.counters().tree_overlap, 0);
        scenes::Triangles then = triangles;
        scenes::deform(then, moment);
        const compute::Bsh& tree = *frame.tree();
        EXPECT_EQ(compute::bsh_check(compute::bsh_download(device, tree),
                                     {engine::download(device, tree.samples()), then.positions, then.triangles, tree.sample_radius(), tree.sample_share()}), "");
    }
}

// Lights alone: a scene that stands still has neither a deform pass nor a refit.
TEST_F(MovingTest, lights_move_alone) {
    scenes::Scene scene = room(true);
    const scenes::Triangles triangles = scenes::flatten(scene);
    ASSERT_EQ(triangles.motion.count(), 0u);
    passes::Frame frame(device, scene, triangles, settings(Visibility::rays));
    scenes::Moment moment{.lights = scene.lights};
    frame.move_to(moment);
    frame.render(scene.cameras[0]);
    const auto start = image(frame);
    moment.lights[0].position = {1, 1, 1};
    frame.move_to(moment);
    EXPECT_FALSE(frame.moved());
    frame.render(scene.cameras[0]);
    for (const engine::PassTime& time : frame.times()) EXPECT_TRUE(time.name != "deform" && !time.name.starts_with("refit")) << time.name;
    const auto moved = image(frame);
    scenes::Scene lit = scene;
    lit.lights = moment.lights;
    passes::Frame made(device, lit, triangles, settings(Visibility::rays));
    made.render(scene.cameras[0]);
    EXPECT_TRUE(same(engine::download(device, *frame.direct()), engine::download(device, *made.direct())));
    EXPECT_LT(difference(moved, image(made)), 0.1) << "another guide";
    EXPECT_GT(difference(moved, start), 0.1);
    frame.move_to({.lights = scene.lights});
    frame.render(scene.cameras[0]);
    EXPECT_LT(difference(image(frame), start), 1e-5);
}

// More VPLs than at first: paths are prepared anew, and said to be.
TEST_F(MovingTest, light_that_finds_more_is_not_lost) {
    scenes::Scene scene = room(false);
    scene.meshes[0].primitives[0].indices.resize(3 * 2);  // one wall, which the lamp is far from
    scene.materials[3].emissive = vec3(0);
    scene.lights.push_back({.type = scenes::Light::Type::point, .position = {20, 3, 2}, .intensity = vec3(9)});
    const scenes::Triangles triangles = scenes::flatten(scene);
    passes::Frame frame(device, scene, triangles, settings(Visibility::none));
    frame.render(scene.cameras[0]);
    EXPECT_FALSE(frame.counters().prepared);
    scenes::Moment moment{.lights = scene.lights};
    moment.lights[0].position = {-2.9f, 2, 0};
    frame.move_to(moment);
    frame.render(scene.cameras[0]);
    EXPECT_EQ(frame.counters().prepared, 1u);
    EXPECT_LE(frame.counters().vpls, 256u);
    frame.render(scene.cameras[0]);
    EXPECT_FALSE(frame.counters().prepared);
}

}  // namespace
}  // namespace myriad::tests
