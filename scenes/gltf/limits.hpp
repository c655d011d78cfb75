// What a file may ask of us, in one place. Files are hostile until proven good: a kilobyte of JSON or of compressed data
// can ask for a hundred gigabytes, and each limit here says no before anything is allocated.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

namespace myriad::scenes::gltf::limits {

// Everything that is decoded, together: any file may have the first, and each byte that it brings, in itself or in the
// files that it refers to, earns as many more as the second says. 1032 is what deflate gains at best, and no other
// codec of glTF comes near that on honest data; the first covers small files of large flat pictures.
inline constexpr uint64_t free_bytes = 256ull << 20, expansion = 1032;

// A GLB counts its bytes in 32 bits; tinygltf those of the JSON too. Buffers in files of their own may be larger.
inline constexpr uint64_t file_bytes = 0xffffffff;

// tinygltf copies `extras` and `extensions` by recursion, and deep nesting would overflow the stack.
inline constexpr int json_depth = 200;

// libpng and libjpeg go to 2^31 and 65,500; devices end at 16,384 or 32,768.
inline constexpr uint32_t image_side = 1u << 15;

// Scans of a progressive JPEG, each of which costs a walk over the whole picture. Encoders write about ten.
inline constexpr int jpeg_scans = 100;

// Radiance, radiant intensity and irradiance. With scenes of scenes::farthest across, fluxes stay finite in 32-bit floats.
inline constexpr double light = 1e18;

// Offsets and scales of textures.
inline constexpr double factor = 1e6;

// Characters of a name or URI that a message repeats.
inline constexpr size_t shown_characters = 100;

}  // namespace myriad::scenes::gltf::limits

namespace myriad::scenes::gltf {

// How much may still be decoded; see limits::free_bytes.
class Budget {
public:
    // The file brings so many bytes.
    void earn(uint64_t bytes) {
        constexpr uint64_t most = std::numeric_limits<uint64_t>::max();
        left_ = bytes > (most - left_) / limits::expansion ? most : left_ + bytes * limits::expansion;
    }
    // Spends count * size bytes, or nothing and returns false where that is more than there is.
    [[nodiscard]] bool spend(uint64_t count, uint64_t size) {
        if (size && count > left_ / size) return false;
        left_ -= count * size;
        return true;
    }

private:
    uint64_t left_ = limits::free_bytes;
};

}  // namespace myriad::scenes::gltf
