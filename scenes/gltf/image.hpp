// Pictures: PNG and JPEG, by libpng and libjpeg, which are made for hostile files.
#pragma once

#include "scenes/gltf/accessor.hpp"

namespace myriad::scenes::gltf {

struct Picture {
    uint32_t width = 0, height = 0;
    Bytes rgba;  // width * height * 4, row 0 at the top, as encoded: no gamma or profile is applied (glTF 2.0, 3.8.2)
};

// Any PNG or JPEG as RGBA8: 16 bits rounded to 8, palettes and greys expanded, CMYK converted. Before memory is taken it
// is spent from the document's budget.
Picture decode_picture(const Place& place, Range bytes);

// glTF image `index`, from its buffer view, data URI or file.
Picture read_image(const Place& place, int index);

}  // namespace myriad::scenes::gltf
