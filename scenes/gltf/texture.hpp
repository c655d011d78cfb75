// Textures, their images, and how materials use them.
#pragma once

#include <map>
#include <tuple>

#include "scenes/gltf/value.hpp"
#include "scenes/scene.hpp"

namespace myriad::scenes::gltf {

inline constexpr const char* texture_transform_extension = "KHR_texture_transform";

// KHR_texture_transform as (u, v) on the texture = matrix * (u, v, 1).
glm::mat3x2 texture_transform(const Place& place, const tinygltf::Value& extension);

// Decodes an image once for each way of wrapping it, when the first material asks for it.
class Textures {
public:
    Textures(const Place& place, Scene& scene) : place_(place), scene_(scene) {}

    // `info` is one of tinygltf's three kinds of texture info.
    template <class Info>
    TextureUse use(const Place& material, const Info& info) {
        if (info.index < 0 || skip_) return {};
        return use(material, info.index, info.texCoord, extension(info, texture_transform_extension));
    }

    // From now on nothing is decoded, and every use is one of no texture: for materials that nobody wears.
    void skip(bool on) { skip_ = on; }

    // Appends to the scene's warnings what could not be kept.
    void warn() const;

private:
    TextureUse use(const Place& material, int texture, int set, const tinygltf::Value* transform);
    uint32_t number(const Place& material, int texture);

    const Place& place_;
    Scene& scene_;
    std::map<std::tuple<int, Texture::Wrap, Texture::Wrap>, uint32_t> numbers_;  // image, wrapping: texture of the scene
    size_t other_sets_ = 0;
    bool skip_ = false;
};

}  // namespace myriad::scenes::gltf
