#include "scenes/import/picture.hpp"

#include <cstring>
#include <memory>

#include <stb_image.h>

#include "engine/error.hpp"
#include "scenes/gltf/image.hpp"

namespace myriad::scenes::importing {
namespace {

bool starts_with(std::span<const uint8_t> bytes, const char* magic, size_t count) {
    return bytes.size() >= count && std::memcmp(bytes.data(), magic, count) == 0;
}

// By the loader of glTF, which decodes for hostile files and within a budget.
Texture decode_checked(std::span<const uint8_t> bytes) {
    gltf::Document document;
    document.budget.earn(bytes.size());
    const gltf::Place place{document.model, "", "", &document};
    gltf::Picture picture = gltf::decode_picture(place, {bytes.data(), bytes.size()});
    Texture out;
    out.width = picture.width, out.height = picture.height;
    out.rgba = std::move(picture.rgba);
    return out;
}

std::optional<Texture> decode_rest(std::span<const uint8_t> bytes, std::string& problem) {
    const auto refuse = [&](const std::string& what) {
        problem = what;
        return std::nullopt;
    };
    if (bytes.size() > 0x7fffffff) return refuse("it is larger than 2 GiB");
    int width = 0, height = 0, channels = 0;
    const int size = int(bytes.size());
    // What stb knows besides, and nobody promised. Of PNM, version 2.27 overflows on long numbers and reads beyond 16-bit pixels.
    for (const char* magic : {"#?", "\x53\x80\xf6\x34", "P5", "P6"})
        if (starts_with(bytes, magic, std::strlen(magic))) return refuse("it is in no known format");
    if (!stbi_info_from_memory(bytes.data(), size, &width, &height, &channels)) return refuse("it is in no known format");
    if (width <= 0 || height <= 0 || uint32_t(width) > gltf::limits::image_side || uint32_t(height) > gltf::limits::image_side)
        return refuse("it is larger than 32768 pixels a side");
    gltf::Budget budget;
    budget.earn(bytes.size());
    constexpr uint64_t working_set = 16;  // bytes a pixel: the library's pictures, before and after conversion, and ours
    if (!budget.spend(uint64_t(width) * uint64_t(height), working_set)) return refuse("it expands too much");
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 4), stbi_image_free);
    if (!pixels) return refuse(stbi_failure_reason() ? stbi_failure_reason() : "it is damaged");
    Texture out;
    out.width = uint32_t(width), out.height = uint32_t(height);
    out.rgba.assign(pixels.get(), pixels.get() + size_t(width) * size_t(height) * 4);
    return out;
}

}  // namespace

std::optional<Texture> decode_picture(std::span<const uint8_t> bytes, std::string& problem) {
    if (!starts_with(bytes, "\x89PNG", 4) && !starts_with(bytes, "\xff\xd8\xff", 3)) return decode_rest(bytes, problem);
    try {
        return decode_checked(bytes);
    } catch (const InputError& e) {
        problem = e.what();
        return std::nullopt;
    }
}

}  // namespace myriad::scenes::importing
