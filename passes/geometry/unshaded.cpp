#include "passes/geometry/unshaded.hpp"

#include <algorithm>

namespace myriad::passes {
namespace {

using scenes::Material, scenes::TextureUse;

bool moved(const TextureUse& use) { return use.texture != scenes::none && (use.set != 0 || use.transform != TextureUse{}.transform); }

bool any_moved(const Material& m) {
    return moved(m.base_color_texture) || moved(m.metallic_roughness_texture) || moved(m.emissive_texture);
}

}  // namespace

std::string unshaded(const scenes::Scene& scene) {
    std::string list;
    const auto add = [&](size_t count, const std::string& what) {
        if (count > 0) list += (list.empty() ? "" : ", ") + std::to_string(count) + " " + what;
    };
    const auto materials = [&](auto&& which) { return size_t(std::count_if(scene.materials.begin(), scene.materials.end(), which)); };
    add(materials([](const Material& m) { return m.alpha != Material::Alpha::opaque; }), "materials with alpha (opaque here)");
    add(materials([](const Material& m) { return m.normal_texture.texture != scenes::none; }), "with a normal map (smooth here)");
    add(materials(any_moved), "with transformed textures or a second set of coordinates (as the first set says here)");
    add(materials([](const Material& m) { return m.unlit; }), "unlit (lit here)");
    size_t colored = 0;
    for (const scenes::Mesh& mesh : scene.meshes)
        for (const scenes::Primitive& primitive : mesh.primitives) colored += !primitive.colors.empty();
    add(colored, "primitives with vertex colours (without them here)");
    if (scene.background != glm::vec3(0)) list += std::string(list.empty() ? "" : ", ") + "the sky behind the scene (black here)";
    return list.empty() ? list : "not shaded yet: " + list + ".";
}

}  // namespace myriad::passes
