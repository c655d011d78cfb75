// 8-bit sRGB pictures, for people to look at. Nothing is measured on them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "tools/image.hpp"

namespace myriad::tools {

struct Picture {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgb;  // width * height * 3, row 0 at the top, sRGB-encoded
};

// Clamps to [0, 1], encodes as sRGB and rounds. Tone mapping is the caller's. NaN becomes 0.
Picture to_picture(const Image::Rgb& linear, uint32_t width, uint32_t height);

// Texels as the device packs them: 8 bits each, red the lowest.
Picture to_picture(std::span<const uint32_t> rgba, uint32_t width, uint32_t height);

// Values as colours: 0 is dark blue, `scale` and beyond light yellow, non-finite white. Lightness (OKLab L) grows in equal
// steps and hue runs from blue to yellow only, so the map is perceptually ordered, prints in grey, and reads the same
// with red-green colour blindness.
Picture heat_map(std::span<const float> values, uint32_t width, uint32_t height, double scale);

// A PNG file with an sRGB chunk, same bytes for same picture. InputError, which begins with `cannot`, when that is not possible.
std::vector<char> png_bytes(const Picture& picture, const std::string& cannot = "cannot make a PNG: ");
// Writes it, atomically. InputError when that is not possible.
void write_png(const std::filesystem::path& path, const Picture& picture);

// Any PNG as 8-bit sRGB, alpha over black. InputError when missing, damaged, no PNG, or above 2^28 pixels.
Picture read_png(const std::filesystem::path& path);

}  // namespace myriad::tools
