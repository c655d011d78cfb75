#include "tools/image.hpp"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>

#include "engine/error.hpp"

namespace myriad::tools {

const Image::Channel* Image::find(std::string_view name) const {
    auto at = std::ranges::find(channels, name, &Channel::name);
    return at == channels.end() ? nullptr : &*at;
}

std::optional<Image::Rgb> Image::rgb(std::string_view layer) const {
    auto planes = [this](const std::string& r, const std::string& g, const std::string& b) -> std::optional<Rgb> {
        const Channel *cr = find(r), *cg = find(g), *cb = find(b);
        if (!cr || !cg || !cb) return std::nullopt;
        return Rgb{cr->values, cg->values, cb->values};
    };
    if (layer.empty()) {
        if (auto rgb = planes("R", "G", "B")) return rgb;
        return planes("Y", "Y", "Y");
    }
    const std::string name{layer}, prefix = name + ".";
    if (auto rgb = planes(prefix + "R", prefix + "G", prefix + "B")) return rgb;
    if (auto xyz = planes(prefix + "X", prefix + "Y", prefix + "Z")) return xyz;
    return planes(name, name, name);
}

std::vector<float>& Image::add(std::string name) {
    assert(!find(name));
    return channels.emplace_back(Channel{std::move(name), std::vector<float>(pixels())}).values;
}

void Image::add(std::initializer_list<std::string_view> names, std::span<const float> texels, size_t stride) {
    assert(names.size() <= stride && texels.size() >= pixels() * stride);
    size_t component = 0;
    for (std::string_view name : names) {
        std::vector<float>& values = add(std::string{name});
        for (size_t i = 0; i < values.size(); ++i) values[i] = texels[i * stride + component];
        ++component;
    }
}

double srgb_encode(double linear) {
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 1;
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

void require_readable(const std::filesystem::path& path) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
        throw InputError("cannot read '" + path.string() + "': it is a folder; name a file");
    errno = 0;
    if (std::ifstream(path, std::ios::binary)) return;
    throw InputError("cannot read '" + path.string() + "': " + std::strerror(errno ? errno : EIO) +
                     "; check the path and its permissions");
}

}  // namespace myriad::tools
