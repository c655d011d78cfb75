#include "scenes/gltf/material.hpp"

#include <algorithm>
#include <cmath>

#include "scenes/gltf/texture.hpp"

namespace myriad::scenes::gltf {
namespace {

float factor(double value) { return float(std::clamp(value, 0.0, 1.0)); }

float emissive_strength(const Place& place, const tinygltf::Material& material) {
    const tinygltf::Value* strength = extension(material, "KHR_materials_emissive_strength");
    const double value = strength ? number_in(place, *strength, "emissiveStrength", 1) : 1;
    if (!(value >= 0 && value <= limits::light)) place.fail("emissiveStrength is not a number from 0 to 1e18", "correct it");
    return float(value);
}

void read_alpha(const Place& place, const tinygltf::Material& in, Material& out) {
    if (in.alphaMode == "MASK") out.alpha = Material::Alpha::mask;
    else if (in.alphaMode == "BLEND") out.alpha = Material::Alpha::blend;
    else if (in.alphaMode != "OPAQUE") place.fail("alphaMode is \"" + in.alphaMode + "\"", "use OPAQUE, MASK or BLEND");
    if (!std::isfinite(in.alphaCutoff) || in.alphaCutoff < 0) place.fail("alphaCutoff is not a number from 0 on", "correct it");
    out.alpha_cutoff = float(std::min(in.alphaCutoff, 2.0));  // above 1 nothing is left, however far above
}

Material read_material(const Place& place, const tinygltf::Material& in, Textures& textures) {
    const auto& pbr = in.pbrMetallicRoughness;
    Material out;
    out.name = in.name;
    for (int c = 0; c < 4; ++c)
        if (size_t(c) < pbr.baseColorFactor.size()) out.base_color[c] = factor(pbr.baseColorFactor[size_t(c)]);
    out.base_color_texture = textures.use(place, pbr.baseColorTexture);
    read_alpha(place, in, out);
    out.double_sided = in.doubleSided;
    out.unlit = extension(in, "KHR_materials_unlit") != nullptr;
    if (out.unlit) return out;  // base colour and alpha are all that counts then
    out.metallic = factor(pbr.metallicFactor);
    out.roughness = factor(pbr.roughnessFactor);
    out.metallic_roughness_texture = textures.use(place, pbr.metallicRoughnessTexture);
    const float strength = emissive_strength(place, in);
    for (int c = 0; c < 3; ++c)
        if (size_t(c) < in.emissiveFactor.size()) out.emissive[c] = factor(in.emissiveFactor[size_t(c)]) * strength;
    if (out.emissive != glm::vec3(0)) out.emissive_texture = textures.use(place, in.emissiveTexture);
    if (!(std::abs(in.normalTexture.scale) <= limits::factor)) place.fail("the scale of its normal texture is not a number up to a million", "correct it");
    out.normal_scale = float(in.normalTexture.scale);
    if (out.normal_scale != 0) out.normal_texture = textures.use(place, in.normalTexture);
    return out;
}

}  // namespace

void read_materials(const Place& place, Scene& scene) {
    const size_t count = place.model.materials.size();
    std::vector<bool> used(count, false);
    bool needs_default = count == 0;
    for (Mesh& mesh : scene.meshes)
        for (Primitive& primitive : mesh.primitives) {
            if (primitive.material != none) used[primitive.material] = true;
            else primitive.material = uint32_t(count), needs_default = true;
        }
    Textures textures(place, scene);
    for (size_t i = 0; i < count; ++i) {
        const auto& in = place.model.materials[i];
        textures.skip(!used[i]);
        scene.materials.push_back(read_material(place.at("material " + std::to_string(i) + " " + quote(in.name)), in, textures));
    }
    if (needs_default) scene.materials.push_back({.name = "default"});  // white, metallic 1, roughness 1: what Material starts as
    textures.warn();
}

}  // namespace myriad::scenes::gltf
