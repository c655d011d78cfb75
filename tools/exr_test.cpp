#include "tools/exr.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>
#include <half.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "tools/temp_folder.hpp"

namespace myriad::tools {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
    return std::ranges::equal(a, b, [](float x, float y) { return std::bit_cast<uint32_t>(x) == std::bit_cast<uint32_t>(y); });
}

Image layered(uint32_t width, uint32_t height) {
    Image image;
    image.width = width, image.height = height;
    std::mt19937 random(7);
    std::lognormal_distribution<float> radiance(0, 2);
    for (const char* name : {"R", "G", "B", "direct.R", "direct.G", "direct.B", "indirect.R", "albedo.G", "N.X", "N.Z", "P.X", "P.Z", "Z"})
        for (float& v : image.add(name)) v = radiance(random);
    image.metadata = {{"scene", "builtin:atrium"}, {"seed", "1"}, {"technique", "manylods, ε = 1"}, {"gitRevision", ""},
                      {"an attribute with a long name, over 31 characters", "kept"}};
    return image;
}

TEST(exr, floats_survive_bit_by_bit) {
    TempFolder folder;
    Image image = layered(37, 21);
    std::vector<float>& red = image.channels[0].values;
    red[0] = inf, red[1] = -inf, red[2] = std::nanf(""), red[3] = -0.f, red[4] = 1e-42f, red[5] = 3e38f;
    write_exr(folder / "a.exr", image, ExrColour::full);
    const Image back = read_exr(folder / "a.exr");
    EXPECT_EQ(back.width, 37u);
    EXPECT_EQ(back.height, 21u);
    EXPECT_EQ(back.metadata, image.metadata);
    ASSERT_EQ(back.channels.size(), image.channels.size());
    for (const Image::Channel& channel : image.channels) {
        ASSERT_NE(back.find(channel.name), nullptr) << channel.name;
        EXPECT_TRUE(same_bits(back.find(channel.name)->values, channel.values)) << channel.name;
    }
}

TEST(exr, halves_round_to_11_bits_but_depth_and_position_stay_floats) {
    TempFolder folder;
    const Image image = layered(16, 40);
    write_exr(folder / "a.exr", image);
    const Image back = read_exr(folder / "a.exr");
    for (const Image::Channel& channel : image.channels) {
        const std::vector<float>& values = back.find(channel.name)->values;
        if (channel.name == "Z" || channel.name.starts_with("P.")) {
            EXPECT_TRUE(same_bits(values, channel.values)) << channel.name;
            continue;
        }
        EXPECT_FALSE(same_bits(values, channel.values)) << channel.name;
        for (size_t i = 0; i < values.size(); ++i)  // half an ulp: 2^-11 of the value, 2^-25 where denormal
            ASSERT_NEAR(values[i], channel.values[i], std::abs(channel.values[i]) * 0x1p-11f + 0x1p-25f) << channel.name << i;
    }
}

TEST(exr, halves_clamp_what_is_finite_and_keep_what_is_not) {
    TempFolder folder;
    Image image;
    image.width = 6, image.height = 1;
    image.add("R") = {1e6f, -1e6f, 65519, inf, -inf, std::nanf("")};
    write_exr(folder / "a.exr", image);
    const std::vector<float> back = read_exr(folder / "a.exr").channels[0].values;
    EXPECT_EQ((std::vector<float>{back.begin(), back.begin() + 5}), (std::vector<float>{65504, -65504, 65504, inf, -inf}));
    EXPECT_TRUE(std::isnan(back[5]));
}

TEST(exr, same_image_same_bytes) {
    TempFolder folder;
    write_exr(folder / "a.exr", layered(50, 50));
    write_exr(folder / "b.exr", layered(50, 50));
    EXPECT_EQ(bytes_of(folder / "a.exr"), bytes_of(folder / "b.exr"));
    Image other = layered(50, 50);
    other.channels[3].values[77] += 1;
    write_exr(folder / "c.exr", other);
    EXPECT_NE(bytes_of(folder / "a.exr"), bytes_of(folder / "c.exr"));
}

TEST(exr, reads_tiles_halves_uints_and_an_offset_window) {
    TempFolder folder;
    const Imath::Box2i window({-3, 5}, {36, 34});  // 40 x 30, overscan to the left
    Imf::Header header(Imath::Box2i({0, 0}, {99, 99}), window);
    header.setTileDescription({16, 16, Imf::ONE_LEVEL});
    header.compression() = Imf::PIZ_COMPRESSION;
    header.channels().insert("R", Imf::Channel(Imf::HALF));
    header.channels().insert("id", Imf::Channel(Imf::UINT));
    std::vector<half> red(1200);
    std::vector<uint32_t> id(1200);
    for (uint32_t i = 0; i < 1200; ++i) red[i] = half(float(i) / 4), id[i] = i * 3;
    Imf::FrameBuffer planes;
    planes.insert("R", Imf::Slice::Make(Imf::HALF, red.data(), window));
    planes.insert("id", Imf::Slice::Make(Imf::UINT, id.data(), window));
    {
        Imf::TiledOutputFile out((folder / "t.exr").c_str(), header);
        out.setFrameBuffer(planes);
        out.writeTiles(0, out.numXTiles() - 1, 0, out.numYTiles() - 1);
    }
    const Image image = read_exr(folder / "t.exr");
    ASSERT_EQ(image.width, 40u);
    ASSERT_EQ(image.height, 30u);
    for (uint32_t i = 0; i < 1200; ++i) {
        ASSERT_EQ(image.find("R")->values[i], float(red[i])) << i;
        ASSERT_EQ(image.find("id")->values[i], float(i * 3)) << i;
    }
}

