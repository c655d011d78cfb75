// Vertex attributes and indices as exporters store them.
#include <cmath>
#include <limits>

#include "scenes/gltf_kit.hpp"

namespace myriad::scenes {
namespace {

using glm::vec2;
using glm::vec4;

void expect_near4(const vec4& a, const vec4& b, float tolerance = 1e-6f) {
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(a[c], b[c], tolerance) << "component " << c;
}

TEST_F(Gltf, ColorsOfEveryType) {
    square();
    const auto color = [&](int accessor) {
        primitive()["attributes"]["COLOR_0"] = accessor;
        return read().meshes[0].primitives[0].colors.at(1);
    };
    // The second of four; 51 / 255 = 13107 / 65535 = 0.2.
    const std::vector<float> rgb = {1, 1, 1, .25f, .5f, .75f, 1, 1, 1, 1, 1, 1};
    expect_near4(color(accessor(view(rgb), f32, "VEC3", 4)), {.25f, .5f, .75f, 1});
    const std::vector<float> rgba = {1, 1, 1, 1, .25f, .5f, .75f, .125f, 1, 1, 1, 1, 1, 1, 1, 1};
    expect_near4(color(accessor(view(rgba), f32, "VEC4", 4)), {.25f, .5f, .75f, .125f});
    const std::vector<uint8_t> bytes = {9, 9, 9, 9, 255, 51, 0, 102, 9, 9, 9, 9, 9, 9, 9, 9};
    expect_near4(color(accessor(view(bytes), u8, "VEC4", 4, 0, true)), {1, .2f, 0, .4f});
    expect_near4(color(accessor(view(bytes, 4), u8, "VEC3", 4, 0, true)), {1, .2f, 0, 1});
    const std::vector<uint16_t> shorts = {9, 9, 9, 9, 65535, 13107, 0, 26214, 9, 9, 9, 9, 9, 9, 9, 9};
    expect_near4(color(accessor(view(shorts), u16, "VEC4", 4, 0, true)), {1, .2f, 0, .4f});
    expect_near4(color(accessor(view(shorts, 8), u16, "VEC3", 4, 0, true)), {1, .2f, 0, 1});
    valid = false;
    expect_near4(color(accessor(view(bytes), u8, "VEC4", 4)), {1, .2f, 0, .4f});  // not marked as normalised
    primitive()["attributes"]["COLOR_0"] = accessor(view(rgb), f32, "VEC2", 4);
    expect_refused({"primitive 0 COLOR_0", "2 components"});
    primitive()["attributes"]["COLOR_0"] = accessor(view(rgb), f32, "VEC3", 3);
    expect_refused({"primitive 0", "3 of COLOR_0 but 4 of POSITION"});
}

TEST_F(Gltf, SecondSetAndTangents) {
    square();
    std::vector<float> normals, tangents;
    for (int i = 0; i < 4; ++i) normals.insert(normals.end(), {0, 0, 1}), tangents.insert(tangents.end(), {1, 0, 0, i % 2 ? 1.0f : -1.0f});
    primitive()["attributes"]["TEXCOORD_0"] = accessor(view(std::vector<float>(8, 0.5f)), f32, "VEC2", 4);
    primitive()["attributes"]["TEXCOORD_1"] = accessor(view(std::vector<uint8_t>{0, 0, 0, 0, 255, 51, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 4), u8, "VEC2", 4, 0, true);
    primitive()["attributes"]["TANGENT"] = accessor(view(tangents), f32, "VEC4", 4);
    EXPECT_TRUE(read().meshes[0].primitives[0].tangents.empty());  // tangents mean nothing without normals
    primitive()["attributes"]["NORMAL"] = accessor(view(normals), f32, "VEC3", 4);
    const Primitive p = read().meshes[0].primitives[0];
    EXPECT_EQ(p.texcoords1.at(1), vec2(1, .2f));
    EXPECT_EQ(p.tangents.at(1), vec4(1, 0, 0, 1));
    EXPECT_EQ(p.tangents.at(2), vec4(1, 0, 0, -1));
    EXPECT_EQ(p.texcoords.at(1), vec2(0.5f));
}

TEST_F(Gltf, QuantisedTangentsAndTexcoords) {
    square();
    doc["extensionsRequired"] = {"KHR_mesh_quantization"};
    std::vector<int8_t> normals, tangents;
    for (int i = 0; i < 4; ++i) normals.insert(normals.end(), {0, 0, 127, 0}), tangents.insert(tangents.end(), {0, -127, 0, -127});
    primitive()["attributes"]["NORMAL"] = accessor(view(normals, 4), i8, "VEC3", 4, 0, true);
    primitive()["attributes"]["TANGENT"] = accessor(view(tangents), i8, "VEC4", 4, 0, true);
    primitive()["attributes"]["TEXCOORD_0"] = accessor(view(std::vector<int16_t>{1, -2, 300, 4, 5, 6, 7, 8}), i16, "VEC2", 4);
    const Primitive p = read().meshes[0].primitives[0];
    EXPECT_EQ(p.tangents.at(0), vec4(0, -1, 0, -1));
    EXPECT_EQ(p.texcoords.at(1), vec2(300, 4));
}

// ---- sparse accessors

TEST_F(Gltf, SparseWithoutABufferView) {
    square();
    for (int type : {u8, u16, u32}) {
        json& a = doc["accessors"][0];
        a.erase("bufferView"), a.erase("byteOffset");
        const int where = type == u8 ? view(std::vector<uint8_t>{9, 1, 3}) : type == u16 ? view(std::vector<uint16_t>{9, 1, 3}) : view(std::vector<uint32_t>{9, 1, 3});
        a["sparse"] = {{"count", 2},
                       {"indices", {{"bufferView", where}, {"byteOffset", type == u8 ? 1 : type == u16 ? 2 : 4}, {"componentType", type}}},
                       {"values", {{"bufferView", view(std::vector<float>{9, 1, 2, 3, 4, 5, 6})}, {"byteOffset", 4}}}};
        const Primitive p = read().meshes[0].primitives[0];
        expect_near(p.positions.at(0), {0, 0, 0});
        expect_near(p.positions.at(1), {1, 2, 3});
        expect_near(p.positions.at(2), {0, 0, 0});
        expect_near(p.positions.at(3), {4, 5, 6});
    }
    json& sparse = doc["accessors"][0]["sparse"];
    sparse["indices"]["bufferView"] = view(std::vector<uint32_t>{9, 1, 4});
    expect_refused({"POSITION", "sparse index 4"});
    sparse["indices"]["bufferView"] = view(std::vector<uint32_t>{1, 3});
    expect_refused({"POSITION", "needs 2 elements of 4 bytes from byte 4 on"});
    sparse["indices"] = {{"bufferView", view(std::vector<float>{1, 3})}, {"componentType", f32}};
    expect_refused({"POSITION", "sparse part is malformed"});
}

TEST_F(Gltf, SparseNormalisedIntegers) {
    square();
    const int base = view(std::vector<uint8_t>{255, 0, 9, 9, 255, 0, 9, 9, 255, 0, 9, 9, 255, 0, 9, 9}, 4);
    primitive()["attributes"]["TEXCOORD_0"] = accessor(base, u8, "VEC2", 4, 0, true);
    doc["accessors"].back()["sparse"] = {{"count", 1},
                                         {"indices", {{"bufferView", view(std::vector<uint16_t>{2})}, {"componentType", u16}}},
                                         {"values", {{"bufferView", view(std::vector<uint8_t>{51, 102})}}}};
    const Primitive p = read().meshes[0].primitives[0];
    EXPECT_EQ(p.texcoords.at(1), vec2(1, 0));
    EXPECT_EQ(p.texcoords.at(2), vec2(.2f, .4f));
}

TEST_F(Gltf, SparseIndices) {
    square();
    doc["accessors"][1]["sparse"] = {{"count", 1},
                                     {"indices", {{"bufferView", view(std::vector<uint8_t>{5})}, {"componentType", u8}}},
                                     {"values", {{"bufferView", view(std::vector<uint16_t>{1})}}}};
    EXPECT_EQ(read().meshes[0].primitives[0].indices, (std::vector<uint32_t>{0, 1, 2, 0, 2, 1}));
}

// ---- strips and fans

TEST_F(Gltf, StripsAreJoinedByDegenerateTriangles) {
    primitive()["attributes"]["POSITION"] = accessor(view(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 0, 0, 6, 0, 0, 5, 1, 0}), f32, "VEC3", 6);
    primitive()["mode"] = 5;
    primitive()["indices"] = indices<uint16_t>(u16, {0, 1, 2, 2, 3, 3, 3, 4, 5});
    Scene scene = read();
    EXPECT_EQ(scene.meshes[0].primitives[0].indices, (std::vector<uint32_t>{0, 1, 2, 3, 4, 5}));
    for (const auto& n : flatten(scene).normals) expect_near(n, {0, 0, 1});
    primitive()["indices"] = indices<uint16_t>(u16, {0, 1});
    EXPECT_TRUE(read().meshes[0].primitives[0].indices.empty());
}

TEST_F(Gltf, PrimitiveRestartIsRefused) {
    // The value is an index in range: only its being the largest of its type makes it a restart.
    primitive()["attributes"]["POSITION"] = accessor(view(std::vector<float>(3 * 256, 0.5f)), f32, "VEC3", 256);
    for (int mode : {4, 5, 6}) {
        primitive()["mode"] = mode;
        primitive()["indices"] = indices<uint8_t>(u8, {0, 1, 255, 2, 3, 4});
        expect_refused({"primitive 0 indices", "255, which restarts a primitive"});
        primitive()["indices"] = indices<uint16_t>(u16, {0, 1, 65535, 2, 3, 4});
        expect_refused({"primitive 0 indices", "65535, which restarts"});
        primitive()["indices"] = indices<uint32_t>(u32, {0, 1, 0xffffffff, 2, 3, 4});
        expect_refused({"primitive 0 indices", "4294967295, which restarts"});
        primitive()["indices"] = indices<uint16_t>(u16, {0, 1, 255, 2, 3, 4});
        EXPECT_EQ(read().meshes[0].primitives[0].indices.size(), mode == 4 ? 6u : 12u);
    }
}

// Every attribute follows where unused vertices are left out.
TEST_F(Gltf, UnusedVerticesLeaveWithAllTheirAttributes) {
    valid = false;  // normals are numbers here, not directions
    std::vector<float> three, two, four;
    for (int i = 0; i < 50; ++i) {
        const float x = float(i);
        three.insert(three.end(), {x, 1, 2}), two.insert(two.end(), {x, -x}), four.insert(four.end(), {x / 100, 0, 0, 1});
    }
    auto& attributes = primitive()["attributes"];
    attributes["POSITION"] = accessor(view(three), f32, "VEC3", 50);
    attributes["NORMAL"] = accessor(view(three), f32, "VEC3", 50);
    attributes["TANGENT"] = accessor(view(four), f32, "VEC4", 50);
    attributes["TEXCOORD_0"] = accessor(view(two), f32, "VEC2", 50);
    attributes["TEXCOORD_1"] = accessor(view(two), f32, "VEC2", 50);
    attributes["COLOR_0"] = accessor(view(four), f32, "VEC4", 50);
    primitive()["indices"] = indices<uint8_t>(u8, {40, 7, 23});
    const Primitive p = read().meshes[0].primitives[0];
    EXPECT_EQ(p.indices, (std::vector<uint32_t>{0, 1, 2}));
    ASSERT_EQ(p.positions.size(), 3u);
    EXPECT_EQ(p.positions[1].x, 7);
    EXPECT_EQ(p.normals.at(2).x, 23);
    EXPECT_EQ(p.tangents.at(0).x, 0.4f);
    EXPECT_EQ(p.texcoords.at(1), vec2(7, -7));
    EXPECT_EQ(p.texcoords1.at(2), vec2(23, -23));
    EXPECT_EQ(p.colors.at(0).x, 0.4f);
}

}  // namespace
}  // namespace myriad::scenes
