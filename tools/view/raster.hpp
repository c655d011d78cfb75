// Dear ImGui's lists, drawn on the host: the window stays live whatever the device is busy with, and its picture can be tested without one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

struct ImDrawData;

namespace myriad::tools::view {

// What an ImTextureID points to: RGBA8 in words, red the lowest.
struct Texture {
    uint32_t width = 0, height = 0;
    const uint32_t* texels = nullptr;
    bool smooth = false;  // between texels
};

// Draws over `target`, width x height pixels in sRGB as ImGui wants it. A pixel belongs to the triangle that its middle is in; of an edge that two
// share, it belongs to one of them. Same bits whatever the number of threads.
void draw(const ImDrawData& data, std::span<uint32_t> target, uint32_t width, uint32_t height);

}  // namespace myriad::tools::view
