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

// Whether the attributes of a single-part header (name, type, byte count, bytes; an empty name ends them) lie inside the
// file. The library allocates what an attribute claims, up to 2 GiB, before it finds that the file ends.
bool header_fits(const std::filesystem::path& path) {
    const uint64_t end = std::filesystem::file_size(path);
    std::ifstream in(path, std::ios::binary);
    in.seekg(8);  // magic number and version
    std::string name, type;
    while (std::getline(in, name, '\0') && !name.empty()) {
        uint8_t b[4];
        if (!std::getline(in, type, '\0') || !in.read(reinterpret_cast<char*>(b), 4)) return false;
        const uint32_t bytes = b[0] | b[1] << 8 | b[2] << 16 | uint32_t(b[3]) << 24;
        if (static_cast<uint64_t>(in.tellg()) + bytes > end) return false;
        in.seekg(bytes, std::ios::cur);
    }
    return in.good();
}

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

        if (!header_fits(path)) throw damaged("its header does not end");

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
