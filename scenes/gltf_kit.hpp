// glTF files under construction, for tests. Tests only.
#pragma once

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>

#include <unistd.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/error.hpp"
#include "scenes/refusal.hpp"
#include "scenes/scene.hpp"

namespace myriad::scenes {

using glm::vec3;
using nlohmann::json;

enum : int { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };

// A glTF file under construction: a JSON document and one binary buffer. Each test has a folder of its own.
class Gltf : public testing::Test {
protected:
    void SetUp() override {
        const auto* info = testing::UnitTest::GetInstance()->current_test_info();
        folder = std::filesystem::temp_directory_path() / ("myriad_gltf_" + std::string(info->name()) + "_" + std::to_string(::getpid()));
        std::filesystem::create_directories(folder);
        doc = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}, {"nodes", {{{"mesh", 0}}}}};
    }
    void TearDown() override { std::filesystem::remove_all(folder); }

    template <class T>
    int view(const std::vector<T>& data, int stride = 0) {
        while (bin.size() % 4) bin.push_back(0);
        json v = {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", data.size() * sizeof(T)}};
        if (stride) v["byteStride"] = stride;
        const auto* bytes = reinterpret_cast<const uint8_t*>(data.data());
        bin.insert(bin.end(), bytes, bytes + data.size() * sizeof(T));
        doc["bufferViews"].push_back(v);
        return int(doc["bufferViews"].size()) - 1;
    }
    int accessor(int view, int type, const char* shape, size_t count, size_t offset = 0, bool normalized = false) {
        json a = {{"bufferView", view}, {"componentType", type}, {"type", shape}, {"count", count}, {"byteOffset", offset}};
        if (normalized) a["normalized"] = true;
        doc["accessors"].push_back(a);
        return int(doc["accessors"].size()) - 1;
    }
    int positions() { return accessor(view(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}), f32, "VEC3", 4); }
    template <class T>
    int indices(int type, const std::vector<T>& data) { return accessor(view(data), type, "SCALAR", data.size()); }

    json& primitive() {
        if (!doc.contains("meshes")) doc["meshes"] = {{{"name", "roof"}, {"primitives", {json::object()}}}};
        return doc["meshes"][0]["primitives"][0];
    }
    // Bounds that are known: those of positions in plain buffers are found by write().
    void bound(int accessor, const std::vector<float>& values) {
        json& a = doc["accessors"][size_t(accessor)];
        for (size_t c = 0; c < 3; ++c) {
            float lo = values[c], hi = lo;
            for (size_t i = c; i < values.size(); i += 3) lo = std::min(lo, values[i]), hi = std::max(hi, values[i]);
            a["min"][c] = lo, a["max"][c] = hi;
        }
    }
    // Texture coordinates for the square, both sets.
    void add_texcoords() {
        for (const char* set : {"TEXCOORD_0", "TEXCOORD_1"})
            primitive()["attributes"][set] = accessor(view(std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}), f32, "VEC2", 4);
    }
    // The unit square as four vertices and two triangles.
    void square() {
        primitive()["attributes"]["POSITION"] = positions();
        primitive()["indices"] = indices<uint16_t>(u16, {0, 1, 2, 0, 2, 3});
    }

    std::string write(bool glb = false) {
        declare_extensions();
        bound_positions();
        bin.resize(std::max<size_t>((bin.size() + 3) & ~size_t(3), 4));
        doc["buffers"] = {{{"byteLength", bin.size()}}};
        if (!glb) {
            doc["buffers"][0]["uri"] = "data.bin";
            std::ofstream(folder / "data.bin", std::ios::binary).write(reinterpret_cast<char*>(bin.data()), std::streamsize(bin.size()));
            return file("test.gltf", doc.dump());
        }
        std::string text = doc.dump();
        text.resize((text.size() + 3) & ~size_t(3), ' ');
        std::string out = "glTF";
        const auto word = [&](size_t w) { for (int s = 0; s < 32; s += 8) out.push_back(char(w >> s)); };
        word(2), word(28 + text.size() + bin.size()), word(text.size()), word(0x4E4F534A);
        out += text;
        word(bin.size()), word(0x004E4942);
        out.append(reinterpret_cast<char*>(bin.data()), bin.size());
        return file("test.glb", out);
    }
    std::string file(const char* name, const std::string& contents) {
        std::ofstream(folder / name, std::ios::binary) << contents;
        return (folder / name).string();
    }
    Scene read(bool glb = false) { return read_file(write(glb)); }
    Scene read_file(const std::string& path) {
        Scene scene = load(path);
        if (valid) keep(path);
        return scene;
    }

    std::string refused(const std::string& path) { return refusal(path, [&] { load(path); }); }
    void expect_refused(std::initializer_list<const char*> words) {
        const std::string message = refused(write());
        for (const char* word : words) EXPECT_NE(message.find(word), std::string::npos) << message << "\n  lacks: " << word;
    }

    bool valid = true;  // what this test reads is valid glTF, for tests/gltf_validator_test.sh to prove
    std::filesystem::path folder;
    json doc;
    std::vector<uint8_t> bin;

