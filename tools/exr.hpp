// OpenEXR files, in and out.
#pragma once

#include <filesystem>

#include "tools/image.hpp"

namespace myriad::tools {

// How colour is stored. Depth and position ("Z", "P.*") are always 32-bit: halves cannot tell neighbouring pixels apart.
enum class ExrColour { half, full };

// Writes a scanline file, zip-compressed, atomically; the same image gives the same bytes. Metadata become string
// attributes. Finite values beyond the half's range are clamped to ±65504 rather than turned into infinities; NaN and Inf
// are written as they are. InputError when the file cannot be written, the image is empty, or a metadata key is reserved.
void write_exr(const std::filesystem::path& path, const Image& image, ExrColour colour = ExrColour::half);

// Reads every channel (half, float, uint → float) of a flat, single-part file, scanlines or tiles (full resolution). The
// image is the file's data window; string attributes become metadata. InputError when the file is missing, is no EXR, is
// truncated or damaged, is deep, multi-part or subsampled, or is larger than 2^28 pixels or 2^30 values.
Image read_exr(const std::filesystem::path& path);

}  // namespace myriad::tools
