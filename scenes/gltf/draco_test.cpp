// KHR_draco_mesh_compression: every attribute, and what integers mean. Decoding damaged data: gltf_test.cpp, hostile_test.cpp.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>

#include "scenes/gltf_kit.hpp"

namespace myriad::scenes {
namespace {

// Two triangles of their own six vertices, whose attributes are functions of the vertex's number.
class GltfDraco : public Gltf {
protected:
    template <class T>
    void add(const char* name, draco::GeometryAttribute::Type type, int components, draco::DataType data, int component_type, const char* shape,
             bool normalized, const std::vector<T>& values) {
        const int id = builder.AddAttribute(type, int8_t(components), data);
        for (int t = 0; t < 2; ++t) {
            const T* v = values.data() + t * 3 * components;
            builder.SetAttributeValuesForFace(id, draco::FaceIndex(uint32_t(t)), v, v + components, v + 2 * components);
        }
        ids[name] = id;
        json accessor = {{"componentType", component_type}, {"type", shape}, {"count", 6}};
        if (normalized) accessor["normalized"] = true;
        doc["accessors"].push_back(accessor);
        primitive()["attributes"][name] = doc["accessors"].size() - 1;
    }
    // Compresses without quantisation, and says so in the primitive.
    void compress() {
        const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
        ASSERT_TRUE(mesh);
        draco::Encoder encoder;
        encoder.SetSpeedOptions(10, 10);
        draco::EncoderBuffer buffer;
        ASSERT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
        json attributes;
        for (const auto& [name, id] : ids) attributes[name] = mesh->attribute(id)->unique_id();
        const int data = view(std::vector<char>(buffer.data(), buffer.data() + buffer.size()));
        doc["accessors"].push_back({{"componentType", u32}, {"type", "SCALAR"}, {"count", 6}});
        primitive()["indices"] = doc["accessors"].size() - 1;
        primitive()["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", data}, {"attributes", attributes}};
        doc["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    }
    void SetUp() override {
        Gltf::SetUp();
        builder.Start(2);
        add("POSITION", draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32, f32, "VEC3", false,
            std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 10, 0, 0, 11, 0, 0, 11, 1, 0});
        doc["accessors"][0]["min"] = {0, 0, 0}, doc["accessors"][0]["max"] = {11, 1, 0};
    }
    // The vertex at this position.
    static size_t vertex(const Primitive& p, const vec3& at) {
        for (size_t i = 0; i < p.positions.size(); ++i)
            if (p.positions[i] == at) return i;
        ADD_FAILURE() << "no vertex at " << at.x << " " << at.y;
        return 0;
    }

    draco::TriangleSoupMeshBuilder builder;
    std::map<std::string, int> ids;
};

TEST_F(GltfDraco, EveryAttribute) {
    std::vector<float> normals, tangents, first, second;
    std::vector<uint8_t> colors;
    for (int i = 0; i < 6; ++i) {
        normals.insert(normals.end(), {0, 0, 1});
        tangents.insert(tangents.end(), {1, 0, 0, i < 3 ? 1.0f : -1.0f});
        first.insert(first.end(), {float(i), 0.5f}), second.insert(second.end(), {float(10 * i), 0.25f});
        colors.insert(colors.end(), {uint8_t(51 * i), 255, 0, uint8_t(255 - 51 * i)});
    }
    using draco::GeometryAttribute;
    add("NORMAL", GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32, f32, "VEC3", false, normals);
    add("TANGENT", GeometryAttribute::GENERIC, 4, draco::DT_FLOAT32, f32, "VEC4", false, tangents);
    add("TEXCOORD_0", GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32, f32, "VEC2", false, first);
    add("TEXCOORD_1", GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32, f32, "VEC2", false, second);
    add("COLOR_0", GeometryAttribute::COLOR, 4, draco::DT_UINT8, u8, "VEC4", true, colors);
    compress();
    const Primitive p = read(true).meshes.at(0).primitives.at(0);
    ASSERT_EQ(p.indices.size(), 6u);
    const size_t last = vertex(p, {11, 1, 0}), second_vertex = vertex(p, {1, 0, 0});
    EXPECT_EQ(p.normals.at(last), vec3(0, 0, 1));
    EXPECT_EQ(p.tangents.at(last), glm::vec4(1, 0, 0, -1));
    EXPECT_EQ(p.tangents.at(second_vertex), glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(p.texcoords.at(last), glm::vec2(5, 0.5f));
    EXPECT_EQ(p.texcoords1.at(last), glm::vec2(50, 0.25f));
    EXPECT_EQ(p.colors.at(last), glm::vec4(1, 1, 0, 0));
    EXPECT_EQ(p.colors.at(second_vertex), glm::vec4(0.2f, 1, 0, 0.8f));
}

TEST_F(GltfDraco, IntegersMeanWhatTheirAccessorSays) {
    std::vector<uint16_t> texcoords, colors;
    for (int i = 0; i < 6; ++i) texcoords.insert(texcoords.end(), {uint16_t(13107 * i), 0}), colors.insert(colors.end(), {65535, 13107, 0});
    using draco::GeometryAttribute;
    add("TEXCOORD_0", GeometryAttribute::TEX_COORD, 2, draco::DT_UINT16, u16, "VEC2", true, texcoords);
    add("COLOR_0", GeometryAttribute::COLOR, 3, draco::DT_UINT16, u16, "VEC3", true, colors);
    compress();
    Primitive p = read(true).meshes.at(0).primitives.at(0);
    EXPECT_EQ(p.texcoords.at(vertex(p, {11, 1, 0})), glm::vec2(1, 0));
    EXPECT_EQ(p.texcoords.at(vertex(p, {1, 0, 0})), glm::vec2(0.2f, 0));
    EXPECT_EQ(p.colors.at(0), glm::vec4(1, 0.2f, 0, 1));
    doc["accessors"][1].erase("normalized");
    doc["extensionsRequired"].push_back("KHR_mesh_quantization");
    p = read(true).meshes.at(0).primitives.at(0);
    EXPECT_EQ(p.texcoords.at(vertex(p, {11, 1, 0})), glm::vec2(65535, 0));
}

TEST_F(GltfDraco, WhatIsNotCompressedIsStoredAsUsual) {
    compress();
    std::vector<float> colors;
    for (int i = 0; i < 6; ++i) colors.insert(colors.end(), {0.25f, 0.5f, 0.75f});
    primitive()["attributes"]["COLOR_0"] = accessor(view(colors), f32, "VEC3", 6);
    const Primitive p = read(true).meshes.at(0).primitives.at(0);
    EXPECT_EQ(p.colors.at(5), glm::vec4(0.25f, 0.5f, 0.75f, 1));
}

}  // namespace
}  // namespace myriad::scenes
