#include "tools/png.hpp"

#include <limits>

#include "tools/temp_folder.hpp"

namespace myriad::tools {
namespace {

TEST(png, round_trip_and_srgb_chunk) {
    TempFolder folder;
    Picture picture{3, 2, {}};
    for (int i = 0; i < 18; ++i) picture.rgb.push_back(static_cast<uint8_t>(i * 15));
    write_png(folder / "a.png", picture);
    const Picture back = read_png(folder / "a.png");
    EXPECT_EQ(back.width, 3u);
    EXPECT_EQ(back.height, 2u);
    EXPECT_EQ(back.rgb, picture.rgb);
    EXPECT_TRUE(contains(bytes_of(folder / "a.png"), "sRGB"));
    write_png(folder / "b.png", picture);
    EXPECT_EQ(bytes_of(folder / "a.png"), bytes_of(folder / "b.png"));
}

TEST(png, encodes_linear_values) {
    const float r[] = {0, 0.5f}, g[] = {2, -1}, b[] = {0.0031308f, std::numeric_limits<float>::quiet_NaN()};
    const Picture picture = to_picture({r, g, b}, 2, 1);
    // 0.5 -> 187.52; 0.0031308 -> 12.92 * 0.0031308 * 255 = 10.31
    EXPECT_EQ(picture.rgb, (std::vector<uint8_t>{0, 255, 10, 188, 0, 0}));
}

TEST(png, heat_map_gets_lighter_all_the_way) {
    std::vector<float> ramp(101);
    for (size_t i = 0; i < ramp.size(); ++i) ramp[i] = static_cast<float>(i) * 0.02f;
    const Picture map = heat_map(ramp, 101, 1, 2);
    double last = -1;
    for (size_t i = 0; i < ramp.size(); ++i) {
        const double luma = 0.2126 * map.rgb[3 * i] + 0.7152 * map.rgb[3 * i + 1] + 0.0722 * map.rgb[3 * i + 2];
        EXPECT_GT(luma, last) << i;
        last = luma;
    }
    EXPECT_EQ(map.rgb[2], 79);
    EXPECT_EQ(map.rgb[300], 255);
}

TEST(png, heat_map_of_hard_values) {
    const float inf = std::numeric_limits<float>::infinity();
    const float values[] = {inf, std::numeric_limits<float>::quiet_NaN(), 1e30f, 0};
    for (double scale : {0., 1e-300, 1., 1e30}) {
        const Picture map = heat_map(values, 4, 1, scale);
        EXPECT_EQ(map.rgb[2], 255) << "Inf is white";
        EXPECT_EQ(map.rgb[5], 255) << "NaN is white";
        EXPECT_EQ(map.rgb[11], 79) << "zero is dark";
        EXPECT_EQ(map.rgb[8], scale > 0 ? 191 : 79);
    }
}

TEST(png, errors) {
    TempFolder folder;
    EXPECT_TRUE(contains(input_error([&] { read_png(folder / "none.png"); }), "No such file"));
    put(folder / "text.png", "not a picture");
    EXPECT_TRUE(contains(input_error([&] { read_png(folder / "text.png"); }), "text.png"));
    write_png(folder / "a.png", {4, 4, std::vector<uint8_t>(48, 7)});
    const std::string whole = bytes_of(folder / "a.png");
    for (size_t length = 0; length + 20 < whole.size(); ++length) {  // the last chunk, IEND, may be missed
        put(folder / "cut.png", whole.substr(0, length));
        input_error([&] { read_png(folder / "cut.png"); });
    }
    EXPECT_TRUE(contains(input_error([&] { write_png(folder / "e.png", {}); }), "empty"));
    EXPECT_FALSE(std::filesystem::exists(folder / "e.png"));
}

}  // namespace
}  // namespace myriad::tools
