// What the writer writes comes back as the same scene.
#include "scenes/gltf/write.hpp"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <unistd.h>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/error.hpp"
#include "scenes/builtin/kit.hpp"
#include "scenes/gltf/rotation_scale.hpp"
#include "scenes/scene_compare.hpp"

namespace myriad::scenes {
namespace {

using glm::mat4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using nlohmann::json;

// Written, and read back. MYRIAD_KEEP_GLB=FOLDER keeps the files, for other programs to judge.
Scene round_trip(const Scene& scene) {
    static int count = 0;
    const char* keep = std::getenv("MYRIAD_KEEP_GLB");
    const auto folder = keep ? std::filesystem::path(keep) : std::filesystem::temp_directory_path();
    const auto path = folder / ("myriad_write_" + std::to_string(::getpid()) + "_" + std::to_string(count++) + ".glb");
    std::ofstream(path, std::ios::binary) << glb_bytes(scene);
    const Scene back = load(path.string());
    if (!keep) std::filesystem::remove(path);
    return back;
}

json document(const std::string& glb) {
    uint32_t size = 0;
    std::memcpy(&size, &glb[12], 4);
    return json::parse(glb.substr(20, size));
}

std::string refused(const Scene& scene) {
    try {
        glb_bytes(scene);
    } catch (const InputError& e) {
        const std::string message = e.what();
        EXPECT_EQ(message.find("given.obj: "), 0u) << message;
        EXPECT_EQ(message.back(), '.') << message;
        return message;
    }
    return "(written)";
}

// One triangle with one material.
Scene triangle() {
    Scene scene;
    scene.name = "given.obj";
    scene.materials.push_back({.name = "clay"});
    scene.meshes.push_back({"tri", {{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .indices = {0, 1, 2}}}});
    scene.instances.push_back({});
    return scene;
}

void expect_round_trip(const Scene& scene) {
    const Scene back = round_trip(scene);
    EXPECT_EQ(difference(scene, back), "");
    EXPECT_TRUE(back.warnings.empty()) << back.warnings.front();
    EXPECT_TRUE(glb_bytes(scene) == glb_bytes(scene)) << "two runs wrote different bytes";
}

TEST(GltfWriter, BuiltInScenesComeBack) {
    for (const char* name : {"builtin:cornell", "builtin:cornell?light=panel", "builtin:atrium"}) {
        SCOPED_TRACE(name);
        expect_round_trip(load(name));
    }
}

TEST(GltfWriter, AScene) {
    Scene scene = triangle();
    scene.meshes.push_back({"two", {scene.meshes[0].primitives[0], scene.meshes[0].primitives[0]}});
    Primitive& p = scene.meshes[1].primitives[1];
    p.normals = {{0, 0, 1}, {0, 0, 1}, {0.6f, 0, 0.8f}};
    p.texcoords = {{0, 0}, {1, -2.5f}, {0.1f, 1e-20f}};
    p.material = 1;
    scene.materials.push_back({.name = "glow", .base_color = {0.1f, 0.2f, 0.3f, 1}, .metallic = 0.7f, .roughness = 0.3f,
                               .emissive = {31.7f, 0.1f, 1e-4f}, .double_sided = true});
    scene.instances.push_back({1, glm::translate(mat4(1), vec3(0.1f, 20, -3)) * glm::rotate(mat4(1), 0.3f, vec3(1, 2, 3))});
    scene.instances.push_back({1, glm::scale(mat4(1), vec3(-1, 2, 3e-3f))});  // shares the mesh, and mirrors it
    scene.cameras.push_back({"eye", glm::inverse(glm::lookAt(vec3(3, 4, 5), vec3(0), vec3(0, 1, 0))), 0.7f});
    scene.lights.push_back({.name = "bulb", .position = {0.1f, 2, 3}, .intensity = {10, 20, 30}});
    scene.lights.push_back({.type = Light::Type::spot, .name = "lamp", .position = {1, 2, 3}, .direction = {0.6f, -0.8f, 0},
                            .intensity = {1, 1, 0}, .inner_cone = 0.1f, .outer_cone = 0.5f});
    scene.lights.push_back({.type = Light::Type::directional, .name = "sun", .direction = {0, 0, 1}, .intensity = vec3(5)});
    scene.lights.push_back({.name = "broken bulb"});
    scene.background = {0.1f, 0, 12};
    expect_round_trip(scene);
    EXPECT_EQ(document(glb_bytes(scene))["meshes"].size(), 2u);
}

TEST(GltfWriter, TexturesComeBackToTheByte) {
    Scene scene = triangle();
    for (int t = 0; t < 3; ++t) {
        Texture texture{.name = "t" + std::to_string(t), .width = 5, .height = 3, .rgba = std::vector<uint8_t>(60)};
        for (size_t i = 0; i < 60; ++i) texture.rgba[i] = i % 4 == 3 && t != 1 ? 255 : uint8_t(37 * i + unsigned(t));
        scene.textures.push_back(texture);
    }
    scene.textures[1].wrap_u = Texture::Wrap::clamp;
    scene.textures[2].wrap_v = Texture::Wrap::mirror;
    Material& m = scene.materials[0];
    m.base_color_texture.texture = 0, m.metallic_roughness_texture.texture = 1, m.emissive_texture.texture = 2;
    m.emissive = vec3(1);
    scene.meshes[0].primitives[0].texcoords = {{0, 0}, {1, 0}, {0, 1}};
    expect_round_trip(scene);
    EXPECT_EQ(difference(round_trip(scene), scene), "");
    const json doc = document(glb_bytes(scene));
    EXPECT_EQ(doc["samplers"].size(), 3u);
    EXPECT_EQ(document(glb_bytes(scene, {.quick = true}))["images"], doc["images"]);
}

// The document is checked besides what comes back, for writer and loader could agree on an error.
TEST(GltfWriter, Extensions) {
    Scene scene = triangle();
    scene.textures.push_back({.width = 1, .height = 1, .rgba = {1, 2, 3, 4}});
    Material& m = scene.materials[0];
    m.unlit = true;
    m.alpha = Material::Alpha::mask;
    m.alpha_cutoff = 0.25f;
    m.emissive = vec3(6, 3, 0);
    m.base_color_texture = {0, 1, glm::mat3x2(2, 0, 0, -3, 0.5f, 0.1f)};
    const float c = std::cos(0.3f), s = std::sin(0.3f);
    m.normal_texture = {0, 0, glm::mat3x2(2 * c, -2 * s, 3 * s, 3 * c, 0, 0)};
    m.normal_scale = 0.5f;
    scene.meshes[0].primitives[0].texcoords1 = {{0, 0}, {1, 0}, {0, 1}};
    scene.meshes[0].primitives[0].colors = {vec4(1), vec4(0.5f), vec4(0)};
    const json doc = document(glb_bytes(scene));
    const json& out = doc["materials"][0];
    EXPECT_EQ(doc["extensionsUsed"], json({"KHR_materials_emissive_strength", "KHR_materials_unlit", "KHR_texture_transform"}));
    EXPECT_EQ(out["alphaMode"], "MASK");
    EXPECT_EQ(out["alphaCutoff"], 0.25);
    EXPECT_EQ(out["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"], 8);
    EXPECT_EQ(out["emissiveFactor"], json({0.75, 0.375, 0}));
    const json& base = out["pbrMetallicRoughness"]["baseColorTexture"];
    EXPECT_EQ(base["texCoord"], 1);
    EXPECT_EQ(base["extensions"]["KHR_texture_transform"], json({{"offset", {0.5, 0.1}}, {"scale", {2, -3}}}));
    const json& normal = out["normalTexture"];
    EXPECT_EQ(normal["scale"], 0.5);
    EXPECT_NEAR(normal["extensions"]["KHR_texture_transform"]["rotation"].get<double>(), 0.3, 1e-6);
    EXPECT_NEAR(normal["extensions"]["KHR_texture_transform"]["scale"][1].get<double>(), 3, 1e-6);
    const json& attributes = doc["meshes"][0]["primitives"][0]["attributes"];
    for (const char* name : {"POSITION", "TEXCOORD_0", "TEXCOORD_1", "COLOR_0"}) EXPECT_TRUE(attributes.contains(name)) << name;
    // Set 0 was zeros and is there now; for the rest the scene comes back.
    scene.meshes[0].primitives[0].texcoords.assign(3, vec2(0));
    EXPECT_TRUE(round_trip(scene).materials[0].unlit);
    m.unlit = false;  // of an unlit material the loader takes the base colour only
    expect_round_trip(scene);
    m.alpha = Material::Alpha::blend;
    EXPECT_EQ(document(glb_bytes(scene))["materials"][0]["alphaMode"], "BLEND");
}

TEST(GltfWriter, WideIndices) {
    Scene scene = triangle();
    Primitive& p = scene.meshes[0].primitives[0];
    p = {};
    for (uint32_t i = 0; i < 65535; ++i) p.positions.emplace_back(i, i % 7, i % 3), p.indices.push_back(i);
    EXPECT_EQ(document(glb_bytes(scene))["accessors"][1]["componentType"], 5123);
    expect_round_trip(scene);
    p.positions.resize(65538, vec3(1)), p.indices.insert(p.indices.end(), {65535, 65536, 65537});
    EXPECT_EQ(document(glb_bytes(scene))["accessors"][1]["componentType"], 5125);
    expect_round_trip(scene);
}

TEST(GltfWriter, ShearedAndFlatTransforms) {
    Scene scene = triangle();
    kit::Random random(7);
    for (int i = 0; i < 200; ++i) {
        mat4 m(1);
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 3; ++r) m[c][r] = random.real(-2, 2);
        if (i % 4 == 1) m[2] = m[0] + 2.0f * m[1];     // flat
        if (i % 4 == 2) m[2] = m[1] = m[0];            // a line
        if (i % 4 == 3) m[0] *= 1e-4f, m[1] *= 1e4f;
        if (i == 5) m = mat4(0), m[3][3] = 1;          // a point
        scene.instances.push_back({0, m});
    }
    const Scene back = round_trip(scene);
    ASSERT_EQ(back.instances.size(), scene.instances.size());
    for (size_t i = 0; i < scene.instances.size(); ++i) {
        const mat4 &a = scene.instances[i].to_world, &b = back.instances[i].to_world;
        float size = 0, error = 0;
        for (int c = 0; c < 3; ++c) size += glm::length(a[c]), error += glm::length(a[c] - b[c]);
        EXPECT_LE(error, 2e-6f * size) << i;
        EXPECT_EQ(a[3], b[3]) << i;
    }
}

TEST(GltfWriter, LightsAimEverywhere) {
    kit::Random random(3);
    for (int i = 0; i < 1000; ++i) {
        glm::dvec3 d(random.real(-1, 1), random.real(-1, 1), random.real(-1, 1));
        if (i < 100) d *= glm::dvec3(1e-7, 1e-4, i % 2 ? 1 : -1);
        d = i == 0 ? glm::dvec3(0, 0, 1) : i == 1 ? glm::dvec3(0, 0, -1) : glm::normalize(d);
        const glm::dvec3 turned = gltf::aim(d) * glm::dvec3(0, 0, -1);
        EXPECT_LE(glm::length(turned - d), 1e-14) << i;
    }
}

TEST(GltfWriter, WhatIsEmptyIsLeftOut) {
    Scene scene = triangle();
    scene.meshes.insert(scene.meshes.begin(), Mesh{"nothing", {}});
    scene.meshes.push_back({"hollow", {{.positions = {{0, 0, 0}}}}});
    scene.instances = {{0}, {1}, {2}};
    const Scene back = round_trip(scene);
    ASSERT_EQ(back.instances.size(), 1u);
    EXPECT_EQ(back.meshes[back.instances[0].mesh].name, "tri");

    const Scene nothing = round_trip(Scene{.name = "given.obj", .materials = {{}}});
    EXPECT_TRUE(nothing.instances.empty());
    EXPECT_FALSE(document(glb_bytes(Scene{})).contains("buffers"));
}

TEST(GltfWriter, NamesThatAreNoText) {
    Scene scene = triangle();
    scene.meshes[0].name = "caf\xe9 \"\n";
    EXPECT_EQ(round_trip(scene).meshes[0].name, "caf\xef\xbf\xbd \"\n");
}

TEST(GltfWriter, RefusesWhatGltfCannotHold) {
    const float nan = std::nanf("");
    const auto with = [](auto change) {
        Scene scene = triangle();
        change(scene);
        return refused(scene);
    };
    EXPECT_NE(with([&](Scene& s) { s.meshes[0].primitives[0].positions[1].y = nan; }).find("mesh \"tri\""), std::string::npos);
    EXPECT_NE(with([&](Scene& s) { s.instances[0].to_world[1][1] = nan; }).find("not finite"), std::string::npos);
    EXPECT_NE(with([&](Scene& s) { s.instances[0].to_world[1][3] = 1; }).find("perspective"), std::string::npos);
    EXPECT_NE(with([&](Scene& s) { s.materials[0].roughness = INFINITY; }).find("material \"clay\""), std::string::npos);
    EXPECT_NE(with([&](Scene& s) { s.lights.push_back({.intensity = {-1, 0, 0}}); }).find("negative"), std::string::npos);
    EXPECT_NE(with([&](Scene& s) { s.cameras.push_back({.yfov = 4}); }).find("camera"), std::string::npos);
    EXPECT_NE(with([&](Scene& s) {
                  s.textures.push_back({.width = 1, .height = 1, .rgba = {1, 2, 3, 4}});
                  s.materials[0].base_color_texture = {0, 0, glm::mat3x2(1, 0, 0.5f, 1, 0, 0)};
              }).find("shears"), std::string::npos);
    EXPECT_NE(with([&](Scene& s) { s.background.y = -1; }).find("background"), std::string::npos);
    EXPECT_NE(with([&](Scene& s) { s.background.y = nan; }).find("background"), std::string::npos);
    EXPECT_NE(with([&](Scene& s) { s.textures.push_back({}); }).find("no pixels"), std::string::npos);
}

}  // namespace
}  // namespace myriad::scenes