TEST(exr, every_truncation_is_one_clear_error) {
    TempFolder folder;
    write_exr(folder / "a.exr", layered(9, 40));
    const std::string whole = bytes_of(folder / "a.exr");
    for (size_t length = 0; length < whole.size(); length += 1 + length / 64) {
        put(folder / "cut.exr", whole.substr(0, length));
        const std::string message = input_error([&] { read_exr(folder / "cut.exr"); });
        EXPECT_TRUE(contains(message, "cut.exr")) << length;
        EXPECT_TRUE(length <= 8 || contains(message, "truncated")) << length << ": " << message;
    }
}

TEST(exr, damaged_bytes_never_crash) {
    TempFolder folder;
    write_exr(folder / "a.exr", layered(9, 20));
    const std::string whole = bytes_of(folder / "a.exr");
    std::mt19937 random(3);
    for (int i = 0; i < 400; ++i) {
        std::string damaged = whole;
        // Half of the time in the header, where it hurts most.
        for (int k = 0; k < 3; ++k) damaged[random() % (i % 2 ? 600 : damaged.size())] = static_cast<char>(random());
        put(folder / "d.exr", damaged);
        try {
            read_exr(folder / "d.exr");
        } catch (const InputError&) {
        }
    }
}

TEST(exr, refuses_what_it_cannot_hold) {
    TempFolder folder;
    EXPECT_TRUE(contains(input_error([&] { read_exr(folder / "none.exr"); }), "No such file"));
    put(folder / "text.exr", "hello, this is text");
    EXPECT_TRUE(contains(input_error([&] { read_exr(folder / "text.exr"); }), "not an OpenEXR file"));

    // Bombs: one pixel's file with a patched data window, and bytes enough to look like a table of chunks.
    Image one;
    one.width = one.height = 1;
    one.add("R");
    write_exr(folder / "one.exr", one);
    const std::string whole = bytes_of(folder / "one.exr");
    const size_t window = whole.find("dataWindow") + sizeof "dataWindow" + sizeof "box2i" + 4;
    for (const auto& [last, complaint] : {std::pair{0x7ffffffe, "data window"}, {199'999, "truncated or damaged"},
                                          {19'999, "beyond 2^28 pixels"}, {9'999, "fewer bytes than its pixels need"}}) {
        std::string bomb = whole + std::string(20'000, 'x');
        std::memcpy(bomb.data() + window + 8, &last, 4);
        std::memcpy(bomb.data() + window + 12, &last, 4);
        put(folder / "bomb.exr", bomb);
        const std::string message = input_error([&] { read_exr(folder / "bomb.exr"); });
        EXPECT_TRUE(contains(message, complaint)) << message;
    }

    Imf::Header header(4, 4);
    header.channels().insert("BY", Imf::Channel(Imf::HALF, 2, 2));
    std::vector<half> values(4);
    Imf::FrameBuffer planes;
    planes.insert("BY", Imf::Slice(Imf::HALF, reinterpret_cast<char*>(values.data()), 2, 4, 2, 2));
    {
        Imf::OutputFile out((folder / "sub.exr").c_str(), header);
        out.setFrameBuffer(planes);
        out.writePixels(4);
    }
    EXPECT_TRUE(contains(input_error([&] { read_exr(folder / "sub.exr"); }), "subsampled"));
}

TEST(exr, writes_whole_or_nothing) {
    TempFolder folder;
    Image image = layered(4, 4);
    EXPECT_TRUE(contains(input_error([&] { write_exr(folder / "none/a.exr", image); }), "create it"));
    EXPECT_TRUE(contains(input_error([&] { write_exr("/dev/full", image); }), "/dev/full"));
    EXPECT_TRUE(contains(input_error([&] { write_exr(folder / "a.exr", Image{}); }), "empty"));
    image.metadata["channels"] = "mine";
    EXPECT_TRUE(contains(input_error([&] { write_exr(folder / "a.exr", image); }), "reserves the attribute 'channels'"));
    image.metadata = {{"type", "mine"}};
    EXPECT_TRUE(contains(input_error([&] { write_exr(folder / "a.exr", image); }), "'type'"));
    EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace myriad::tools
