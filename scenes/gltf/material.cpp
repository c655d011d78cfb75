#include "scenes/gltf/material.hpp"

#include <algorithm>
#include <map>

#include "engine/error.hpp"
#include "scenes/gltf/image.hpp"

namespace myriad::scenes::gltf {
namespace {

float factor(double value) { return float(std::clamp(value, 0.0, 1.0)); }

Texture::Wrap wrap(int mode) {
    if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Texture::Wrap::clamp;
    return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Texture::Wrap::mirror : Texture::Wrap::repeat;
}

// Decodes each texture once, when the first material asks for it.
class Textures {
public:
    Textures(const Place& place, Scene& scene) : place_(place), scene_(scene) {}

    uint32_t use(const Place& material, const tinygltf::TextureInfo& info) {
        if (info.index < 0) return none;
        if (info.texCoord != 0) other_set_ = true;
        const auto& model = place_.model;
        const std::string name = "texture " + std::to_string(info.index);
        if (size_t(info.index) >= model.textures.size()) material.fail("there is no " + name, "export the file again");
        if (const auto known = numbers_.find(info.index); known != numbers_.end()) return known->second;

        const auto& texture = model.textures[size_t(info.index)];
        const Place here = place_.at(name);
        if (texture.source < 0 || size_t(texture.source) >= model.images.size())
            here.fail("it has no image in a format of core glTF", "store its image as PNG or JPEG");
        const auto& image = model.images[size_t(texture.source)];
        Texture out;
        out.name = !texture.name.empty() ? texture.name : image.name;
        if (texture.sampler >= 0) {
            if (size_t(texture.sampler) >= model.samplers.size())
                here.fail("there is no sampler " + std::to_string(texture.sampler), "export the file again");
            const auto& sampler = model.samplers[size_t(texture.sampler)];
            out.wrap_u = wrap(sampler.wrapS);
            out.wrap_v = wrap(sampler.wrapT);
        }
        Picture picture = read_image(here, texture.source);
        out.width = picture.width, out.height = picture.height;
        out.rgba = std::move(picture.rgba);
        scene_.textures.push_back(std::move(out));
        return numbers_[info.index] = uint32_t(scene_.textures.size() - 1);
    }

    bool other_set() const { return other_set_; }

private:
    const Place& place_;
    Scene& scene_;
    std::map<int, uint32_t> numbers_;
    bool other_set_ = false;
};

float emissive_strength(const Place& place, const tinygltf::Material& material) {
    const auto it = material.extensions.find("KHR_materials_emissive_strength");
    if (it == material.extensions.end() || !it->second.Has("emissiveStrength")) return 1;
    const auto& value = it->second.Get("emissiveStrength");
    if (!value.IsNumber() || !(value.GetNumberAsDouble() >= 0) || value.GetNumberAsDouble() > 1e30)
        place.fail("emissiveStrength is not a number from 0 to 1e30", "correct it");
    return float(value.GetNumberAsDouble());
}

}  // namespace

void read_materials(const Place& place, Scene& scene) {
    Textures textures(place, scene);
    size_t transparent = 0;
    for (size_t i = 0; i < place.model.materials.size(); ++i) {
        const auto& in = place.model.materials[i];
        const auto& pbr = in.pbrMetallicRoughness;
        const Place here = place.at("material " + std::to_string(i) + " \"" + in.name + "\"");
        Material out;
        out.name = in.name;
        for (int c = 0; c < 4; ++c)
            if (size_t(c) < pbr.baseColorFactor.size()) out.base_color[c] = factor(pbr.baseColorFactor[size_t(c)]);
        out.metallic = factor(pbr.metallicFactor);
        out.roughness = factor(pbr.roughnessFactor);
        for (int c = 0; c < 3; ++c)
            if (size_t(c) < in.emissiveFactor.size())
                out.emissive[c] = factor(in.emissiveFactor[size_t(c)]) * emissive_strength(here, in);
        out.base_color_texture.texture = textures.use(here, pbr.baseColorTexture);
        out.metallic_roughness_texture.texture = textures.use(here, pbr.metallicRoughnessTexture);
        out.emissive_texture.texture = textures.use(here, in.emissiveTexture);
        out.double_sided = in.doubleSided;
        transparent += in.alphaMode != "OPAQUE";
        scene.materials.push_back(std::move(out));
    }
    if (transparent) scene.warnings.push_back(std::to_string(transparent) + " materials with alpha are rendered opaque.");
    if (textures.other_set()) scene.warnings.push_back("textures on texture coordinates other than TEXCOORD_0 are mapped by TEXCOORD_0.");
}

}  // namespace myriad::scenes::gltf
