// Pictures in whatever format textures of other formats than glTF come in.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "scenes/scene.hpp"

namespace myriad::scenes::importing {

// PNG and JPEG as the glTF loader reads them; TGA, BMP, GIF and PSD by stb. None, and what is wrong in `problem`,
// where the bytes are nothing of this or damaged, or a side is longer than 32768 pixels.
std::optional<Texture> decode_picture(std::span<const uint8_t> bytes, std::string& problem);

}  // namespace myriad::scenes::importing
