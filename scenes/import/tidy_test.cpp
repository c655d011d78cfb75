// Every defect repaired and counted; normals where creases want them.
#include "scenes/import/tidy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace myriad::scenes {
namespace {

using glm::vec2;
using glm::vec3;
using glm::vec4;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

Scene scene_of(Primitive p) {
    Scene scene;
    scene.materials.push_back({.name = "clay"});
    scene.meshes.push_back({"m", {std::move(p)}});
    scene.instances.push_back({});
    return scene;
}

// A cube of 8 vertices and 12 triangles, faces outward.
Primitive cube() {
    Primitive p;
    for (int i = 0; i < 8; ++i) p.positions.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    for (const auto& [a, b, c, d] : {std::array{0u, 4u, 6u, 2u}, {1u, 3u, 7u, 5u}, {0u, 1u, 5u, 4u}, {2u, 6u, 7u, 3u}, {0u, 2u, 3u, 1u}, {4u, 5u, 7u, 6u}})
        p.indices.insert(p.indices.end(), {a, b, c, a, c, d});
    return p;
}

bool says(const Scene& scene, const std::string& part) {
    return std::ranges::any_of(scene.warnings, [&](const std::string& w) { return w.find(part) != std::string::npos; });
}

TEST(Tidy, SharpEdgesStaySharp) {
    Primitive p = cube();
    smooth_normals(p, 40);
    ASSERT_EQ(p.positions.size(), 24u);  // three a corner
    for (size_t t = 0; t < p.indices.size(); t += 3)
        for (int k = 0; k < 3; ++k) {
            const vec3 n = p.normals[p.indices[t + k]];
            EXPECT_EQ(glm::dot(n, n), 1);
            EXPECT_EQ(glm::dot(n, p.positions[p.indices[t + k]]), 1);  // along the axis, outward
        }
}

TEST(Tidy, SmoothEdgesShareVertices) {
    Primitive p = cube();
    smooth_normals(p, 91);
    ASSERT_EQ(p.positions.size(), 8u);
    for (size_t i = 0; i < 8; ++i)  // by angle, so that a face of two triangles counts no more than one of one
        EXPECT_LE(glm::length(p.normals[i] - p.positions[i] / std::sqrt(3.0f)), 1e-6f);
}

TEST(Tidy, VerticesAtOnePlaceAreOnePoint) {
    Primitive p = cube(), soup;
    for (uint32_t i : p.indices) soup.indices.push_back(uint32_t(soup.positions.size())), soup.positions.push_back(p.positions[i]);
    soup.positions[0].x = soup.positions[0].x == 0 ? -0.0f : soup.positions[0].x;
    smooth_normals(soup, 91);
    ASSERT_EQ(soup.positions.size(), 36u);
    for (size_t i = 0; i < 36; ++i) EXPECT_LE(glm::length(soup.normals[i] - soup.positions[i] / std::sqrt(3.0f)), 1e-6f);
}

// A fold along which both sides run in the same direction (one is turned over): two sides, not one mean of opposites.
TEST(Tidy, TurnedNeighboursAreNotAveraged) {
    Primitive p;
    p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
    p.indices = {0, 1, 2, 0, 1, 3};
    smooth_normals(p, 60);
    for (const vec3& n : p.normals) EXPECT_EQ(std::abs(n.z), 1);
}

TEST(Tidy, AnEdgeOfManyTrianglesAndAFan) {
    Primitive p;
    p.positions = {{0, 0, 0}, {0, 0, 1}};
    for (int i = 0; i < 100000; ++i) {  // pages of a book: quadratic work would show
        p.positions.emplace_back(std::cos(0.01f * float(i)), std::sin(0.01f * float(i)), 0.5f);
        p.indices.insert(p.indices.end(), {0, 1, uint32_t(i + 2)});
    }
    smooth_normals(p, 30);
    EXPECT_EQ(p.normals.size(), p.positions.size());
    for (const vec3& n : p.normals) ASSERT_NEAR(glm::length(n), 1, 1e-6f);
}

TEST(Tidy, TrianglesThatAreNone) {
    Primitive p = cube();
    p.positions.push_back({nan, 0, 0});
    p.positions.push_back({3, 3, 3});  // on the line from 0 to 7: no area
    p.positions.push_back({9, 9, 9});  // used by nothing
    p.colors.assign(11, vec4(1));
    p.colors[10] = vec4(nan);
    p.indices.insert(p.indices.end(), {0, 1, 8, 0, 7, 9, 2, 2, 3});
    Scene scene = scene_of(p);
    tidy(scene, 0);
    const Primitive& out = scene.meshes[0].primitives[0];
    EXPECT_EQ(out.indices.size(), 36u);
    EXPECT_EQ(out.positions.size(), 8u);
    EXPECT_EQ(out.colors.size(), 8u);
    EXPECT_TRUE(says(scene, "1 triangles with a corner that is not finite"));
    EXPECT_TRUE(says(scene, "2 triangles without area"));
    EXPECT_EQ(scene.warnings.size(), 2u);
}

TEST(Tidy, AttributesThatAreNone) {
    Primitive p;
    p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    p.indices = {0, 1, 2};
    p.normals = {{0, 0, 0}, {nan, 0, 0}, {0, 0, 1e-3f}};
    p.tangents = {vec4(2, 0, 0, 0.5f), vec4(1, 0, 0, -3), vec4(1, 0, 0, 1)};
    p.texcoords = {{nan, 0}, {1, 0}, {0, 1}};
    p.colors = {vec4(2), vec4(nan), vec4(-1)};
    Scene scene = scene_of(p);
    tidy(scene, 0);
    const Primitive& out = scene.meshes[0].primitives[0];
    for (const vec3& n : out.normals) EXPECT_EQ(n, vec3(0, 0, 1));
    EXPECT_EQ(out.tangents, (std::vector{vec4(1, 0, 0, 1), vec4(1, 0, 0, -1), vec4(1, 0, 0, 1)}));
    EXPECT_EQ(out.texcoords[0], vec2(0));
    EXPECT_EQ(out.colors, (std::vector{vec4(1), vec4(1), vec4(0)}));
    EXPECT_TRUE(says(scene, "2 zero or non-finite normals"));
    EXPECT_TRUE(says(scene, "1 texture coordinates"));
    EXPECT_TRUE(says(scene, "1 vertex colours"));
    p.tangents[1] = vec4(0);
    scene = scene_of(p);
    tidy(scene, 0);
    EXPECT_TRUE(scene.meshes[0].primitives[0].tangents.empty());
}

TEST(Tidy, WhatNothingUsesGoes) {
    Scene scene = scene_of(cube());
    scene.meshes.insert(scene.meshes.begin(), {"unused", {cube()}});
    scene.meshes.push_back({"bad", {{.positions = {{nan, 0, 0}}, .indices = {0, 0, 0}}}});
    scene.materials = {{.name = "a"}, {.name = "b"}, {.name = "c"}};
    scene.materials[0].base_color_texture.texture = 0;
    scene.materials[2].emissive_texture.texture = 2;
    for (const char* name : {"0", "1", "2"}) scene.textures.push_back({.name = name, .width = 1, .height = 1, .rgba = {1, 2, 3, 4}});
    scene.meshes[1].primitives[0].material = 2;
    scene.instances = {{1, glm::mat4(nan)}, {1}, {2}};
    scene.instances.push_back({1, glm::mat4(1)});
    scene.instances.back().to_world[0][3] = 1;  // a perspective part
    tidy(scene, 0);
    ASSERT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.meshes[0].name, "m");
    ASSERT_EQ(scene.instances.size(), 1u);
    EXPECT_EQ(scene.instances[0].mesh, 0u);
    ASSERT_EQ(scene.materials.size(), 1u);
    EXPECT_EQ(scene.materials[0].name, "c");
    EXPECT_EQ(scene.meshes[0].primitives[0].material, 0u);
    ASSERT_EQ(scene.textures.size(), 1u);
    EXPECT_EQ(scene.textures[0].name, "2");
    EXPECT_EQ(scene.materials[0].emissive_texture.texture, 0u);
    EXPECT_TRUE(says(scene, "2 instances"));

