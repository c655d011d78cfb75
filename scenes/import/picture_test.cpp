#include "scenes/import/picture.hpp"

#include <gtest/gtest.h>

namespace myriad::scenes::importing {
namespace {

std::string refused(const std::string& bytes) {
    std::string problem;
    EXPECT_FALSE(decode_picture({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, problem));
    return problem;
}

TEST(Picture, maps_of_eight_bits) {
    const std::string bytes = "P6 2 1 255\n\1\2\3\4\5\6";
    std::string problem;
    const auto picture = decode_picture({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, problem);
    ASSERT_TRUE(picture) << problem;
    EXPECT_EQ(picture->rgba, (std::vector<uint8_t>{1, 2, 3, 255, 4, 5, 6, 255}));
}

// The library reads beyond the pixels of the first, and knows formats that are no textures.
TEST(Picture, what_is_not_let_in) {
    EXPECT_EQ(refused("P5 2 2 65535\n" + std::string(8, '\1')), "it has 16 bits a channel");
    EXPECT_EQ(refused("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" + std::string(4, '\1')), "it is in no known format");
    EXPECT_EQ(refused(""), "it is in no known format");
}

// Thirty bytes that want a picture of 8000 x 8000, three times over while it is decoded.
TEST(Picture, a_picture_out_of_all_proportion) {
    EXPECT_EQ(refused(std::string("GIF89a\x40\x1f\x40\x1f\0\0\0,\0\0\0\0\x40\x1f\x40\x1f\0\2\1\x44\0;", 30)), "it expands too much");
}

}  // namespace
}  // namespace myriad::scenes::importing
