#include "tools/rgbe.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "engine/error.hpp"

namespace myriad::tools {
namespace {

constexpr uint64_t most_pixels = 1 << 26;

class Reader {
public:
    explicit Reader(const std::filesystem::path& path)
        : cannot_("cannot read '" + path.string() + "': "), in_(path, std::ios::binary), bytes_(std::filesystem::file_size(path)) {}

    Image read() {
        if (!line().starts_with("#?")) throw InputError(cannot_ + "it is not a Radiance picture; give an .hdr file");
        read_header();
        read_size();
        for (uint32_t y = 0; y < image_.height; ++y) {
            at_ = y;
            read_row();
            for (uint32_t x = 0; x < image_.width; ++x) put(flips_x_ ? image_.width - 1 - x : x, flips_y_ ? image_.height - 1 - y : y, row_[x]);
        }
        return std::move(image_);
    }

private:
    using Code = std::array<uint8_t, 4>;

    std::string line() {
        std::string text;
        for (char c; text.size() < 4096 && in_.get(c) && c != '\n';) text += c;
        if (!in_ || text.size() >= 4096) throw damaged("its header does not end");
        return text;
    }
    InputError damaged(const std::string& how) const {
        return InputError(cannot_ + "the file is truncated or damaged (" + how + "); write or copy it again");
    }
    InputError row_damaged(const std::string& how) const { return damaged("row " + std::to_string(at_) + " " + how); }
    uint8_t byte() {
        const int b = in_.get();
        if (b < 0) throw row_damaged("ends early");
        return uint8_t(b);
    }

    void read_header() {
        bool known = false;
        for (std::string text = line(); !text.empty(); text = line()) {
            if (!text.starts_with("FORMAT=")) continue;
            if (text != "FORMAT=32-bit_rle_rgbe") throw InputError(cannot_ + "its format is '" + text.substr(7) + "'; save it as 32-bit_rle_rgbe");
            known = true;
        }
        if (!known) throw damaged("its header names no format");
    }

    void read_size() {
        const std::string text = line();
        char y_sign = 0, x_sign = 0, end = 0;
        unsigned long long height = 0, width = 0;
        if (std::sscanf(text.c_str(), "%cY %llu %cX %llu%c", &y_sign, &height, &x_sign, &width, &end) != 4 || (y_sign != '-' && y_sign != '+') ||
            (x_sign != '-' && x_sign != '+'))
            throw InputError(cannot_ + "its rows are not stored one after the other (resolution '" + text.substr(0, 40) + "'); save it as -Y height +X width");
        if (height == 0 || width == 0 || height > most_pixels || width > most_pixels || height * width > most_pixels)
            throw InputError(cannot_ + "it claims " + std::to_string(width) + "x" + std::to_string(height) + " pixels, beyond 2^26; scale it down");
        // Asked before anything is allocated. Runs gain less, up to 127 values in two bytes, but for chains of the old ones, which may as well
        // have no end: nobody writes pictures of one colour.
        if (std::max(4 * height, height * width / 128) > bytes_) throw damaged("it has fewer bytes than its pixels need");
        flips_y_ = y_sign == '+', flips_x_ = x_sign == '-';
        image_.width = uint32_t(width), image_.height = uint32_t(height);
        image_.channels.reserve(3);
        for (const char* name : {"R", "G", "B"}) image_.add(name);
        row_.resize(width);
    }

    void read_row() {
        const Code first{byte(), byte(), byte(), byte()};
        const bool coded = first[0] == 2 && first[1] == 2 && first[2] < 128 && image_.width >= 8 && image_.width < 32768;
        if (!coded) return read_plain_row(first);
        if (uint32_t(first[2]) << 8 != (image_.width & 0xff00u) || first[3] != (image_.width & 0xffu)) throw row_damaged("has another width");
        for (size_t channel = 0; channel < 4; ++channel)
            for (uint32_t x = 0; x < image_.width;) {
                const uint8_t code = byte();
                const uint32_t count = code > 128 ? code - 128u : code;
                if (count == 0 || count > image_.width - x) throw row_damaged("has a run that does not fit");
                const uint8_t same = code > 128 ? byte() : uint8_t(0);
                for (uint32_t i = 0; i < count; ++i) row_[x++][channel] = code > 128 ? same : byte();
            }
    }

    // Pixel by pixel; of old, (1, 1, 1, n) repeats the one before, and several of these in a row are the digits of a longer run.
    void read_plain_row(Code code) {
        uint32_t shift = 0;
        for (uint32_t x = 0; x < image_.width;) {
            if (code[0] == 1 && code[1] == 1 && code[2] == 1) {
                const uint64_t count = shift < 32 ? uint64_t(code[3]) << shift : 0;
                if (x == 0 || count == 0 || count > image_.width - x) throw row_damaged("has a run that does not fit");
                for (uint64_t i = 0; i < count; ++i, ++x) row_[x] = row_[x - 1];
                shift += 8;
            } else {
                row_[x++] = code;
                shift = 0;
            }
            if (x < image_.width) code = {byte(), byte(), byte(), byte()};
        }
    }

    void put(uint32_t x, uint32_t y, const Code& code) {
        for (size_t c = 0; c < 3; ++c)
            image_.channels[c].values[size_t(y) * image_.width + x] = code[3] == 0 ? 0 : std::ldexp(float(code[c]), int(code[3]) - 136);
    }

    const std::string cannot_;
    std::ifstream in_;
    const uint64_t bytes_;
    Image image_;
    std::vector<Code> row_;
    bool flips_x_ = false, flips_y_ = false;
    uint32_t at_ = 0;
};

}  // namespace

Image read_rgbe(const std::filesystem::path& path) {
    require_readable(path);
    Image image = Reader(path).read();
    image.origin = path.string();
    return image;
}

}  // namespace myriad::tools
