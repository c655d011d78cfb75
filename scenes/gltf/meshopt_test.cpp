// EXT_meshopt_compression: what the library encodes comes back, bytes written by hand are read as the extension says, and
// nothing damaged gets through.
#include <meshoptimizer.h>

#include <cmath>
#include <random>

#include "scenes/gltf_kit.hpp"

namespace myriad::scenes {
namespace {

class GltfMeshopt : public Gltf {
protected:
    void SetUp() override {
        Gltf::SetUp();
        doc["extensionsUsed"] = doc["extensionsRequired"] = {"EXT_meshopt_compression"};
    }
    json& compressed(int view) { return doc["bufferViews"][size_t(view)]["extensions"]["EXT_meshopt_compression"]; }

    // A compressed view whose plain bytes are in no buffer at all.
    int add(const std::vector<uint8_t>& bytes, const char* mode, size_t count, size_t stride, const char* filter = nullptr) {
        const int where = view(bytes);
        json v = doc["bufferViews"].back();
        json& extension = v["extensions"]["EXT_meshopt_compression"];
        extension = {{"buffer", 0}, {"byteOffset", v["byteOffset"]}, {"byteLength", v["byteLength"]}, {"byteStride", stride}, {"count", count}, {"mode", mode}};
        if (filter) extension["filter"] = filter;
        if (mode == std::string("ATTRIBUTES")) v["byteStride"] = stride;
        v["buffer"] = 1, v["byteOffset"] = 0, v["byteLength"] = count * stride;
        doc["bufferViews"][size_t(where)] = v;
        return where;
    }
    template <class T>
    int attributes(const std::vector<T>& data, size_t count, const char* filter = nullptr) {
        const size_t stride = data.size() * sizeof(T) / count;
        std::vector<uint8_t> bytes(meshopt_encodeVertexBufferBound(count, stride));
        bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), data.data(), count, stride));
        return add(bytes, "ATTRIBUTES", count, stride, filter);
    }
    int triangles(const std::vector<uint32_t>& data, size_t stride, size_t vertices) {
        std::vector<uint8_t> bytes(meshopt_encodeIndexBufferBound(data.size(), vertices));
        bytes.resize(meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), data.data(), data.size()));
        return add(bytes, "TRIANGLES", data.size(), stride);
    }
    int sequence(const std::vector<uint32_t>& data, size_t stride, size_t vertices) {
        std::vector<uint8_t> bytes(meshopt_encodeIndexSequenceBound(data.size(), vertices));
        bytes.resize(meshopt_encodeIndexSequence(bytes.data(), bytes.size(), data.data(), data.size()));
        return add(bytes, "INDICES", data.size(), stride);
    }
    int positions(const std::vector<float>& data, const char* filter = nullptr) {
        const int a = accessor(attributes(data, data.size() / 3, filter), f32, "VEC3", data.size() / 3);
        if (!filter) bound(a, data);
        return a;
    }
    // With buffer 1, a fallback that holds nothing, the way gltfpack writes it.
    std::string write_with_fallback(bool glb, const json& uri = nullptr) {
        const std::string path = write(glb);
        doc["buffers"].push_back({{"byteLength", 1 << 20}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
        if (!uri.is_null()) doc["buffers"][1]["uri"] = uri;
        if (!glb) return file("test.gltf", doc.dump());
        std::string text = doc.dump(), out = "glTF";
        text.resize((text.size() + 3) & ~size_t(3), ' ');
        const auto word = [&](size_t w) { for (int s = 0; s < 32; s += 8) out.push_back(char(w >> s)); };
        word(2), word(28 + text.size() + bin.size()), word(text.size()), word(0x4E4F534A);
        out += text;
        word(bin.size()), word(0x004E4942);
        out.append(reinterpret_cast<char*>(bin.data()), bin.size());
        return file("test.glb", out);
    }
    void expect_refused_here(std::initializer_list<const char*> words) {
        const std::string message = refused(write_with_fallback(false));
        for (const char* word : words) EXPECT_NE(message.find(word), std::string::npos) << message << "\n  lacks: " << word;
    }
};

// A bumpy grid of n x n vertices.
struct Grid {
    std::vector<float> positions;
    std::vector<uint32_t> indices;
    explicit Grid(uint32_t n) {
        std::mt19937 random(1);
        for (uint32_t i = 0; i < n * n; ++i) positions.insert(positions.end(), {float(i % n), float(i / n), float(random() % 1000) / 1000});
        for (uint32_t y = 0; y + 1 < n; ++y)
            for (uint32_t x = 0; x + 1 < n; ++x) {
                const uint32_t a = y * n + x;
                indices.insert(indices.end(), {a, a + 1, a + n, a + n, a + 1, a + n + 1});
            }
    }
};

// The same triangles, whichever corner each begins with: the triangle codec may turn them.
std::vector<uint32_t> normal_form(std::vector<uint32_t> t) {
    for (size_t i = 0; i + 2 < t.size(); i += 3) {
        const auto least = std::min_element(t.begin() + std::ptrdiff_t(i), t.begin() + std::ptrdiff_t(i) + 3);
        std::rotate(t.begin() + std::ptrdiff_t(i), least, t.begin() + std::ptrdiff_t(i) + 3);
    }
    return t;
}

TEST_F(GltfMeshopt, AttributesTrianglesAndFallbackBuffers) {
    const Grid grid(40);
    for (size_t stride : {2, 4}) {
        doc.erase("bufferViews"), doc.erase("accessors"), bin.clear();
        primitive()["attributes"]["POSITION"] = positions(grid.positions);
        primitive()["indices"] = accessor(triangles(grid.indices, stride, 1600), stride == 2 ? u16 : u32, "SCALAR", grid.indices.size());
        for (bool glb : {false, true})
            for (const json& uri : {json(), json("no-such-file.bin")}) {  // a fallback is never opened
                valid = uri.is_null();
                const Primitive p = read_file(write_with_fallback(glb, uri)).meshes.at(0).primitives.at(0);
                ASSERT_EQ(p.positions.size(), 1600u);
                for (size_t i = 0; i < 1600; ++i)
                    for (int c = 0; c < 3; ++c) ASSERT_EQ(p.positions[i][c], grid.positions[3 * i + size_t(c)]);
                EXPECT_EQ(normal_form(p.indices), normal_form(grid.indices));
            }
    }
}

TEST_F(GltfMeshopt, IndexSequences) {
    const std::vector<uint32_t> strip = {0, 1, 2, 3, 4, 5};
    for (size_t stride : {2, 4}) {
        primitive() = {{"mode", 5}};
        primitive()["attributes"]["POSITION"] = positions(Grid(3).positions);
        primitive()["indices"] = accessor(sequence(strip, stride, 9), stride == 2 ? u16 : u32, "SCALAR", strip.size());
        EXPECT_EQ(read_file(write_with_fallback(true)).meshes[0].primitives[0].indices, (std::vector<uint32_t>{0, 1, 2, 1, 3, 2, 2, 3, 4, 3, 5, 4}));
    }
}

// By hand, from appendix A of the extension: a header, one block in which each of four bytes changes by nothing, and a tail
// of 32 bytes that ends in the first element.
TEST_F(GltfMeshopt, BytesWrittenByHand) {
    std::vector<uint8_t> bytes = {0xa0, 0, 0, 0, 0};
    bytes.resize(5 + 28, 0);
    bytes.insert(bytes.end(), {51, 102, 255, 0});
    square();
    primitive()["attributes"]["COLOR_0"] = accessor(add(bytes, "ATTRIBUTES", 4, 4), u8, "VEC3", 4, 0, true);
    const Primitive p = read_file(write_with_fallback(true)).meshes[0].primitives[0];
    for (const glm::vec4& c : p.colors) expect_near(vec3(c), {.2f, .4f, 1}, 1e-6f);
}

std::vector<glm::vec4> unit_vectors(size_t count) {
    std::mt19937 random(2);
    std::normal_distribution<float> gauss;
    std::vector<glm::vec4> out(count);
    for (auto& v : out) v = glm::normalize(glm::vec4(gauss(random), gauss(random), gauss(random), 0));
    return out;
}

TEST_F(GltfMeshopt, OctahedralFilter) {
    const size_t count = 300;
    const std::vector<glm::vec4> normals = unit_vectors(count);
    doc["extensionsUsed"].push_back("KHR_mesh_quantization"), doc["extensionsRequired"].push_back("KHR_mesh_quantization");
    primitive()["attributes"]["POSITION"] = positions(std::vector<float>(3 * count, 1));
    for (size_t stride : {4, 8}) {
        std::vector<uint8_t> encoded(count * stride);
        meshopt_encodeFilterOct(encoded.data(), count, stride, stride == 4 ? 8 : 16, &normals[0].x);
        primitive()["attributes"]["NORMAL"] = accessor(attributes(encoded, count, "OCTAHEDRAL"), stride == 4 ? i8 : i16, "VEC3", count, 0, true);
        const Primitive p = read_file(write_with_fallback(true)).meshes[0].primitives[0];
        ASSERT_EQ(p.normals.size(), p.positions.size());
        for (size_t i = 0; i < p.normals.size(); ++i) expect_near(p.normals[i], vec3(normals[i]), stride == 4 ? 0.02f : 1e-4f);
    }
}

TEST_F(GltfMeshopt, ExponentialFilter) {
    const size_t count = 99;  // of a list without indices, three by three
    std::vector<float> positions = Grid(10).positions;
    positions.resize(3 * count);
    std::vector<float> encoded(3 * count);
    for (float& x : positions) x = x * 1000 + 1e-3f;
    meshopt_encodeFilterExp(encoded.data(), count, 12, 20, positions.data());
    primitive()["attributes"]["POSITION"] = this->positions(encoded, "EXPONENTIAL");
    valid = false;  // it has no bounds: they are those of the rounded values
    const Primitive p = read_file(write_with_fallback(true)).meshes[0].primitives[0];
    ASSERT_EQ(p.positions.size(), count);
    for (size_t i = 0; i < p.positions.size(); ++i)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(p.positions[i][c], positions[3 * i + size_t(c)], 0.02f);  // 2^14 / 2^19
}

TEST_F(GltfMeshopt, QuaternionFilterOfInstances) {
    const size_t count = 50;
    std::mt19937 random(3);
    std::normal_distribution<float> gauss;
    std::vector<glm::vec4> rotations(count);
    for (auto& q : rotations) q = glm::normalize(glm::vec4(gauss(random), gauss(random), gauss(random), gauss(random)));
    std::vector<uint8_t> encoded(count * 8);
    meshopt_encodeFilterQuat(encoded.data(), count, 8, 16, &rotations[0].x);
    square();
    doc["extensionsUsed"].push_back("EXT_mesh_gpu_instancing");
    doc["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["ROTATION"] =
        accessor(attributes(encoded, count, "QUATERNION"), i16, "VEC4", count, 0, true);
    const Scene scene = read_file(write_with_fallback(true));
    ASSERT_EQ(scene.instances.size(), count);
    for (size_t i = 0; i < count; ++i) {
        // Where the quaternion takes (1, 0, 0), by its textbook formula.
        const glm::vec4 q = rotations[i];
        const vec3 x(1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y + q.z * q.w), 2 * (q.x * q.z - q.y * q.w));
        expect_near(vec3(scene.instances[i].to_world[0]), x, 1e-3f);
    }
}

TEST_F(GltfMeshopt, ImagesAndSparsePartsMayBeCompressedToo) {
    square();
    const int values = attributes(std::vector<float>{5, 6, 7}, 1);
    doc["bufferViews"][size_t(values)].erase("byteStride");
    doc["accessors"][0]["sparse"] = {{"count", 1},
                                     {"indices", {{"bufferView", sequence({2}, 2, 4)}, {"componentType", u16}}},
                                     {"values", {{"bufferView", values}}}};
    valid = false;  // nor has this
    expect_near(read_file(write_with_fallback(true)).meshes[0].primitives[0].positions[2], {5, 6, 7});
}

TEST_F(GltfMeshopt, BrokenOnesAreRefused) {
    const Grid grid(10);
    const int positions = attributes(grid.positions, 100);
    primitive()["attributes"]["POSITION"] = accessor(positions, f32, "VEC3", 100);
    primitive()["indices"] = accessor(triangles(grid.indices, 2, 100), u16, "SCALAR", grid.indices.size());
    const json good = doc;
    const auto broken = [&](const char* key, const json& value, std::initializer_list<const char*> words) {
        doc = good;
        if (value.is_null()) compressed(positions).erase(key);
        else compressed(positions)[key] = value;
        expect_refused_here(words);
        expect_refused_here({"primitive 0 POSITION", "EXT_meshopt_compression"});
    };
    broken("buffer", 7, {"there is no buffer 7"});
    broken("buffer", -1, {"buffer is not an index"});
    broken("buffer", nullptr, {"buffer is missing"});
    broken("buffer", 1, {"beyond buffer 1, which has 0 bytes"});  // a fallback holds no compressed data
    broken("byteLength", 1 << 24, {"beyond buffer 0"});
    broken("byteLength", 20, {"cannot be decoded"});
    broken("byteOffset", 1 << 30, {"beyond buffer 0"});
    broken("byteOffset", 1, {"cannot be decoded"});
    broken("count", nullptr, {"count is missing"});
    broken("count", 99, {"do not fill the buffer view"});
    broken("byteStride", 3, {"stride 3"});
    broken("byteStride", 260, {"stride 260"});
    broken("byteStride", 0, {"stride 0"});
    broken("mode", "TRIANGLES", {"mode \"TRIANGLES\""});
    broken("mode", 1, {"mode is not a text"});
    broken("mode", "PIXELS", {"mode \"PIXELS\""});
    broken("filter", "OCTAHEDRAL", {"filter \"OCTAHEDRAL\""});
    broken("filter", "QUATERNION", {"filter \"QUATERNION\""});
    broken("filter", "COLOR", {"filter \"COLOR\""});
    doc = good;
    // A few bytes that promise gigabytes.
    compressed(positions)["count"] = 2000000000;
    doc["bufferViews"][size_t(positions)]["byteLength"] = 24000000000;
    expect_refused_here({"POSITION", "out of all proportion"});
    doc = good;
    valid = false;
    EXPECT_EQ(read_file(write_with_fallback(false)).meshes[0].primitives[0].positions.size(), 100u);  // the checks can pass
    // A damaged byte is refused or read, and what is read stays in range.
    const std::vector<uint8_t> bytes = bin;
    for (size_t i = 0; i < bytes.size(); i += 7) {
        bin = bytes;
        bin[i] ^= 0x5a;
        try {
            Scene scene = load(write_with_fallback(true));
            flatten(scene);
        } catch (const InputError&) {
        }
    }
}

}  // namespace
}  // namespace myriad::scenes
