#include "scenes/gltf/texture.hpp"

#include <array>
#include <cmath>

#include "scenes/gltf/image.hpp"

namespace myriad::scenes::gltf {
namespace {

// Extensions that bring an image in another format beside the one of core glTF, or instead of it.
constexpr std::array other_formats = {"KHR_texture_basisu", "EXT_texture_webp", "EXT_texture_avif", "MSFT_texture_dds", "EXT_texture_astc"};

Texture::Wrap wrap(int mode) {
    if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Texture::Wrap::clamp;
    return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Texture::Wrap::mirror : Texture::Wrap::repeat;
}

}  // namespace

// The extension's text: scale, then turn the coordinates counter-clockwise as seen with v downwards, then move. The GLSL
// in that text turns the other way; its examples, and every implementation that it lists, turn this way.
glm::mat3x2 texture_transform(const Place& place, const tinygltf::Value& extension) {
    const glm::dvec2 offset = pair_in(place, extension, "offset", glm::dvec2(0)), scale = pair_in(place, extension, "scale", glm::dvec2(1));
    const double angle = number_in(place, extension, "rotation", 0), c = std::cos(angle), s = std::sin(angle);
    for (const double number : {offset.x, offset.y, scale.x, scale.y})
        if (std::abs(number) > limits::factor) place.fail("its offset or scale is beyond a million", "correct it");
    return glm::mat3x2(scale.x * c, -scale.x * s, scale.y * s, scale.y * c, offset.x, offset.y);
}

TextureUse Textures::use(const Place& material, int texture, int set, const tinygltf::Value* transform) {
    TextureUse out;
    if (transform) {
        const Place here = material.at(texture_transform_extension);
        out.transform = texture_transform(here, *transform);
        set = index_in(here, *transform, "texCoord").value_or(set);
    }
    if (set < 0 || set > 1) ++other_sets_, set = 0;
    out.set = uint32_t(set);
    out.texture = number(material, texture);
    return out;
}

uint32_t Textures::number(const Place& material, int index) {
    const auto& model = place_.model;
    const std::string name = "texture " + std::to_string(index);
    if (size_t(index) >= model.textures.size()) material.fail("there is no " + name, "export the file again");
    const auto& texture = model.textures[size_t(index)];
    const Place here = place_.at(name);
    if (texture.source < 0) {
        for (const char* format : other_formats)
            if (extension(texture, format))
                here.fail("it has its image only in the format of " + std::string(format) + ", which Myriad does not read",
                          "store the image as PNG or JPEG too");
        here.fail("it has no image", "store its image as PNG or JPEG");
    }
    if (size_t(texture.source) >= model.images.size())
        here.fail("there is no image " + std::to_string(texture.source), "export the file again");
    Texture out;
    if (texture.sampler >= 0) {
        if (size_t(texture.sampler) >= model.samplers.size())
            here.fail("there is no sampler " + std::to_string(texture.sampler), "export the file again");
        const auto& sampler = model.samplers[size_t(texture.sampler)];
        out.wrap_u = wrap(sampler.wrapS);
        out.wrap_v = wrap(sampler.wrapT);
    }
    const auto [known, is_new] = numbers_.try_emplace({texture.source, out.wrap_u, out.wrap_v}, uint32_t(scene_.textures.size()));
    if (is_new) {
        out.name = !texture.name.empty() ? texture.name : model.images[size_t(texture.source)].name;
        Picture picture = read_image(here, texture.source);
        out.width = picture.width, out.height = picture.height;
        out.rgba = std::move(picture.rgba);
        scene_.textures.push_back(std::move(out));
    }
    return known->second;
}

void Textures::warn() const {
    if (other_sets_)
        scene_.warnings.push_back(std::to_string(other_sets_) + " uses of a texture with coordinates other than TEXCOORD_0 and TEXCOORD_1 take TEXCOORD_0.");
}

}  // namespace myriad::scenes::gltf
