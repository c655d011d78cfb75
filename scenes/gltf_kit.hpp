// glTF files under construction, for tests. Tests only.
#pragma once

#include <filesystem>
#include <fstream>

#include <unistd.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/error.hpp"
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
    // The unit square as four vertices and two triangles.
    void square() {
        primitive()["attributes"]["POSITION"] = positions();
        primitive()["indices"] = indices<uint16_t>(u16, {0, 1, 2, 0, 2, 3});
    }

    std::string write(bool glb = false) {
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
    Scene read(bool glb = false) { return load(write(glb)); }

    // The message that refuses the file; it must name the file and be one line.
    std::string refused(const std::string& path) {
        try {
            load(path);
        } catch (const InputError& e) {
            const std::string message = e.what();
            EXPECT_EQ(message.find(path), 0u) << message;
            EXPECT_EQ(message.find('\n'), std::string::npos) << message;
            EXPECT_EQ(message.back(), '.') << message;
            return message;
        }
        return "(accepted)";
    }
    void expect_refused(std::initializer_list<const char*> words) {
        const std::string message = refused(write());
        for (const char* word : words) EXPECT_NE(message.find(word), std::string::npos) << message << "\n  lacks: " << word;
    }

    std::filesystem::path folder;
    json doc;
    std::vector<uint8_t> bin;
};

inline void expect_near(const vec3& a, const vec3& b, float tolerance = 1e-5f) {
    EXPECT_LE(glm::length(a - b), tolerance) << a.x << " " << a.y << " " << a.z << " is not " << b.x << " " << b.y << " " << b.z;
}

}  // namespace myriad::scenes
