#include "scenes/gltf.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <new>
#include <set>

#include "engine/error.hpp"
#include "scenes/gltf/accessor.hpp"
#include "scenes/gltf/animation.hpp"
#include "scenes/gltf/container.hpp"
#include "scenes/gltf/material.hpp"
#include "scenes/gltf/mesh.hpp"
#include "scenes/gltf/nodes.hpp"
#include "scenes/gltf/skin.hpp"

namespace myriad::scenes {
namespace {

using gltf::Place;

// Those of textures in other formats are not here: where a file does not require them, their textures have a core image too.
constexpr std::array supported_extensions = {"EXT_mesh_gpu_instancing", "EXT_meshopt_compression", "KHR_draco_mesh_compression",
                                             "KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_materials_unlit",
                                             "KHR_mesh_quantization", "KHR_texture_transform"};

bool supported(const std::string& extension) {
    return std::find(supported_extensions.begin(), supported_extensions.end(), extension) != supported_extensions.end();
}

void check_extensions(const Place& place, Scene& scene) {
    for (const auto& name : place.model.extensionsRequired)
        if (!supported(name)) place.fail("the file requires the extension " + gltf::quote(name) + ", which Myriad does not have", "export without it");
    std::set<std::string> ignored;
    for (const auto& name : place.model.extensionsUsed)
        if (!supported(name)) ignored.insert(name);
    if (ignored.empty()) return;
    constexpr size_t most = 10;
    std::string text;
    size_t count = 0;
    for (const auto& name : ignored)
        if (count++ < most) text += (text.empty() ? "ignored extensions: " : ", ") + gltf::shown(name);
    scene.warnings.push_back(text + (count > most ? " and " + std::to_string(count - most) + " more." : "."));
}

}  // namespace

FileAndChoice split_choice(const std::string& source) {
    std::error_code error;
    const size_t hash = source.rfind('#');
    const bool chosen = hash != std::string::npos && !std::filesystem::exists(source, error) && std::filesystem::exists(source.substr(0, hash), error);
    return chosen ? FileAndChoice{source.substr(0, hash), source.substr(hash + 1)} : FileAndChoice{source, ""};
}

Scene load_gltf(const std::string& path, const std::string& choice) try {
    std::string warnings;
    gltf::Document document = gltf::read_document(path, warnings);
    const tinygltf::Model& model = document.model;
    Scene scene;
    scene.name = path;
    const Place place{model, path, "", &document};
    check_extensions(place, scene);
    const int which = gltf::pick_scene(place, choice);
    const gltf::Hierarchy hierarchy = gltf::read_nodes(place, which, scene);  // first: what no instance shows is not read
    gltf::read_background(place, which, scene);
    gltf::read_meshes(place, scene);
    gltf::read_materials(place, scene);
    gltf::read_skins(place, hierarchy, scene);
    gltf::read_animations(place, hierarchy, scene);
    gltf::prune_nodes(scene);
    return scene;
} catch (const std::bad_alloc&) {
    throw OutOfMemory(path + ": the scene does not fit in memory; make it smaller.");
}

}  // namespace myriad::scenes
