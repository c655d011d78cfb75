#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "engine/error.hpp"
#include "scenes/moment.hpp"
#include "tests/fuzz/input_file.hpp"
#include "tests/fuzz/targets.hpp"

namespace myriad::fuzz {
namespace {

// Not assert(): a finding must be one in every build.
void demand(bool holds, const char* what) {
    if (holds) return;
    std::fprintf(stderr, "a promise of the loader does not hold: %s\n", what);
    std::abort();
}

template <class Vector>
bool finite(const Vector& v) {
    for (int i = 0; i < v.length(); ++i)
        if (!std::isfinite(v[i])) return false;
    return true;
}

// As a GLB, where the input is JSON and a binary chunk; see targets.hpp.
std::string as_file(const uint8_t* data, size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    const size_t zero = text.find('\0');
    if (text.starts_with("glTF") || zero == std::string::npos) return text;
    std::string json = text.substr(0, zero), bin = text.substr(zero + 1), out = "glTF";
    json.resize((json.size() + 3) & ~size_t(3), ' ');
    bin.resize((bin.size() + 3) & ~size_t(3), '\0');
    const auto word = [&](size_t w) {
        for (int shift = 0; shift < 32; shift += 8) out.push_back(char(w >> shift));
    };
    word(2), word(28 + json.size() + bin.size()), word(json.size()), word(0x4E4F534A);
    out += json;
    word(bin.size()), word(0x004E4942);
    return out + bin;
}

void check(const scenes::Scene& scene) {
    demand(!scene.materials.empty(), "there is a material");
    for (const auto& texture : scene.textures)
        demand(texture.rgba.size() == size_t(texture.width) * texture.height * 4 && !texture.rgba.empty(), "a texture has its pixels");
    for (const auto& m : scene.materials) {
        for (const auto& use : {m.base_color_texture, m.metallic_roughness_texture, m.emissive_texture, m.normal_texture}) {
            demand(use.texture == scenes::none || use.texture < scene.textures.size(), "a material's texture exists");
            demand(finite(use.transform[0]) && finite(use.transform[1]) && finite(use.transform[2]), "a texture's transform is finite");
        }
        demand(finite(m.base_color) && finite(m.emissive) && std::isfinite(m.metallic + m.roughness + m.normal_scale + m.alpha_cutoff),
               "a material is finite");
    }
    for (const auto& mesh : scene.meshes)
        for (const auto& p : mesh.primitives) {
            demand(p.material < scene.materials.size() && p.indices.size() % 3 == 0, "a primitive is triangles with a material");
            for (const uint32_t i : p.indices) demand(i < p.positions.size(), "an index is in range");
            for (const size_t n : {p.normals.size(), p.tangents.size(), p.texcoords.size(), p.texcoords1.size(), p.colors.size()})
                demand(n == 0 || n == p.positions.size(), "attributes are as many as positions");
        }
    for (const auto& instance : scene.instances) demand(instance.mesh < scene.meshes.size(), "an instance's mesh exists");
    const auto node = [&](uint32_t i) { return i == scenes::none || i < scene.nodes.size(); };
    for (size_t i = 0; i < scene.nodes.size(); ++i)
        demand(scene.nodes[i].parent == scenes::none || scene.nodes[i].parent < i, "a node comes after its parent");
    for (const auto& instance : scene.instances)
        demand(node(instance.node) && (instance.skin == scenes::none || (instance.skin < scene.skins.size() && instance.node != scenes::none)), "an instance's node and skin exist");
    for (const auto& skin : scene.skins)
        for (const uint32_t joint : skin.joints) demand(joint < scene.nodes.size(), "a joint exists");
    for (const auto& clip : scene.clips)
        for (const auto& channel : clip.channels) demand(channel.node < scene.nodes.size() && channel.track < clip.tracks.size(), "a channel's node and track exist");
    for (const auto& light : scene.lights)
        demand(finite(light.position) && finite(light.direction) && finite(light.intensity), "a light is finite");
    for (const auto& camera : scene.cameras)
        for (int c = 0; c < 4; ++c) demand(finite(camera.to_world[c]) && camera.yfov > 0, "a camera is finite");
}

void check(const scenes::Triangles& t, const scenes::Scene& scene) {
    for (const auto& c : t.triangles) {
        demand(c.x < t.positions.size() && c.y < t.positions.size() && c.z < t.positions.size() && c.w < scene.materials.size(),
               "a triangle's numbers are in range");
    }
    demand(t.normals.size() == t.positions.size() && t.texcoords.size() == t.positions.size(), "every vertex has a normal");
    for (size_t i = 0; i < t.positions.size(); ++i) {
        demand(finite(t.positions[i]), "positions are finite");
        demand(std::abs(glm::length(t.normals[i]) - 1) < 1e-3f, "normals are unit");
        demand(finite(t.texcoords[i]), "texture coordinates are finite");
    }
    for (const auto& c : t.colors) demand(finite(c), "colours are finite");
    for (const auto& c : t.tangents) demand(finite(c), "tangents are finite");
    for (const auto& c : t.texcoords1) demand(finite(c), "texture coordinates are finite");
}

// All clips together, at a few moments.
void play(scenes::Scene& scene) {
    if (scene.clips.empty()) return;
    scenes::Triangles triangles = scenes::flatten(scene, scenes::Sharing::automatic, scenes::pick_clips(scene, "all"));
    check(triangles, scene);
    for (const double seconds : {0.0, 0.3, -7.0, 1e6}) {
        scenes::deform(triangles, scenes::moment_at(scene, triangles.motion, seconds));
        check(triangles, scene);
    }
}

}  // namespace

void gltf(const uint8_t* data, size_t size) {
    static const InputFolder folder;
    [[maybe_unused]] static const bool filled = [] {  // with what the seeds refer to
        const std::string picture = seeds("picture").front(), buffer(256, '\1');
        for (const char* name : {"data.bin", "sub/data.bin"}) folder.put(name, buffer.data(), buffer.size());
        folder.put("picture.png", picture.data(), picture.size());
        return true;
    }();
    const std::string bytes = as_file(data, size), path = folder.put("scene.glb", bytes.data(), bytes.size());
    try {
        scenes::Scene scene = scenes::load(path);
        check(scene);
        const scenes::Triangles triangles = scenes::flatten(scene);
        check(triangles, scene);
        scenes::pick_camera(scene, triangles, "");
        play(scene);
        for (const auto& warning : scene.warnings) demand(warning.size() < 2000, "a warning is short");
    } catch (const Error& e) {
        const std::string message = e.what();
        demand(message.starts_with(path) && message.size() < 2000, "a message names the file and is short");
    }
}

}  // namespace myriad::fuzz
