// An image on the host: named planes of floats, as an EXR file has them. Linear and scene-referred unless a name says more.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace myriad::tools {

struct Image {
    struct Channel {
        std::string name;           // "R", "direct.G", "Z" …
        std::vector<float> values;  // width * height, row 0 at the top
    };
    struct Rgb {
        std::span<const float> r, g, b;
    };

    uint32_t width = 0, height = 0;
    std::vector<Channel> channels;
    std::map<std::string, std::string> metadata;  // string attributes of the file
    std::string origin = "image";                 // the file it came from, for messages

    size_t pixels() const { return size_t(width) * height; }

    // The channel of that name, or nullptr.
    const Channel* find(std::string_view name) const;

    // The three planes of a layer: its R,G,B, or its X,Y,Z ("N", "P"), or one plane three times (a layer that is itself
    // a channel, such as "Z", or the beauty of a grey image, "Y"). The layer "" is the beauty. Empty when there is none.
    std::optional<Rgb> rgb(std::string_view layer = "") const;

    // Adds a plane of zeros. The reference lives until the next add.
    std::vector<float>& add(std::string name);

    // Adds one plane a name out of interleaved texels: name i is texels[pixel * stride + i]. This is how a rgba32f
    // read-back becomes "direct.R", "direct.G", "direct.B" (stride 4).
    void add(std::initializer_list<std::string_view> names, std::span<const float> texels, size_t stride);
};

// IEC 61966-2-1: linear [0, 1] to display-referred [0, 1]. Clamps; NaN becomes 0.
double srgb_encode(double linear);

// InputError unless the path names something that can be opened and is no folder.
void require_readable(const std::filesystem::path& path);

}  // namespace myriad::tools
