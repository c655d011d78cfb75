#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>

#include <fstream>
#include <iterator>

#include "tests/fuzz/input_file.hpp"
#include "tests/fuzz/targets.hpp"
#include "tools/exr.hpp"

namespace myriad::fuzz {
namespace {

constexpr int width = 19, height = 13;

std::string bytes_of(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

template <class File, class Write>
std::string encoded(const InputFolder& folder, Imf::Compression codec, bool tiled, const Write& write) {
    Imf::Header header(width, height);
    header.compression() = codec;
    if (tiled) header.setTileDescription({8, 8, Imf::MIPMAP_LEVELS});
    std::vector<float> values(width * height);
    for (size_t i = 0; i < values.size(); ++i) values[i] = float(i % 17) / 4;
    Imf::FrameBuffer planes;
    for (const char* name : {"R", "Z"}) {
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        planes.insert(name, Imf::Slice::Make(Imf::FLOAT, values.data(), header.dataWindow()));
    }
    const std::string path = folder.put("seed.exr", "", 0);
    {
        File out(path.c_str(), header);
        out.setFrameBuffer(planes);
        write(out);
    }
    return bytes_of(path);
}

}  // namespace

std::vector<std::string> exr_seeds() {
    const InputFolder folder;
    tools::Image image;
    image.width = width, image.height = height;
    for (const char* name : {"R", "G", "B", "Z"}) image.add(name) = std::vector<float>(width * height, 0.5f);
    image.metadata["scene"] = "builtin:cornell";
    const std::string path = folder.put("ours.exr", "", 0);
    tools::write_exr(path, image);
    std::vector<std::string> out = {bytes_of(path)};
    for (const auto codec : {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::PXR24_COMPRESSION, Imf::B44A_COMPRESSION, Imf::DWAB_COMPRESSION})
        out.push_back(encoded<Imf::OutputFile>(folder, codec, false, [](auto& file) { file.writePixels(height); }));
    out.push_back(encoded<Imf::TiledOutputFile>(folder, Imf::ZIP_COMPRESSION, true, [](auto& file) { file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1); }));
    return out;
}

}  // namespace myriad::fuzz
