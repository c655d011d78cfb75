// Pictures of every kind that PNG and JPEG know, in every place where a file may keep them, as the RGBA bytes that they show.
#include <csetjmp>
#include <cstdio>

#include <jpeglib.h>
#include <zlib.h>

#include "scenes/gltf_kit.hpp"

namespace myriad::scenes {
namespace {

using Bytes = std::vector<uint8_t>;

// A PNG by its specification: `rows` are its scanlines without their filter bytes.
struct Png {
    uint32_t width = 0, height = 0;
    uint8_t depth = 8, type = 0;  // 0 grey, 2 colour, 3 palette, 4 grey and alpha, 6 colour and alpha
    std::vector<Bytes> rows;
    Bytes palette = {}, transparency = {}, gamma = {};

    Bytes encoded() const {
        Bytes out = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
        const auto word = [](Bytes& to, uint32_t value) {
            for (int shift = 24; shift >= 0; shift -= 8) to.push_back(uint8_t(value >> shift));
        };
        const auto chunk = [&](const char* name, const Bytes& data) {
            word(out, uint32_t(data.size()));
            Bytes body(name, name + 4);
            body.insert(body.end(), data.begin(), data.end());
            out.insert(out.end(), body.begin(), body.end());
            word(out, uint32_t(crc32(0, body.data(), uInt(body.size()))));
        };
        Bytes header, raw;
        word(header, width), word(header, height);
        header.insert(header.end(), {depth, type, 0, 0, 0});
        chunk("IHDR", header);
        if (!gamma.empty()) chunk("gAMA", gamma);
        if (!palette.empty()) chunk("PLTE", palette);
        if (!transparency.empty()) chunk("tRNS", transparency);
        for (const Bytes& row : rows) raw.push_back(0), raw.insert(raw.end(), row.begin(), row.end());
        uLongf size = compressBound(uLong(raw.size()));
        Bytes packed(size);
        compress(packed.data(), &size, raw.data(), uLong(raw.size()));
        packed.resize(size);
        chunk("IDAT", packed);
        chunk("IEND", {});
        return out;
    }
};

Bytes jpeg(uint32_t width, uint32_t height, int components, const Bytes& pixels, bool progressive) {
    jpeg_compress_struct out{};
    jpeg_error_mgr errors{};
    out.err = jpeg_std_error(&errors);
    jpeg_create_compress(&out);
    unsigned char* data = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&out, &data, &size);
    out.image_width = width, out.image_height = height, out.input_components = components;
    out.in_color_space = components == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(&out);
    jpeg_set_quality(&out, 100, TRUE);
    if (progressive) jpeg_simple_progression(&out);
    jpeg_start_compress(&out, TRUE);
    while (out.next_scanline < height) {
        JSAMPROW row = const_cast<uint8_t*>(pixels.data()) + size_t(out.next_scanline) * width * size_t(components);
        jpeg_write_scanlines(&out, &row, 1);
    }
    jpeg_finish_compress(&out);
    jpeg_destroy_compress(&out);
    const Bytes bytes(data, data + size);
    std::free(data);
    return bytes;
}

class GltfImages : public Gltf {
protected:
    void SetUp() override {
        Gltf::SetUp();
        square();
        add_texcoords();
        primitive()["material"] = 0;
        doc["textures"] = {{{"source", 0}}};
        doc["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    }
    Texture decoded(const Bytes& picture, const char* type) {
        doc["images"] = {{{"bufferView", view(picture)}, {"mimeType", type}}};
        return read(true).textures.at(0);
    }
    void expect_png(const Png& png, const Bytes& rgba) {
        const Texture t = decoded(png.encoded(), "image/png");
        EXPECT_EQ(t.width, png.width);
        EXPECT_EQ(t.height, png.height);
        EXPECT_EQ(t.rgba, rgba) << "depth " << int(png.depth) << ", type " << int(png.type);
    }
};

TEST_F(GltfImages, PngsOfEveryKind) {
    expect_png({2, 1, 8, 0, {{0, 200}}}, {0, 0, 0, 255, 200, 200, 200, 255});
    expect_png({2, 2, 8, 2, {{1, 2, 3, 4, 5, 6}, {7, 8, 9, 10, 11, 12}}}, {1, 2, 3, 255, 4, 5, 6, 255, 7, 8, 9, 255, 10, 11, 12, 255});
    expect_png({2, 1, 8, 4, {{50, 0, 60, 128}}}, {50, 50, 50, 0, 60, 60, 60, 128});
    expect_png({1, 1, 8, 6, {{1, 2, 3, 4}}}, {1, 2, 3, 4});
    // A bit each; the first is the most significant.
    expect_png({9, 1, 1, 0, {{0xa0, 0x80}}}, [] {
        Bytes out;
        for (int v : {255, 0, 255, 0, 0, 0, 0, 0, 255}) out.insert(out.end(), {uint8_t(v), uint8_t(v), uint8_t(v), 255});
        return out;
    }());
    expect_png({2, 1, 4, 0, {{0x0f}}}, {0, 0, 0, 255, 255, 255, 255, 255});
    // Palettes, of which the first entry may be seen through.
    const Bytes palette = {255, 0, 0, 0, 255, 0, 0, 0, 255};
    expect_png({3, 1, 8, 3, {{2, 0, 1}}, palette}, {0, 0, 255, 255, 255, 0, 0, 255, 0, 255, 0, 255});
    expect_png({3, 1, 2, 3, {{0x84}}, palette, {128}}, {0, 0, 255, 255, 255, 0, 0, 128, 0, 255, 0, 255});
    // One colour that stands for nothing there.
    expect_png({2, 1, 8, 2, {{9, 9, 9, 1, 2, 3}}, {}, {0, 9, 0, 9, 0, 9}}, {9, 9, 9, 0, 1, 2, 3, 255});
    expect_png({2, 1, 8, 0, {{9, 8}}, {}, {0, 9}}, {9, 9, 9, 0, 8, 8, 8, 255});
}

TEST_F(GltfImages, SixteenBitsAreRoundedToEight) {
    // 0x0080 is 0.498 of 255; 0x0081 is 0.502; 0x8080 is 128 and 0xff7f 254.502.
    expect_png({4, 1, 16, 0, {{0x00, 0x80, 0x00, 0x81, 0x80, 0x80, 0xff, 0x7f}}},
               {0, 0, 0, 255, 1, 1, 1, 255, 128, 128, 128, 255, 255, 255, 255, 255});
    expect_png({1, 1, 16, 2, {{0x10, 0x10, 0x20, 0x20, 0x30, 0x30}}}, {0x10, 0x20, 0x30, 255});
    expect_png({1, 1, 16, 4, {{0x10, 0x10, 0x20, 0x20}}}, {0x10, 0x10, 0x10, 0x20});
    expect_png({1, 1, 16, 6, {{0x10, 0x10, 0x20, 0x20, 0x30, 0x30, 0x40, 0x40}}}, {0x10, 0x20, 0x30, 0x40});
}

// glTF 2.0, 3.8.2: what the file says of its gamma is ignored. Bytes stay as they are stored; whether they are sRGB is the
// material's to say, by where it uses the texture.
TEST_F(GltfImages, GammaIsIgnored) {
    expect_png({1, 1, 8, 2, {{10, 100, 200}}, {}, {}, {0x00, 0x01, 0x86, 0xa0}}, {10, 100, 200, 255});  // 1.0
    expect_png({1, 1, 8, 2, {{10, 100, 200}}, {}, {}, {0x00, 0x00, 0xb1, 0x8f}}, {10, 100, 200, 255});  // 1 / 2.2
}

TEST_F(GltfImages, Jpegs) {
    const Bytes grey(16 * 16, 77);
    Bytes colour;
    for (int i = 0; i < 16 * 16; ++i) colour.insert(colour.end(), {200, 100, 50});
    for (bool progressive : {false, true}) {
        const Texture g = decoded(jpeg(16, 16, 1, grey, progressive), "image/jpeg"), c = decoded(jpeg(16, 16, 3, colour, progressive), "image/jpeg");
        ASSERT_EQ(g.rgba.size(), 1024u);
        ASSERT_EQ(c.rgba.size(), 1024u);
        for (size_t i = 0; i < 1024; i += 4)
            for (size_t k = 0; k < 4; ++k) {
                ASSERT_NEAR(g.rgba[i + k], k == 3 ? 255 : 77, 1);
                ASSERT_NEAR(c.rgba[i + k], (std::array{200, 100, 50, 255})[k], 2);
            }
    }
}

TEST_F(GltfImages, WhereverAFileKeepsThem) {
    const Bytes bytes = Png{1, 1, 8, 6, {{1, 2, 3, 4}}}.encoded(), expected = {1, 2, 3, 4};
    const std::string text(bytes.begin(), bytes.end());
    file("bild \xc3\xa4.png", text);
    for (const char* uri : {"bild%20%C3%A4.png", "bild \xc3\xa4.png", "./bild%20%c3%a4.png"}) {
        doc["images"] = {{{"uri", uri}}};
        EXPECT_EQ(read().textures.at(0).rgba, expected) << uri;
    }
    static const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string base64;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        const auto at = [&](size_t k) { return i + k < bytes.size() ? uint32_t(bytes[i + k]) : 0; };
        const uint32_t three = at(0) << 16 | at(1) << 8 | at(2);
        for (int k = 0; k < 4; ++k) base64 += i + size_t(k) > bytes.size() ? '=' : digits[three >> (18 - 6 * k) & 63];
    }
    doc["images"] = {{{"uri", "data:image/png;base64," + base64}}};
    EXPECT_EQ(read().textures.at(0).rgba, expected);
    // The type that the file claims is not what decides.
    valid = false;
    EXPECT_EQ(decoded(bytes, "image/jpeg").rgba, expected);
}

}  // namespace
}  // namespace myriad::scenes
