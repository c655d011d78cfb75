// Skins, morph targets and animations: what is read of them, and what is refused.
#include <cmath>

#include "scenes/gltf/write.hpp"
#include "scenes/gltf_kit.hpp"
#include "scenes/moment.hpp"
#include "scenes/scene_compare.hpp"

namespace myriad::scenes {
namespace {

class GltfAnimated : public Gltf {
protected:
    int times(const std::vector<float>& t) {
        const int a = accessor(view(t), f32, "SCALAR", t.size());
        doc["accessors"][size_t(a)]["min"] = {t.front()};
        doc["accessors"][size_t(a)]["max"] = {t.back()};
        return a;
    }
    int floats(const std::vector<float>& v, const char* shape, size_t width) { return accessor(view(v), f32, shape, v.size() / width); }

    // With normals, so that there is a vertex each.
    void square() {
        Gltf::square();
        primitive()["attributes"]["NORMAL"] = floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
    }

    // A channel of the first clip.
    json& channel(int node, const char* path, int input, int output, const char* interpolation = "LINEAR") {
        json& clip = doc["animations"][0];
        clip["name"] = "clip";
        clip["channels"].push_back({{"sampler", clip["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
        clip["samplers"].push_back({{"input", input}, {"output", output}, {"interpolation", interpolation}});
        return clip;
    }

    // The square on a skeleton of two joints, nodes 1 and 2: its lower edge with the first, its upper with the second.
    void skinned() {
        square();
        primitive()["attributes"]["JOINTS_0"] = accessor(view(std::vector<uint8_t>{0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}), u8, "VEC4", 4);
        primitive()["attributes"]["WEIGHTS_0"] = floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4);
        doc["nodes"] = {{{"mesh", 0}, {"skin", 0}}, {{"name", "root"}, {"children", {2}}}, {{"name", "tip"}, {"translation", {0, 1, 0}}}};
        doc["scenes"][0]["nodes"] = {0, 1};
        std::vector<float> inverse(32, 0);
        for (const size_t i : {0, 5, 10, 15}) inverse[i] = inverse[16 + i] = 1;
        inverse[16 + 13] = -1;
        doc["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", accessor(view(inverse), f32, "MAT4", 2)}}};
    }

    Triangles at(Scene& scene, double seconds) {
        Triangles t = flatten(scene, Sharing::automatic, {{0}, false});
        deform(t, moment_at(scene, t.motion, seconds));
        return t;
    }

    // Whether what the scene is written as comes back as the same scene.
    static void expect_kept(const Scene& scene) {
        const auto path = std::filesystem::temp_directory_path() / ("myriad_kept_" + std::to_string(::getpid()) + ".glb");
        std::ofstream(path, std::ios::binary) << glb_bytes(scene);
        EXPECT_EQ(difference(scene, load(path.string())), "");
        std::filesystem::remove(path);
    }
};

TEST_F(GltfAnimated, ASkinWithAClip) {
    skinned();
    channel(2, "rotation", times({0, 1}), floats({0, 0, 0, 1, 0, 0, std::sqrt(0.5f), std::sqrt(0.5f)}, "VEC4", 4));
    for (const bool glb : {false, true}) {
        Scene scene = read(glb);
        EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
        ASSERT_EQ(scene.clips.size(), 1u);
        EXPECT_EQ(scene.clips[0].name, "clip");
        const Triangles t = at(scene, 1);
        ASSERT_EQ(t.motion.count(), 4u);
        expect_near(t.positions[0], {0, 0, 0});
        expect_near(t.positions[1], {1, 0, 0});
        expect_near(t.positions[2], {0, 2, 0});  // turned about (0, 1)
        expect_near(t.positions[3], {0, 1, 0});
        expect_kept(scene);
    }
}

TEST_F(GltfAnimated, EveryInterpolation) {
    square();
    channel(0, "translation", times({0, 2}), floats({0, 0, 0, 4, 0, 0}, "VEC3", 3), "STEP");
    Scene scene = read();
    expect_near(at(scene, 1).positions[0], {0, 0, 0});
    doc["animations"][0]["samplers"][0].erase("interpolation");
    scene = read();
    expect_near(at(scene, 1).positions[0], {2, 0, 0});
    doc["animations"].clear();
    channel(0, "translation", times({0, 2}), floats({0, 0, 0, 0, 0, 0, 2, 0, 0, 2, 0, 0, 4, 0, 0, 0, 0, 0}, "VEC3", 3), "CUBICSPLINE");
    scene = read();
    expect_near(at(scene, 1).positions[0], {2, 0, 0});  // the straight line that those tangents are
    expect_near(at(scene, 0.5).positions[0], {1, 0, 0});
    expect_kept(scene);
    doc["animations"][0]["samplers"][0]["interpolation"] = "LOOPY";
    expect_refused({"animation 0 \"clip\" sampler 0", "LOOPY", "CUBICSPLINE"});
}

// KHR_mesh_quantization and the core's: rotations and weights may be normalised integers.
TEST_F(GltfAnimated, NormalisedIntegers) {
    skinned();
    primitive()["attributes"]["WEIGHTS_0"] = accessor(view(std::vector<uint8_t>{255, 0, 0, 0, 255, 0, 0, 0, 127, 128, 0, 0, 255, 0, 0, 0}), u8, "VEC4", 4, 0, true);
    primitive()["attributes"]["JOINTS_0"] = accessor(view(std::vector<uint16_t>{0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}), u16, "VEC4", 4);
    const int16_t half = 23170;  // of 32767: the sine of 45 degrees
    channel(2, "rotation", times({0, 1}), accessor(view(std::vector<int16_t>{0, 0, 0, 32767, 0, 0, half, half}), i16, "VEC4", 2, 0, true));
    Scene scene = read();
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
    const Triangles t = at(scene, 1);
    expect_near(t.positions[3], {0, 1, 0}, 1e-4f);
    const float w = 128.0f / 255;
    expect_near(t.positions[2], vec3(1, 1, 0) * (1 - w) + vec3(0, 2, 0) * w, 1e-4f);
    expect_kept(scene);
}

TEST_F(GltfAnimated, EightJointsAVertex) {
    skinned();
    primitive()["attributes"]["WEIGHTS_0"] = floats({.5f, 0, 0, 0, .5f, 0, 0, 0, .5f, 0, 0, 0, .5f, 0, 0, 0}, "VEC4", 4);
    primitive()["attributes"]["WEIGHTS_1"] = floats({.5f, 0, 0, 0, .5f, 0, 0, 0, .5f, 0, 0, 0, .5f, 0, 0, 0}, "VEC4", 4);
    primitive()["attributes"]["JOINTS_1"] = accessor(view(std::vector<uint8_t>{1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}), u8, "VEC4", 4);
    channel(2, "translation", times({0, 1}), floats({0, 1, 0, 0, 1, 4}, "VEC3", 3));
    Scene scene = read();
    for (const vec3& p : at(scene, 1).positions) EXPECT_NEAR(p.z, 2, 1e-6);
    expect_kept(scene);
    valid = false;
    // Eight roundings to a byte may add up to more than four: 252 of 255 is as meant.
    primitive()["attributes"]["WEIGHTS_0"] = accessor(view(std::vector<uint8_t>(16, 32)), u8, "VEC4", 4, 0, true);
    primitive()["attributes"]["WEIGHTS_1"] = accessor(view(std::vector<uint8_t>(16, 31)), u8, "VEC4", 4, 0, true);
    EXPECT_TRUE(read().warnings.empty());
    primitive()["attributes"]["WEIGHTS_2"] = primitive()["attributes"]["WEIGHTS_1"], primitive()["attributes"]["JOINTS_2"] = primitive()["attributes"]["JOINTS_1"];
    EXPECT_NE(read().warnings.at(0).find("more than eight joints"), std::string::npos);
}

// The sum may be off by 2e-7 a weight, says Khronos' validator; files in use are off by more. Once it is right it stays.
TEST_F(GltfAnimated, WeightsNearlySumToOne) {
    valid = false;
    skinned();
    primitive()["attributes"]["WEIGHTS_0"] = floats({0.3333331f, 0.6666661f, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0.1f, 0.9000001f, 0, 0}, "VEC4", 4);
    const Scene scene = read();
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
    for (const glm::vec4& w : scene.meshes[0].primitives[0].joint_weights[0]) EXPECT_NEAR(double(w.x) + double(w.y), 1, 1.01e-7);
    expect_kept(scene);
}

TEST_F(GltfAnimated, MorphTargetsSparseToo) {
    square();
    // Vertex 2 goes up by 1; of the other target, quantised, all go along z by a half.
    doc["accessors"].push_back({{"componentType", f32}, {"type", "VEC3"}, {"count", 4}, {"min", {0, 0, 0}}, {"max", {0, 1, 0}},
                                {"sparse", {{"count", 1}, {"indices", {{"bufferView", view(std::vector<uint16_t>{2})}, {"componentType", u16}}},
                                            {"values", {{"bufferView", view(std::vector<float>{0, 1, 0})}}}}}});
    const int up = int(doc["accessors"].size()) - 1;
    std::vector<int8_t> bytes;
    for (int i = 0; i < 4; ++i) bytes.insert(bytes.end(), {0, 0, 64, 0});
    const int along = accessor(view(bytes, 4), i8, "VEC3", 4, 0, true);
    doc["accessors"][size_t(along)]["min"] = {0, 0, 64}, doc["accessors"][size_t(along)]["max"] = {0, 0, 64};
    doc["extensionsRequired"] = {"KHR_mesh_quantization"};
    primitive()["targets"] = {{{"POSITION", up}}, {{"POSITION", along}}};
    doc["meshes"][0]["weights"] = {0.5, 0};
    Scene scene = read();
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
    Triangles t = flatten(scene);
    EXPECT_FALSE(t.motion.plays());
    expect_near(t.positions[2], {1, 1.5f, 0});  // at rest by the mesh's weights
    expect_kept(scene);
    doc["nodes"][0]["weights"] = {0, 1};  // the node's win
    scene = read();
    expect_near(flatten(scene).positions[2], {1, 1, 64.0f / 127});
    channel(0, "weights", times({0, 1}), floats({0, 0, 1, 1}, "SCALAR", 1));
    scene = read();
    expect_near(at(scene, 0.5).positions[2], {1, 1.5f, 32.0f / 127});
    expect_kept(scene);
}

TEST_F(GltfAnimated, LightsAndCamerasMove) {
    square();
    doc["nodes"] = {{{"mesh", 0}}, {{"name", "boom"}, {"children", {2, 3}}}, {{"name", "eye"}, {"camera", 0}},
                    {{"name", "lamp"}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
    doc["scenes"][0]["nodes"] = {0, 1};
    doc["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}}};
    doc["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 5}}};
    doc["extensionsUsed"] = {"KHR_lights_punctual"};
    channel(1, "translation", times({0, 1}), floats({0, 0, 0, 0, 8, 0}, "VEC3", 3));
    Scene scene = read();
    EXPECT_EQ(scene.instances[0].node, none) << "what stands still forgets its node";
    EXPECT_EQ(scene.nodes.size(), 3u);
    const Triangles t = flatten(scene, Sharing::automatic, {{0}});
    EXPECT_EQ(t.motion.count(), 0u);
    const Moment moment = moment_at(scene, t.motion, 0.5);
    expect_near(moment.lights[0].position, {0, 4, 0});
    expect_near(vec3(moment.cameras[0].to_world[3]), {0, 4, 0});
    expect_kept(scene);
}

TEST_F(GltfAnimated, WithoutMovementThereAreNoNodes) {
    square();
    EXPECT_TRUE(read().nodes.empty());
    channel(0, "translation", times({0, 1}), floats({0, 0, 0, 4, 0, 0}, "VEC3", 3));
    EXPECT_EQ(read().nodes.size(), 1u);
}

TEST_F(GltfAnimated, InstancesOfOneNodeMoveWithIt) {
    square();
    doc["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = floats({0, 0, 0, 5, 0, 0}, "VEC3", 3);
    channel(0, "translation", times({0, 1}), floats({0, 0, 0, 0, 0, 3}, "VEC3", 3));
    Scene scene = read();
    const Triangles t = at(scene, 1);
    ASSERT_EQ(t.positions.size(), 8u);
    expect_near(t.positions[0], {0, 0, 3});
    expect_near(t.positions[4], {5, 0, 3});
}

// They have the weights at rest. A clip could only move those of all of them at once, which is not read.
TEST_F(GltfAnimated, InstancesOfOneNodeKeepTheirShape) {
    square();
    const std::vector<float> up = {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0};
    const int target = floats(up, "VEC3", 3);
    bound(target, up);
    primitive()["targets"] = {{{"POSITION", target}}};
    doc["meshes"][0]["weights"] = {0.5};
    doc["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = floats({0, 0, 0, 5, 0, 0}, "VEC3", 3);
    channel(0, "weights", times({0, 1}), floats({0, 1}, "SCALAR", 1));
    Scene scene = read();
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_EQ(scene.warnings[0], "1 channels of animations were left out, for they are weights of nodes with EXT_mesh_gpu_instancing.");
    ASSERT_EQ(scene.clips.size(), 1u);
    EXPECT_TRUE(scene.clips[0].channels.empty());
    const Triangles t = at(scene, 1);
    EXPECT_EQ(t.motion.count(), 0u);
    ASSERT_EQ(t.positions.size(), 8u);
    expect_near(t.positions[2], {1, 1.5f, 0});
    expect_near(t.positions[6], {6, 1.5f, 0});
}

TEST_F(GltfAnimated, HarmlessDefectsAreCounted) {
    valid = false;
    skinned();
    primitive()["attributes"]["WEIGHTS_0"] = floats({2, 2, 0, 0, 0, 0, 0, 0, -1, 1, 0, 0, NAN, 1, 0, 0}, "VEC4", 4);
    channel(2, "rotation", times({0, 1, 1, 2, 3}), floats({0, 0, 0, 1, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 1}, "VEC4", 4));
    channel(2, "pointer", 0, 0);
    channel(1, "weights", times({0}), floats({1}, "SCALAR", 1));
    Scene scene = read();
    std::string all;
    for (const std::string& warning : scene.warnings) all += warning + "\n";
    for (const char* part : {"4 vertices have joint weights", "1 channels of animations were left out, for they move something else",
                             "1 channels of animations were left out, for they are weights", "1 keys of animations were left out",
                             "1 keys of animations are rotations of no length, which turn nothing"})
        EXPECT_NE(all.find(part), std::string::npos) << part << " is not in\n" << all;
    EXPECT_EQ(scene.clips[0].tracks[0].times, (std::vector<float>{0, 1, 2, 3}));
    EXPECT_EQ(scene.clips[0].tracks[0].values[6], 1) << "of two keys at one time the later one counts";
    expect_near(at(scene, 0).positions[0], {0, 0, 0});
    // Singular matrices flatten; a skin for a mesh without joints is none.
    std::vector<float> inverse(32, 0);
    inverse[15] = inverse[31] = 1;
    doc["skins"][0]["inverseBindMatrices"] = accessor(view(inverse), f32, "MAT4", 2);
    EXPECT_NE(read().warnings.at(1).find("2 inverse bind matrices are singular"), std::string::npos);
    primitive()["attributes"].erase("JOINTS_0"), primitive()["attributes"].erase("WEIGHTS_0");
    scene = read();
    EXPECT_NE(scene.warnings.at(0).find("without joints"), std::string::npos);
    EXPECT_EQ(scene.instances[0].skin, none);
}

TEST_F(GltfAnimated, BrokenSkinsAreRefusedByPlace) {
    skinned();
    const json good = doc;
    const auto refuse = [&](std::initializer_list<const char*> words, auto change) {
        doc = good;
        change();
        expect_refused(words);
    };
    refuse({"4 of JOINTS_0 and 0 of WEIGHTS_0"}, [&] { primitive()["attributes"].erase("WEIGHTS_0"); });
    refuse({"skin 0", "node 9"}, [&] { doc["skins"][0]["joints"] = {1, 9}; });
    refuse({"skin 0", "no joints"}, [&] { doc["skins"][0]["joints"] = json::array(); });
    refuse({"skin 0", "refers to joint 1", "there are 1"}, [&] { doc["skins"][0]["joints"] = {1}; });
    refuse({"skin 0", "not in the scene"}, [&] { doc["scenes"][0]["nodes"] = {0}; });
    refuse({"skin 0", "inverseBindMatrices", "there are 2 but 3"}, [&] { doc["skins"][0]["joints"] = {1, 2, 0}; });
    refuse({"skin 0", "not finite"}, [&] { doc["skins"][0]["inverseBindMatrices"] = accessor(view(std::vector<float>(32, NAN)), f32, "MAT4", 2); });
    refuse({"no skin 3"}, [&] { doc["nodes"][0]["skin"] = 3; });
    refuse({"JOINTS_0", "no joint's index"}, [&] { primitive()["attributes"]["JOINTS_0"] = floats(std::vector<float>(16, 0.5f), "VEC4", 4); });
    refuse({"3 of JOINTS_0"}, [&] { primitive()["attributes"]["JOINTS_0"] = accessor(view(std::vector<uint8_t>(12)), u8, "VEC4", 3); });
    refuse({"cycle"}, [&] { doc["nodes"][2]["children"] = {1}; });
}

TEST_F(GltfAnimated, BrokenClipsAreRefusedByPlace) {
    square();
    channel(0, "translation", times({0, 1}), floats({0, 0, 0, 4, 0, 0}, "VEC3", 3));
    const json good = doc;
    const auto refuse = [&](std::initializer_list<const char*> words, auto change) {
        doc = good;
        change(doc["animations"][0]);
        expect_refused(words);
    };
    refuse({"animation 0", "sampler 0 input", "time 1"}, [&](json& a) { a["samplers"][0]["input"] = times({1, 0}); });
    refuse({"animation 0", "sampler 0 input", "time 0"}, [&](json& a) { a["samplers"][0]["input"] = floats({NAN, 1}, "SCALAR", 1); });
    refuse({"sampler 0 input", "no keys"}, [&](json& a) { a["samplers"][0]["input"] = accessor(view(std::vector<float>{0}), f32, "SCALAR", 0); });
    refuse({"sampler 0 output", "there are 9 numbers", "take 6"}, [&](json& a) { a["samplers"][0]["output"] = floats(std::vector<float>(9), "VEC3", 3); });
    refuse({"sampler 0 output", "not finite"}, [&](json& a) { a["samplers"][0]["output"] = floats({0, 0, 0, INFINITY, 0, 0}, "VEC3", 3); });
    refuse({"sampler 0 output", "components"}, [&](json& a) { a["samplers"][0]["output"] = floats(std::vector<float>(8), "VEC4", 4); });
    refuse({"channel 0", "no node 5"}, [&](json& a) { a["channels"][0]["target"]["node"] = 5; });
    refuse({"channel 0", "no sampler 5"}, [&](json& a) { a["channels"][0]["sampler"] = 5; });
    refuse({"channel 1", "the translation of the same node"}, [&](json& a) { a["channels"].push_back(a["channels"][0]); });
    refuse({"channel 0", "matrix"}, [&](json&) { doc["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; });
}

TEST_F(GltfAnimated, BrokenMorphTargetsAreRefusedByPlace) {
    square();
    primitive()["targets"] = {{{"POSITION", floats(std::vector<float>(12), "VEC3", 3)}}};
    const json good = doc;
    const auto refuse = [&](std::initializer_list<const char*> words, auto change) {
        doc = good;
        change();
        expect_refused(words);
    };
    refuse({"target 0", "there are 3 of POSITION"}, [&] { primitive()["targets"][0]["POSITION"] = floats(std::vector<float>(9), "VEC3", 3); });
    refuse({"node 0", "there are 2 weights, not 1"}, [&] { doc["meshes"][0]["weights"] = {0, 1}; });
    refuse({"primitive 1", "it has 0 morph targets"}, [&] {
        json second = primitive();
        second.erase("targets");
        doc["meshes"][0]["primitives"].push_back(second);
    });
    doc = good;
    valid = false;
    primitive()["targets"][0]["POSITION"] = floats({NAN, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3", 3);
    EXPECT_NE(read().warnings.at(0).find("1 displacements of morph targets"), std::string::npos);
}

}  // namespace
}  // namespace myriad::scenes