private:
    // Copies what was read to a folder of its own in $MYRIAD_KEEP_GLB, for other programs to judge.
    void keep(const std::string& path) {
        namespace fs = std::filesystem;
        if (!std::getenv("MYRIAD_KEEP_GLB")) return;
        const fs::path to = fs::path(std::getenv("MYRIAD_KEEP_GLB")) / (folder.filename().string() + "_" + std::to_string(kept_++));
        fs::copy(folder, to);
        for (const auto& entry : fs::directory_iterator(to))  // but no other scene, which is of some earlier step
            if (entry.path().filename() != fs::path(path).filename() && (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb"))
                fs::remove(entry);
    }

    // Whatever has extensions says so at the top.
    void declare_extensions() {
        std::set<std::string> names;
        const std::function<void(const json&)> search = [&](const json& value) {
            if (value.is_object() && value.contains("extensions") && value["extensions"].is_object())
                for (const auto& [name, extension] : value["extensions"].items()) names.insert(name);
            if (value.is_structured())
                for (const json& inner : value) search(inner);
        };
        search(doc);
        for (const char* list : {"extensionsUsed", "extensionsRequired"})
            if (doc.contains(list)) names.insert(doc[list].begin(), doc[list].end());
        if (!names.empty()) doc["extensionsUsed"] = names;
    }

    // glTF wants the bounds of positions. Where a test has broken the accessor, there are none.
    void bound_positions() {
        if (!doc.contains("meshes")) return;
        for (json& mesh : doc["meshes"])
            for (json& p : mesh["primitives"])
                try {
                    bound(doc.at("accessors").at(p.at("attributes").at("POSITION").get<size_t>()));
                } catch (const std::exception&) {
                }
    }

    double component(int type, size_t at) const {
        const auto as = [&](auto value) {
            if (at > bin.size() || bin.size() - at < sizeof value) throw std::out_of_range("bin");
            return std::memcpy(&value, bin.data() + at, sizeof value), double(value);
        };
        return type == i8 ? as(int8_t()) : type == u8 ? as(uint8_t()) : type == i16 ? as(int16_t()) : type == u16 ? as(uint16_t()) : type == u32 ? as(uint32_t()) : as(float());
    }

    void bound(json& accessor) {
        const int type = accessor.at("componentType");
        const size_t size = type == i8 || type == u8 ? 1 : type == i16 || type == u16 ? 2 : 4, count = accessor.at("count");
        if (count > 100000) return;
        std::vector<std::array<double, 3>> values(count);
        const auto fetch = [&](size_t target, const json& view, size_t offset, size_t index) {
            const size_t first = view.at("byteOffset").get<size_t>() + offset + index * view.value("byteStride", 3 * size);
            for (size_t c = 0; c < 3; ++c) values.at(target)[c] = component(type, first + c * size);
        };
        const json& views = doc.at("bufferViews");
        const auto of = [&](const json& part) -> const json& { return views.at(part.at("bufferView").get<size_t>()); };
        if (accessor.contains("bufferView")) {
            if (of(accessor).contains("extensions")) return;
            for (size_t i = 0; i < count; ++i) fetch(i, of(accessor), accessor.value("byteOffset", size_t(0)), i);
        }
        for (size_t i = 0; accessor.contains("sparse") && i < accessor["sparse"].at("count"); ++i) {
            const json &indices = accessor["sparse"].at("indices"), &replaced = accessor["sparse"].at("values");
            const int index_type = indices.at("componentType");
            const size_t index_size = index_type == u8 ? 1 : index_type == u16 ? 2 : 4;
            const double target = component(index_type, of(indices).at("byteOffset").get<size_t>() + indices.value("byteOffset", size_t(0)) + i * index_size);
            fetch(size_t(target), of(replaced), replaced.value("byteOffset", size_t(0)), i);
        }
        for (const char* end : {"min", "max"})
            for (size_t c = 0; c < 3; ++c) {
                const auto less = [&](const auto& a, const auto& b) { return a[c] < b[c]; };
                accessor[end][c] = (end[1] == 'i' ? *std::min_element(values.begin(), values.end(), less)
                                                                 : *std::max_element(values.begin(), values.end(), less))[c];
            }
    }

    int kept_ = 0;
};

inline void expect_near(const vec3& a, const vec3& b, float tolerance = 1e-5f) {
    EXPECT_LE(glm::length(a - b), tolerance) << a.x << " " << a.y << " " << a.z << " is not " << b.x << " " << b.y << " " << b.z;
}

}  // namespace myriad::scenes