    scene.instances.clear();
    tidy(scene, 0);
    EXPECT_TRUE(scene.meshes.empty());
    EXPECT_EQ(scene.materials.size(), 1u);  // never none
}

TEST(Tidy, TransformMovesCamerasAndLights) {
    Scene scene = scene_of(cube());
    scene.cameras.push_back({"eye", glm::translate(glm::mat4(1), vec3(1, 2, 3))});
    scene.lights.push_back({.position = {1, 2, 3}, .direction = {0, 0, -1}, .intensity = vec3(7)});
    const glm::dmat4 z_up = glm::rotate(glm::dmat4(1), glm::radians(-90.0), glm::dvec3(1, 0, 0));
    transform(scene, z_up, 0.5);
    EXPECT_LE(glm::length(vec3(scene.instances[0].to_world * vec4(0, 0, 2, 1)) - vec3(0, 1, 0)), 1e-6f);
    EXPECT_LE(glm::length(vec3(scene.cameras[0].to_world[3]) - vec3(0.5f, 1.5f, -1)), 1e-6f);
    EXPECT_LE(glm::length(vec3(scene.cameras[0].to_world[2]) - vec3(0, 1, 0)), 1e-6f);  // unit: no scale in a camera
    EXPECT_LE(glm::length(scene.lights[0].position - vec3(0.5f, 1.5f, -1)), 1e-6f);
    EXPECT_LE(glm::length(scene.lights[0].direction - vec3(0, -1, 0)), 1e-6f);
    EXPECT_EQ(scene.lights[0].intensity, vec3(7));
}

}  // namespace
}  // namespace myriad::scenes
