#include "tools/png.hpp"

#include <png.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "engine/error.hpp"
#include "tools/output_file.hpp"

namespace myriad::tools {
namespace {

// OKLab: L = 0.20 … 0.95 in equal steps, a = 0, b = -0.155 cos(pi t) - 0.01 cut to the sRGB gamut.
constexpr std::array<std::array<double, 3>, 9> heat{{{8, 0, 79}, {20, 25, 119}, {44, 61, 131}, {79, 92, 134}, {118, 121, 127},
                                                     {161, 148, 114}, {202, 175, 100}, {242, 204, 95}, {255, 237, 191}}};

// libpng's simplified interface: it keeps its errors to itself (no longjmp through C++) and marks what it writes as sRGB.
struct Png : png_image {
    Png() : png_image{} { version = PNG_IMAGE_VERSION; }
    ~Png() { png_image_free(this); }
};

}  // namespace

Picture to_picture(const Image::Rgb& linear, uint32_t width, uint32_t height) {
    Picture picture{width, height, std::vector<uint8_t>(size_t(width) * height * 3)};
    const std::span<const float> planes[] = {linear.r, linear.g, linear.b};
    for (size_t i = 0; i < picture.rgb.size(); ++i)
        picture.rgb[i] = static_cast<uint8_t>(std::lround(255 * srgb_encode(planes[i % 3][i / 3])));
    return picture;
}

Picture to_picture(std::span<const uint32_t> rgba, uint32_t width, uint32_t height) {
    Picture picture{width, height, {}};
    picture.rgb.reserve(rgba.size() * 3);
    for (const uint32_t texel : rgba)
        for (int shift : {0, 8, 16}) picture.rgb.push_back(static_cast<uint8_t>(texel >> shift));
    return picture;
}

Picture heat_map(std::span<const float> values, uint32_t width, uint32_t height, double scale) {
    Picture picture{width, height, std::vector<uint8_t>(size_t(width) * height * 3)};
    assert(values.size() * 3 == picture.rgb.size());
    for (size_t i = 0; i < values.size(); ++i) {
        const double t = scale > 0 ? std::clamp(values[i] / scale, 0., 1.) * (heat.size() - 1) : 0;
        const size_t low = std::isfinite(t) ? std::min(static_cast<size_t>(t), heat.size() - 2) : 0;
        for (size_t c = 0; c < 3; ++c)
            picture.rgb[i * 3 + c] = !std::isfinite(values[i])
                                         ? 255
                                         : static_cast<uint8_t>(std::lround(std::lerp(heat[low][c], heat[low + 1][c], t - low)));
    }
    return picture;
}

std::vector<char> png_bytes(const Picture& picture, const std::string& cannot) {
    assert(picture.rgb.size() == size_t(picture.width) * picture.height * 3);
    Png png;
    png.width = picture.width;
    png.height = picture.height;
    png.format = PNG_FORMAT_RGB;
    const auto fail = [&] { throw InputError(cannot + png.message + "; choose a smaller size"); };
    if (picture.rgb.empty()) throw InputError(cannot + "the picture is empty; give it a size");
    if (picture.rgb.size() > PNG_UINT_32_MAX / 2) throw InputError(cannot + "PNG ends at 2^31 bytes of pixels; choose a smaller size");
    // The greatest size instead of the exact one, which libpng would find by compressing twice.
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
    std::vector<char> bytes(size);
    if (!png_image_write_to_memory(&png, bytes.data(), &size, 0, picture.rgb.data(), 0, nullptr)) fail();
    bytes.resize(size);
    return bytes;
}

void write_png(const std::filesystem::path& path, const Picture& picture) {
    const std::vector<char> bytes = png_bytes(picture, "cannot write '" + path.string() + "': ");
    write_text(path, {bytes.data(), bytes.size()});
}

Picture read_png(const std::filesystem::path& path) {
    require_readable(path);
    const std::string cannot = "cannot read '" + path.string() + "': ";
    Png png;
    const auto fail = [&] { throw InputError(cannot + png.message + "; give a whole .png file"); };
    if (!png_image_begin_read_from_file(&png, path.c_str())) fail();
    if (uint64_t(png.width) * png.height > 1ull << 28) throw InputError(cannot + "it is beyond 2^28 pixels; scale it down");
    png.format = PNG_FORMAT_RGB;
    Picture picture{png.width, png.height, std::vector<uint8_t>(PNG_IMAGE_SIZE(png))};
    const png_color black{0, 0, 0};
    if (!png_image_finish_read(&png, &black, picture.rgb.data(), 0, nullptr)) fail();
    return picture;
}

}  // namespace myriad::tools
