// Scenes at a moment: skins, morph targets, rigid parts, lights and cameras, by positions worked out by hand.
#include "scenes/moment.hpp"

#include <cmath>
#include <cstring>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "engine/error.hpp"

namespace myriad::scenes {
namespace {

using glm::vec3;

void expect_near(const vec3& a, const vec3& b, float tolerance = 2e-6f) {
    EXPECT_LE(glm::length(a - b), tolerance) << a.x << " " << a.y << " " << a.z << " is not " << b.x << " " << b.y << " " << b.z;
}

Track rotation_z(double from, double to, float seconds) {
    Track track{.width = 4, .times = {0, seconds}};
    for (const double degrees : {from, to}) {
        const double half = glm::radians(degrees) / 2;
        track.values.insert(track.values.end(), {0, 0, float(std::sin(half)), float(std::cos(half))});
    }
    return track;
}

Scene with_material() {
    Scene scene;
    scene.name = "test";
    scene.materials.resize(1);
    return scene;
}

// A ladder of quads along Y, from y = 0 to 4, in the plane z = 0: the first joint at the origin, the second at y = 2. Vertices
// below 2 go with the first, those above with the second, those at 2 half with each.
Scene bar() {
    Scene scene = with_material();
    Primitive p;
    for (int y = 0; y <= 4; ++y)
        for (const float x : {-0.5f, 0.5f}) {
            p.positions.emplace_back(x, y, 0);
            p.normals.emplace_back(0, 0, 1);
            p.joints[0].emplace_back(0, 1, 0, 0);
            p.joint_weights[0].emplace_back(y < 2 ? 1 : y > 2 ? 0 : 0.5f, y < 2 ? 0 : y > 2 ? 1 : 0.5f, 0, 0);
        }
    for (uint32_t i = 0; i < 8; i += 2) p.indices.insert(p.indices.end(), {i, i + 1, i + 3, i, i + 3, i + 2});
    scene.meshes.push_back({"bar", {p}});
    scene.nodes = {{.name = "lower"}, {.name = "upper", .parent = 0, .rest = {.translation = {0, 2, 0}}}, {.name = "mesh"}};
    glm::mat4 inverse(1);
    inverse[3].y = -2;
    scene.skins.push_back({"skin", {0, 1}, {glm::mat4(1), inverse}});
    scene.instances.push_back({.mesh = 0, .node = 2, .skin = 0});
    scene.clips.push_back({"bend", {rotation_z(0, 90, 1)}, {{1, 0, Path::rotation}}});
    return scene;
}

// Two triangles apart from everything, that stand still.
void add_wall(Scene& scene) {
    Primitive p;
    p.positions = {{9, 0, 0}, {10, 0, 0}, {10, 1, 0}, {9, 1, 0}};
    p.normals.assign(4, {0, 0, 1});
    p.indices = {0, 1, 2, 0, 2, 3};
    scene.meshes.push_back({"wall", {p}});
    scene.instances.push_back({uint32_t(scene.meshes.size()) - 1, glm::mat4(1)});
}

TEST(Moment, ABarBendsByNinetyDegrees) {
    Scene scene = bar();
    Triangles t = flatten(scene, Sharing::automatic, {{0}, false});
    ASSERT_EQ(t.motion.count(), 10u);
    for (uint32_t i = 0; i < 10; ++i) expect_near(t.positions[i], scene.meshes[0].primitives[0].positions[i]);
    deform(t, moment_at(scene, t.motion, 1));
    // Above the joint a vertex (x, y) is turned about (0, 2): to (2 - y, 2 + x).
    for (const int y : {3, 4})
        for (const int side : {0, 1}) {
            const float x = side ? 0.5f : -0.5f;
            expect_near(t.positions[size_t(2 * y + side)], {2.0f - float(y), 2 + x, 0});
        }
    for (const int y : {0, 1}) expect_near(t.positions[size_t(2 * y)], {-0.5f, y, 0});
    // Half way between where the two joints take it: (x, 2) and (0, 2 + x).
    expect_near(t.positions[4], {-0.25f, 1.75f, 0});
    expect_near(t.positions[5], {0.25f, 2.25f, 0});
    for (const vec3& n : t.normals) expect_near(n, {0, 0, 1});
}

// The mesh's own node does not place a skinned mesh; the joints do.
TEST(Moment, ASkinnedMeshIsWhereItsJointsAre) {
    Scene scene = bar();
    scene.nodes[2].rest.translation = {100, 0, 0};
    scene.instances[0].to_world[3].x = 100;
    scene.nodes[0].rest.translation = {0, 0, 7};
    const Triangles rest = flatten(scene);
    EXPECT_FALSE(rest.motion.plays());
    EXPECT_EQ(rest.motion.count(), 0u) << "at rest it is posed once, for good";
    EXPECT_EQ(rest.positions.size(), 10u);
    expect_near(rest.positions[9], {0.5f, 4, 7});
}

TEST(Moment, TheTwinReproducesFlattenToTheBit) {
    Scene scene = bar();
    add_wall(scene);
    const Triangles t = flatten(scene, Sharing::automatic, {{0}});
    Triangles again = t;
    deform(again, moment_at(scene, t.motion, 0.7));
    EXPECT_NE(again.positions, t.positions);
    deform(again, moment_at(scene, t.motion, 0));
    EXPECT_EQ(again.positions, t.positions);
    EXPECT_EQ(again.normals, t.normals);
    // And a moment is the same whatever was asked before.
    const Moment a = moment_at(scene, t.motion, 0.3);
    moment_at(scene, t.motion, 5);
    const Moment b = moment_at(scene, t.motion, 0.3);
    EXPECT_EQ(std::memcmp(a.matrices.data(), b.matrices.data(), a.matrices.size() * sizeof(Affine)), 0);
}

TEST(Moment, WhatMovesComesLastAndTheRestNeverChanges) {
    Scene scene = bar();
    add_wall(scene);  // after the bar, yet stored before it
    Triangles t = flatten(scene, Sharing::automatic, {{0}});
    EXPECT_EQ(t.motion.first_vertex, 4u);
    EXPECT_EQ(t.motion.first_triangle, 2u);
    EXPECT_EQ(t.positions.size(), 4u + t.motion.count());
    const Triangles before = t;
    deform(t, moment_at(scene, t.motion, 0.5));
    for (size_t i = 0; i < 4; ++i) EXPECT_EQ(t.positions[i], before.positions[i]);
    EXPECT_EQ(t.triangles, before.triangles);
}

TEST(Moment, AStillScenePaysNothing) {
    Scene scene = with_material();
    add_wall(scene);
    const Triangles t = flatten(scene);
    EXPECT_TRUE(t.motion.vertices.empty() && t.motion.influences.empty() && t.motion.matrices.empty() && t.motion.deltas.empty());
    EXPECT_FALSE(t.motion.plays());
}

// Eight corners; one target draws the top up by 1, another spreads it by twice.
Scene cube() {
    Scene scene = with_material();
    Primitive p;
    p.targets.resize(2);
    for (int i = 0; i < 8; ++i) {
        const vec3 v(i & 1, (i >> 1) & 1, (i >> 2) & 1);
        p.positions.push_back(v);
        p.normals.push_back(glm::normalize(v - 0.5f));
        p.targets[0].positions.emplace_back(0, v.y, 0);
        p.targets[1].positions.push_back(v.y > 0 ? vec3(2 * v.x, 0, 2 * v.z) : vec3(0));
    }
    p.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6};
    scene.meshes.push_back({"cube", {p}});
    scene.nodes = {{.name = "cube", .rest = {.translation = {10, 0, 0}}, .weights = {0, 0}}};
    scene.instances.push_back({.mesh = 0, .node = 0});
    scene.instances[0].to_world[3].x = 10;
    scene.clips.push_back({"grow", {Track{.width = 2, .times = {0, 1}, .values = {0, 0, 1, 0.5f}}}, {{0, 0, Path::weights}}});
    return scene;
}

TEST(Moment, MorphTargetsAddUp) {
    Scene scene = cube();
    Triangles t = flatten(scene, Sharing::automatic, {{0}, false});
    EXPECT_EQ(t.motion.deltas.size(), 4u + 3u) << "only those that move something";
    deform(t, moment_at(scene, t.motion, 0.5));  // weights 0.5 and 0.25
    expect_near(t.positions[7], {10 + 1 + 0.5f, 1.5f, 1 + 0.5f});
    expect_near(t.positions[1], {11, 0, 0});
    deform(t, moment_at(scene, t.motion, 1));
    expect_near(t.positions[7], {10 + 2, 2, 2});
}

TEST(Moment, WeightsAtRestAreAppliedOnce) {
    Scene scene = cube();
    scene.nodes[0].weights = {1, 0};
    const Triangles t = flatten(scene);
    EXPECT_EQ(t.motion.count(), 0u);
    expect_near(t.positions[2], {10, 2, 0});
}

// Without normals in the file each triangle has its own, and they follow the shape: not what a matrix makes of the first ones.
TEST(Moment, FlatNormalsFollowTheShape) {
    Scene scene = with_material();
    Primitive p;
    p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    p.indices = {0, 1, 2};
    p.targets.resize(1);
    p.targets[0].positions = {{0, 0, 0}, {0, 0, 0}, {0, 0, 1}};
    scene.meshes.push_back({"leaf", {p}});
    scene.nodes = {{.weights = {0}}};
    scene.instances.push_back({.mesh = 0, .node = 0});
    scene.clips.push_back({"", {Track{.width = 1, .times = {0, 1}, .values = {0, 1}}}, {{0, 0, Path::weights}}});
    Triangles t = flatten(scene, Sharing::automatic, {{0}, false});
    expect_near(t.normals[0], {0, 0, 1});
    deform(t, moment_at(scene, t.motion, 1));
    for (const vec3& n : t.normals) expect_near(n, glm::normalize(vec3(0, -1, 1)));
}

// Under a scale of (1, 4, 1) the normal of the plane y = x leans the other way than the plane's own points.
TEST(Moment, NormalsGoByTheInverseTranspose) {
    Scene scene = with_material();
    Primitive p;
    p.positions = {{0, 0, 0}, {1, 1, 0}, {0, 0, -1}};
    p.normals.assign(3, glm::normalize(vec3(-1, 1, 0)));
    p.tangents.assign(3, glm::vec4(glm::normalize(vec3(1, 1, 0)), 1));
    p.indices = {0, 1, 2};
    scene.meshes.push_back({"plane", {p}});
    scene.nodes = {{.name = "plane"}};
    scene.instances.push_back({.mesh = 0, .node = 0});
    scene.clips.push_back({"", {Track{.width = 3, .times = {0, 1, 2}, .values = {1, 1, 1, 1, 4, 1, -1, 4, 1}}}, {{0, 0, Path::scale}}});
    Triangles t = flatten(scene, Sharing::automatic, {{0}, false});
    deform(t, moment_at(scene, t.motion, 1));
    expect_near(t.normals[0], glm::normalize(vec3(-4, 1, 0)));
    expect_near(vec3(t.tangents[0]), glm::normalize(vec3(1, 4, 0)));
    EXPECT_EQ(t.tangents[0].w, 1);
    deform(t, moment_at(scene, t.motion, 2));  // mirrored: the bitangent changes sides, the normal stays outside
    expect_near(t.normals[0], glm::normalize(vec3(4, 1, 0)));
    EXPECT_EQ(t.tangents[0].w, -1);
}

// Files say all kinds of things of which only the sign is meant.
TEST(Moment, SignsOfBitangentsAreSigns) {
    Scene scene = with_material();
    Primitive p;
    p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    p.normals.assign(3, {0, 0, 1});
    p.tangents = {glm::vec4(1, 0, 0, NAN), glm::vec4(1, 0, 0, -0.5f), glm::vec4(1, 0, 0, 3)};
    p.indices = {0, 1, 2};
    scene.meshes.push_back({"leaf", {p}});
    scene.nodes = {{.name = "leaf"}};
    scene.instances.push_back({.mesh = 0, .node = 0});
    scene.clips.push_back({"", {Track{.width = 3, .times = {0, 1}, .values = {0, 0, 0, 0, 0, 1}}}, {{0, 0, Path::translation}}});
    Triangles t = flatten(scene, Sharing::automatic, {{0}, false});
    const Triangles still = flatten(scene);
    ASSERT_EQ(t.motion.count(), 3u);
    ASSERT_EQ(still.tangents.size(), 3u);
    for (const double seconds : {0.0, 1.0}) {
        deform(t, moment_at(scene, t.motion, seconds));
        for (size_t i = 0; i < 3; ++i) {
            EXPECT_EQ(t.tangents[i].w, i == 1 ? -1 : 1) << i;
            EXPECT_EQ(t.tangents[i], still.tangents[i]) << i;
        }
    }
}

TEST(Moment, ChildrenMoveWithTheirParents) {
    Scene scene = with_material();
    add_wall(scene);
    scene.nodes = {{.name = "arm"}, {.name = "hand", .parent = 0, .rest = {.translation = {0, 3, 0}}}, {.name = "still"}};
    scene.instances[0].node = 1;
    scene.lights.push_back({.position = {0, 3, 0}, .node = 1});
    scene.cameras.push_back({.name = "eye", .node = 1});
    scene.lights.push_back({.type = Light::Type::directional, .node = none});
    scene.clips.push_back({"swing", {rotation_z(0, 90, 1)}, {{0, 0, Path::rotation}}});
    Triangles t = flatten(scene, Sharing::automatic, {{0}, false});
    EXPECT_EQ(t.motion.count(), 4u);
    const Moment moment = moment_at(scene, t.motion, 1);
    expect_near(moment.lights[0].position, {-3, 0, 0});
    expect_near(vec3(moment.cameras[0].to_world[3]), {-3, 0, 0});
    expect_near(vec3(moment.cameras[0].to_world[0]), {0, 1, 0});
    EXPECT_EQ(moment.lights[1].direction, scene.lights[1].direction);
    deform(t, moment);
    expect_near(t.positions[0], {-3, 9, 0}, 1e-5f);  // (9, 3, 0) about Z
    // Another clip that moves nothing of it leaves the mesh among what stands still.
    scene.clips.push_back({"other", {rotation_z(0, 90, 1)}, {{2, 0, Path::rotation}}});
    EXPECT_EQ(flatten(scene, Sharing::automatic, {{1}}).motion.count(), 0u);
}

TEST(Moment, ClipsLoopOrStop) {
    Scene scene = bar();
    const auto angle = [&](bool loop, double seconds) {
        const glm::dmat4 m = pose_at(scene, {{0}, loop}, seconds).worlds[1];
        return glm::degrees(std::atan2(m[0].y, m[0].x));
    };
    EXPECT_NEAR(angle(false, 5), 90, 1e-4);
    EXPECT_NEAR(angle(true, 5.5), 45, 1e-4);
    EXPECT_NEAR(angle(true, -0.25), 67.5, 1e-4);
    EXPECT_NEAR(angle(true, 1), 0, 1e-4) << "the end is the next beginning";
    EXPECT_NEAR(angle(true, 1e6 + 0.5), 45, 1e-4) << "days later too";
}

TEST(Moment, BoundsHoldAllThatPlays) {
    Scene scene = bar();
    // It goes away all the while: nowhere is it as far as at the end.
    scene.clips[0].tracks.push_back({.width = 3, .times = {0, 1}, .values = {0, 0, 0, 0, 0, 5}});
    scene.clips[0].channels.push_back({0, 1, Path::translation});
    for (const bool loop : {false, true}) {
        const Triangles t = flatten(scene, Sharing::automatic, {{0}, loop});
        EXPECT_NEAR(t.hi.z, 5, 1e-5) << loop;
        Triangles moved = t;
        const auto expect_within = [&](double s) {
            deform(moved, moment_at(scene, t.motion, s));
            for (const vec3& p : moved.positions)
                EXPECT_TRUE(glm::all(glm::lessThanEqual(t.lo - 1e-5f, p)) && glm::all(glm::lessThanEqual(p, t.hi + 1e-5f))) << s << (loop ? ", again and again" : "");
        };
        for (double s = 0; s <= 1; s += 0.0625) expect_within(s);
        expect_within(std::nextafter(1.0, 0.0));
    }
}

// Far from the origin a sum of weights that is 1 but for rounding is seen.
TEST(Moment, WeightsSumToOneToTheBit) {
    Scene scene = bar();
    scene.nodes[0].rest.translation = {0, 0, 1 << 20};
    for (auto& w : scene.meshes[0].primitives[0].joint_weights[0]) w = glm::vec4(0.1f, 0.9000001f, 0, 0);
    const Triangles t = flatten(scene);
    for (const vec3& p : t.positions) EXPECT_EQ(p.z, float(1 << 20));
}

TEST(Moment, VerticesThrownFarStayNumbers) {
    Scene scene = cube();
    for (auto& d : scene.meshes[0].primitives[0].targets[0].positions) d *= 3e9f;
    Triangles t = flatten(scene, Sharing::automatic, {{0}, false});
    deform(t, moment_at(scene, t.motion, 1));
    EXPECT_EQ(t.positions[7].y, farthest);
    for (const vec3& n : t.normals) EXPECT_NEAR(glm::length(n), 1, 1e-6);
}

TEST(Moment, WhatNothingCanBeComputedWithIsRefused) {
    Scene scene = bar();
    scene.clips[0].tracks.push_back({.width = 3, .times = {0, 1}, .values = {0, 0, 0, 0, 3e9f, 0}});
    scene.clips[0].channels.push_back({0, 1, Path::translation});
    const Triangles t = [&] {
        scene.clips[0].tracks[1].values[4] = 1;
        Triangles made = flatten(scene, Sharing::automatic, {{0}, false});
        scene.clips[0].tracks[1].values[4] = 3e9f;
        return made;
    }();
    EXPECT_THROW(moment_at(scene, t.motion, 1), InputError);
    EXPECT_NO_THROW(moment_at(scene, t.motion, 0.1));
}

TEST(Moment, ClipsAreFoundByNameOrIndex) {
    Scene scene = bar();
    scene.clips.push_back({"walk", {}, {}});
    EXPECT_EQ(pick_clips(scene, "walk").clips, std::vector<uint32_t>{1});
    EXPECT_EQ(pick_clips(scene, "0").clips, std::vector<uint32_t>{0});
    EXPECT_EQ(pick_clips(scene, "all").clips, (std::vector<uint32_t>{0, 1}));
    EXPECT_THROW(pick_clips(scene, "fly"), InputError);
    EXPECT_THROW(pick_clips(scene, "2"), InputError);
    EXPECT_THROW(pick_clips(with_material(), "0"), InputError);
}

TEST(Moment, WhatMovesIsNotShared) {
    Scene scene = with_material();
    add_wall(scene);
    scene.instances.push_back({0, glm::translate(glm::mat4(1), vec3(0, 2, 0))});
    scene.instances.push_back({0, glm::translate(glm::mat4(1), vec3(0, 4, 0)), 0});
    scene.nodes = {{.name = "lift", .rest = {.translation = {0, 4, 0}}}};
    scene.clips.push_back({"", {Track{.width = 3, .times = {0, 1}, .values = {0, 4, 0, 0, 9, 0}}}, {{0, 0, Path::translation}}});
    const Triangles t = flatten(scene, Sharing::always, {{0}, false});
    ASSERT_EQ(t.placements.size(), 3u);
    EXPECT_FALSE(t.placements[0].in_world);
    EXPECT_FALSE(t.placements[1].in_world);
    EXPECT_TRUE(t.placements[2].in_world);
    EXPECT_EQ(t.motion.first_triangle, t.placements[2].first_triangle);
    EXPECT_EQ(t.motion.first_vertex, 4u);
    EXPECT_EQ(t.count(), 6u);
}

}  // namespace
}  // namespace myriad::scenes
