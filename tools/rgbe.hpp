// Radiance pictures (.hdr), in.
#pragma once

#include <filesystem>

#include "tools/image.hpp"

namespace myriad::tools {

// Reads a picture of shared exponents (FORMAT=32-bit_rle_rgbe), run-length coded or not, rows in either direction, into R, G and B: radiance as
// stored, whatever EXPOSURE the header names. Row 0 is the upper one. InputError when the file is missing, is none of these, is
// truncated or damaged, or is larger than 2^26 pixels.
//
// Our own, for stb_image 2.27, which Debian 12 has, never returns from a file that ends within a row.
Image read_rgbe(const std::filesystem::path& path);

}  // namespace myriad::tools
