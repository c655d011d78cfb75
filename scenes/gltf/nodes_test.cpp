// Several scenes and cameras, and EXT_mesh_gpu_instancing.
#include <cmath>

#include "scenes/gltf_kit.hpp"

namespace myriad::scenes {
namespace {

vec3 place_of(const Instance& instance) { return vec3(instance.to_world[3]); }

// Where an instance takes the x axis of its mesh.
vec3 x_axis(const Instance& instance) { return vec3(instance.to_world * glm::vec4(1, 0, 0, 0)); }

TEST_F(Gltf, OneOfSeveralScenes) {
    square();
    doc["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"translation", {1, 0, 0}}}, {{"mesh", 0}, {"translation", {2, 0, 0}}}};
    doc["scenes"] = {{{"name", "day"}, {"nodes", {0}}}, {{"name", "night"}, {"nodes", {1}}}, {{"name", "0"}, {"nodes", {1, 2}}}};
    doc["scene"] = 1;
    const std::string path = write();
    const auto first_x = [&](const std::string& choice) { return place_of(load(path + choice).instances.at(0)).x; };
    EXPECT_EQ(first_x(""), 1);
    EXPECT_EQ(first_x("#day"), 0);
    EXPECT_EQ(first_x("#night"), 1);
    EXPECT_EQ(load(path + "#2").instances.size(), 2u);
    EXPECT_EQ(load(path + "#0").instances.size(), 2u);  // a name wins over an index
    for (const char* bad : {"#dusk", "#3", "#-1", "#"}) {
        if (bad == std::string("#")) EXPECT_EQ(first_x(bad), 1);  // no choice
        else {
            try {
                load(path + bad);
                ADD_FAILURE() << bad;
            } catch (const InputError& e) {
                for (const char* word : {"day", "night", "choose one"}) EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
            }
        }
    }
    doc.erase("scene");
    EXPECT_EQ(place_of(read().instances.at(0)).x, 0);  // the first where there is no default
    doc.erase("scenes");
    EXPECT_EQ(read().instances.size(), 3u);
    const auto message = [&] {
        try {
            load(path + "#0");
        } catch (const InputError& e) {
            return std::string(e.what());
        }
        return std::string("(accepted)");
    };
    EXPECT_NE(message().find("the file has none"), std::string::npos) << message();
}

TEST_F(Gltf, ABackgroundIsThreeNumbers) {
    square();
    EXPECT_EQ(read().background, vec3(0));
    json& extras = doc["scenes"][0]["extras"];
    extras = {{"myriad_background", {0.5, 0, 3}}, {"other", 1}};
    EXPECT_EQ(read().background, vec3(0.5f, 0, 3));
    for (const json& bad : {json(1), json({1, 2}), json({1, 2, -1}), json({1, 2, "3"}), json({1, 2, 1e30}), json({{"r", 1}}), json({1, 2, 3, 4})}) {
        extras["myriad_background"] = bad;
        EXPECT_NE(refused(write()).find("scene 0: myriad_background is not three numbers"), std::string::npos) << bad;
    }
}

TEST_F(Gltf, AFileWithAHashInItsName) {
    square();
    const std::filesystem::path path = folder / "take#1.gltf";
    std::filesystem::rename(write(), path);
    EXPECT_EQ(load(path.string()).instances.size(), 1u);
    EXPECT_EQ(load(path.string() + "#0").instances.size(), 1u);
    EXPECT_NE(refused((folder / "absent.gltf#1").string()).find("no such file"), std::string::npos);
}

TEST_F(Gltf, WhatNoInstanceShowsIsNotRead) {
    square();
    doc["meshes"].push_back(doc["meshes"][0]);
    doc["meshes"][1]["primitives"][0]["material"] = 0;
    doc["images"] = {{{"uri", "absent.png"}}};
    doc["textures"] = {{{"source", 0}}};
    doc["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    doc["nodes"] = {{{"mesh", 0}}, {{"mesh", 1}}};
    doc["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
    valid = false;  // a picture is absent
    const Scene scene = read();
    EXPECT_EQ(scene.meshes.at(0).primitives.size(), 1u);
    EXPECT_TRUE(scene.meshes.at(1).primitives.empty());
    EXPECT_EQ(scene.meshes[0].primitives[0].material, 1u);  // the default, after the file's own
    EXPECT_TRUE(scene.textures.empty());
    doc["scene"] = 1;
    expect_refused({"absent.png"});
}

TEST_F(Gltf, SeveralCameras) {
    square();
    doc["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}},
                      {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0}, {"zfar", 1}}}}};
    doc["nodes"] = {{{"mesh", 0}, {"children", {1, 2, 3}}, {"scale", {1, -2, 3}}}, {{"camera", 0}, {"name", "a"}},
                    {{"camera", 0}, {"name", "b"}, {"rotation", {std::sqrt(0.5), 0, 0, std::sqrt(0.5)}}}, {{"camera", 1}}};
    const Scene scene = read();
    ASSERT_EQ(scene.cameras.size(), 2u);
    EXPECT_EQ(scene.cameras[1].name, "b");
    for (const Camera& camera : scene.cameras) {  // no scale, no mirror: what the camera sees is not reversed
        const glm::mat3 m(camera.to_world);
        EXPECT_NEAR(glm::determinant(m), 1, 1e-6f);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(glm::length(m[c]), 1, 1e-6f);
    }
    // "b" looked along +y before its parent's scale took that to -y.
    expect_near(-vec3(scene.cameras[1].to_world[2]), {0, -1, 0});
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_NE(scene.warnings[0].find("1 orthographic"), std::string::npos) << scene.warnings[0];
}

TEST_F(Gltf, DeepTransformsAreMultipliedInDouble) {
    square();
    // A thousand steps of 0.1, of which none is a float.
    doc["nodes"] = json::array();
    for (int i = 0; i < 1000; ++i) doc["nodes"].push_back({{"translation", {0.1, 0, 0}}, {"children", {i + 1}}});
    doc["nodes"].push_back({{"mesh", 0}});
    EXPECT_EQ(place_of(read().instances.at(0)).x, 100.0f);
}

// ---- EXT_mesh_gpu_instancing

class GltfInstancing : public Gltf {
protected:
    void SetUp() override {
        Gltf::SetUp();
        square();
        doc["extensionsUsed"] = doc["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
        attributes() = json::object();
    }
    json& attributes() { return doc["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]; }
};

TEST_F(GltfInstancing, TranslationRotationScale) {
    const float s = std::sqrt(0.5f);
    attributes()["TRANSLATION"] = accessor(view(std::vector<float>{1, 2, 3, 4, 5, 6}), f32, "VEC3", 2);
    Scene scene = read();
    ASSERT_EQ(scene.instances.size(), 2u);
    ASSERT_EQ(scene.meshes.size(), 1u);  // stored once
    EXPECT_EQ(place_of(scene.instances[0]), vec3(1, 2, 3));
    EXPECT_EQ(place_of(scene.instances[1]), vec3(4, 5, 6));
    expect_near(x_axis(scene.instances[1]), {1, 0, 0});

    attributes()["SCALE"] = accessor(view(std::vector<float>{1, 1, 1, 7, 1, 1}), f32, "VEC3", 2);
    attributes()["ROTATION"] = accessor(view(std::vector<float>{0, 0, 0, 1, 0, 0, s, s}), f32, "VEC4", 2);  // a quarter turn about z
    doc["nodes"][0]["translation"] = {100, 0, 0};
    doc["nodes"][0]["scale"] = {1, 2, 1};
    scene = read();
    ASSERT_EQ(scene.instances.size(), 2u);
    expect_near(place_of(scene.instances[0]), {101, 4, 3});
    expect_near(place_of(scene.instances[1]), {104, 10, 6});
    expect_near(x_axis(scene.instances[0]), {1, 0, 0});
    expect_near(x_axis(scene.instances[1]), {0, 14, 0});  // scaled by 7, turned to y, scaled by the node's 2
    EXPECT_EQ(flatten(scene).triangles.size(), 4u);
}

TEST_F(GltfInstancing, NormalisedIntegerRotations) {
    attributes()["ROTATION"] = accessor(view(std::vector<int8_t>{0, 0, 0, 127, 0, 0, 90, 90, 0, 0, 0, 0}), i8, "VEC4", 3, 0, true);
    Scene scene = read();
    ASSERT_EQ(scene.instances.size(), 3u);
    expect_near(x_axis(scene.instances[0]), {1, 0, 0});
    expect_near(x_axis(scene.instances[1]), {0, 1, 0});  // made a unit quaternion, whatever its integers
    expect_near(x_axis(scene.instances[2]), {1, 0, 0});  // no rotation at all: none
    attributes()["ROTATION"] = accessor(view(std::vector<int16_t>{0, 0, -23170, 23170}), i16, "VEC4", 1, 0, true);
    scene = read();
    ASSERT_EQ(scene.instances.size(), 1u);
    expect_near(x_axis(scene.instances[0]), {0, -1, 0});
}

TEST_F(GltfInstancing, OtherAttributesOnlyCount) {
    EXPECT_EQ(read().instances.size(), 1u);  // no attribute at all
    attributes()["_ID"] = accessor(view(std::vector<uint16_t>{1, 2, 3}), u16, "SCALAR", 3);
    EXPECT_EQ(read().instances.size(), 3u);
}

TEST_F(GltfInstancing, BrokenOnesAreRefused) {
    attributes()["TRANSLATION"] = accessor(view(std::vector<float>{1, 2, 3, 4, 5, 6}), f32, "VEC3", 2);
    attributes()["SCALE"] = accessor(view(std::vector<float>{1, 1, 1}), f32, "VEC3", 1);
    expect_refused({"node 0", "EXT_mesh_gpu_instancing", "another attribute"});
    attributes().erase("SCALE");
    attributes()["TRANSLATION"] = 99;
    expect_refused({"node 0", "TRANSLATION", "accessor 99"});
    attributes()["TRANSLATION"] = "x";
    expect_refused({"node 0", "TRANSLATION is not a number"});
    attributes()["TRANSLATION"] = accessor(view(std::vector<float>{1, 2, 3, 4}), f32, "VEC4", 1);
    expect_refused({"TRANSLATION", "4 components"});
    attributes() = 3;
    expect_refused({"node 0", "attributes are not an object"});
    // A million nodes that show a million instances each.
    attributes() = {{"TRANSLATION", 2}};
    doc["accessors"].push_back({{"componentType", f32}, {"type", "VEC3"}, {"count", 50'000'000}});
    attributes()["TRANSLATION"] = doc["accessors"].size() - 1;
    expect_refused({"node 0", "EXT_mesh_gpu_instancing", "out of all proportion"});
}

}  // namespace
}  // namespace myriad::scenes
