#include "tools/exr.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfTestFile.h>
#include <half.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <deque>
#include <fstream>
#include <map>

#include "engine/error.hpp"
#include "tools/output_file.hpp"

namespace myriad::tools {
namespace {

// A header can claim anything, so it is bounded before anything is allocated for it: the library refuses sides above
// these, we refuse the products.
constexpr int max_side = 1 << 17, max_tile = 1 << 12;
constexpr uint64_t max_pixels = 1ull << 28, max_values = 1ull << 30;

// More than a codec can gain: deflate ends at 1032:1 and the others lower, but for DWA, which deflates one value in 64.
uint64_t best_ratio(Imf::Compression codec) {
    return codec == Imf::DWAA_COMPRESSION || codec == Imf::DWAB_COMPRESSION ? 1 << 17 : 1 << 11;
}

// The header of a file, read as far as it takes to know that the library may read it. The library allocates what a value
// claims, up to 2 GiB, before it finds that the file ends; and it reads values of the types it knows by their type, not
// by the size that the file gives them, so a wrong size lets it find other attributes than whoever skips by size.
class HeaderCheck {
public:
    explicit HeaderCheck(const std::filesystem::path& path) : in_(path, std::ios::binary), end_(std::filesystem::file_size(path)) {}

    // Whether the attributes of a single-part header (name, type, byte count, bytes; an empty name ends them) lie inside
    // the file and are what their types say.
    bool passes() {
        in_.seekg(8);  // magic number and version
        std::string name, type;
        while (std::getline(in_, name, '\0') && !name.empty()) {
            uint32_t bytes = 0;
            if (!std::getline(in_, type, '\0') || !word(bytes) || at() + bytes > end_) return false;
            const uint64_t next = at() + bytes;
            if (!value(type, bytes) || !in_) return false;
            in_.seekg(static_cast<std::streamoff>(next));
        }
        return in_.good();
    }

private:
    uint64_t at() { return static_cast<uint64_t>(in_.tellg()); }

    bool word(uint32_t& out) {
        uint8_t b[4];
        if (!in_.read(reinterpret_cast<char*>(b), 4)) return false;
        out = b[0] | b[1] << 8 | b[2] << 16 | uint32_t(b[3]) << 24;
        return true;
    }

    bool value(const std::string& type, uint32_t bytes) {
        static const std::map<std::string_view, uint32_t> sizes = {
            {"box2i", 16}, {"box2f", 16}, {"chromaticities", 32}, {"compression", 1}, {"deepImageState", 1}, {"double", 8}, {"envmap", 1},
            {"float", 4}, {"int", 4}, {"keycode", 28}, {"lineOrder", 1}, {"m33f", 36}, {"m33d", 72}, {"m44f", 64}, {"m44d", 128},
            {"rational", 8}, {"tiledesc", 9}, {"timecode", 8}, {"v2i", 8}, {"v2f", 8}, {"v2d", 16}, {"v3i", 12}, {"v3f", 12}, {"v3d", 24}};
        if (const auto known = sizes.find(type); known != sizes.end()) return bytes == known->second;
        if (type == "chlist") return channels(bytes);
        if (type == "stringvector") return strings(bytes);
        if (type == "floatvector") return bytes % 4 == 0;
        if (type == "idmanifest") return false;  // 3.1.5 reads four bytes more than there are; it belongs to deep images
        if (type == "preview") {
            uint32_t width = 0, height = 0;
            return word(width) && word(height) && bytes >= 8 && uint64_t(width) * height == (bytes - 8) / 4 && bytes % 4 == 0;
        }
        return true;  // text, and what the library does not know: it takes these by their size
    }

    bool channels(uint32_t bytes) {  // name and 16 bytes each; an empty name ends them
        const uint64_t end = at() + bytes;
        for (std::string name; std::getline(in_, name, '\0') && !name.empty();) in_.seekg(16, std::ios::cur);
        return in_ && at() == end;
    }

    bool strings(uint32_t bytes) {  // byte count and bytes each
        const uint64_t end = at() + bytes;
        while (at() < end) {
            uint32_t length = 0;
            if (!word(length) || at() + length > end) return false;
            in_.seekg(length, std::ios::cur);
        }
        return at() == end;
    }

    std::ifstream in_;
    const uint64_t end_;
};

struct Output final : Imf::OStream {
    Output(const std::string& name, OutputFile& file) : OStream(name.c_str()), file(file) {}
    void write(const char bytes[], int count) override { file.write(bytes, static_cast<size_t>(count)); }
    uint64_t tellp() override { return file.tell(); }
    void seekp(uint64_t offset) override { file.seek(offset); }
    OutputFile& file;
};

bool always_full(std::string_view channel) { return channel == "Z" || channel.starts_with("P."); }

// String attributes that mean something to the library itself.
bool reserved(std::string_view attribute) { return attribute == "name" || attribute == "type" || attribute == "view"; }

// The library breaks lines and ends sentences as it likes.
std::string one_line(std::string what) {
    std::ranges::replace(what, '\n', ' ');
    while (what.ends_with('.')) what.pop_back();
    return what;
}

std::vector<half> to_half(const std::vector<float>& values) {
    std::vector<half> out(values.size());
    std::ranges::transform(values, out.begin(), [](float v) {
        return half(std::isfinite(v) ? std::clamp(v, -65504.f, 65504.f) : v);
    });
    return out;
}

}  // namespace

void write_exr(const std::filesystem::path& path, const Image& image, ExrColour colour) {
    const std::string cannot = "cannot write '" + path.string() + "': ";
    if (!image.pixels() || image.channels.empty()) throw InputError(cannot + "the image is empty; give it a size and channels");
    try {
        Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
        header.compression() = Imf::ZIP_COMPRESSION;
        for (const auto& [key, value] : image.metadata) {
            if (reserved(key) || header.find(key) != header.end())
                throw InputError(cannot + "EXR reserves the attribute '" + key + "'; choose another metadata key");
            header.insert(key, Imf::StringAttribute(value));
        }

        Imf::FrameBuffer planes;
        std::deque<std::vector<half>> halves;  // a deque: slices keep pointers into its elements
        for (const Image::Channel& channel : image.channels) {
            assert(channel.values.size() == image.pixels());
            const bool full = colour == ExrColour::full || always_full(channel.name);
            const Imf::PixelType type = full ? Imf::FLOAT : Imf::HALF;
            const void* data = full ? static_cast<const void*>(channel.values.data())
                                    : halves.emplace_back(to_half(channel.values)).data();
            header.channels().insert(channel.name, Imf::Channel(type));
            planes.insert(channel.name, Imf::Slice::Make(type, data, header.dataWindow()));
        }

        OutputFile file(path);
        {
            Output stream(path.string(), file);
            Imf::OutputFile out(stream, header);
            out.setFrameBuffer(planes);
            out.writePixels(static_cast<int>(image.height));
        }  // ends the file; errors here are swallowed by the library and thrown by commit()
        file.commit();
    } catch (const Iex::BaseExc& e) {
        throw InputError(cannot + one_line(e.what()) + "; change the image or the path");
    }
}

Image read_exr(const std::filesystem::path& path) {
    require_readable(path);
    const std::string name = path.string(), cannot = "cannot read '" + name + "': ";
    const auto damaged = [&](const std::string& how) {
        return InputError(cannot + "the file is truncated or damaged (" + how + "); write or copy it again");
    };
    [[maybe_unused]] static const bool bounded = [] {
        Imf::Header::setMaxImageSize(max_side, max_side);
        Imf::Header::setMaxTileSize(max_tile, max_tile);
        return true;
    }();
    try {
        bool tiled = false, deep = false, parts = false;
        if (!Imf::isOpenExrFile(name.c_str(), tiled, deep, parts))
            throw InputError(cannot + "it is not an OpenEXR file; give an .exr file, such as myriad render writes");
        if (deep) throw InputError(cannot + "it holds deep samples; flatten it first");
        if (parts) throw InputError(cannot + "it has several parts; save one part as its own file");

        if (!HeaderCheck(path).passes()) throw damaged("its header does not end, or has values of the wrong size");

        Imf::InputFile in(name.c_str());
        const Imf::Header& header = in.header();
        const Imath::Box2i window = header.dataWindow();

        Image image;
        image.origin = name;
        image.width = static_cast<uint32_t>(int64_t(window.max.x) - window.min.x + 1);
        image.height = static_cast<uint32_t>(int64_t(window.max.y) - window.min.y + 1);
        const Imf::ChannelList& list = header.channels();
        uint64_t count = 0, bytes_per_pixel = 0;
        for (auto c = list.begin(); c != list.end(); ++c) {
            ++count;
            bytes_per_pixel += c.channel().type == Imf::HALF ? 2 : 4;
        }
        if (image.pixels() > max_pixels || image.pixels() * count > max_values)
            throw InputError(cannot + "it claims " + std::to_string(image.width) + "x" + std::to_string(image.height) + " pixels in " +
                             std::to_string(count) + " channels, beyond 2^28 pixels or 2^30 values; crop it or scale it down");
        // Asked before the planes are allocated, so that a header with no pixels behind it costs nothing.
        const uint64_t least_bytes = image.pixels() * bytes_per_pixel / best_ratio(header.compression());
        if (!in.isComplete() || least_bytes > std::filesystem::file_size(path)) throw damaged("it has fewer bytes than its pixels need");

        Imf::FrameBuffer planes;
        image.channels.reserve(count);
        for (auto c = list.begin(); c != list.end(); ++c) {
            if (c.channel().xSampling != 1 || c.channel().ySampling != 1)
                throw InputError(cannot + "channel '" + c.name() + "' is subsampled; save it at full resolution");
            planes.insert(c.name(), Imf::Slice::Make(Imf::FLOAT, image.add(c.name()).data(), window));
        }
        for (auto a = header.begin(); a != header.end(); ++a)
            if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&a.attribute()); text && !reserved(a.name()))
                image.metadata[a.name()] = text->value();

        in.setFrameBuffer(planes);
        in.readPixels(window.min.y, window.max.y);
        return image;
    } catch (const Iex::BaseExc& e) {
        throw damaged(one_line(e.what()));
    }
}

}  // namespace myriad::tools
