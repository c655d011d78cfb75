#include "scenes/import/picture.hpp"

#include <gtest/gtest.h>

namespace myriad::scenes::importing {
namespace {

std::string refused(const std::string& bytes) {
    std::string problem;
    EXPECT_FALSE(decode_picture({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, problem));
    return problem;
}

TEST(Picture, a_targa) {
    const std::string bytes("\0\0\2\0\0\0\0\0\0\0\0\0\2\0\1\0\x18\x20\3\2\1\6\5\4", 24);
    std::string problem;
    const auto picture = decode_picture({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, problem);
    ASSERT_TRUE(picture) << problem;
    EXPECT_EQ(picture->rgba, (std::vector<uint8_t>{1, 2, 3, 255, 4, 5, 6, 255}));
}

// Formats that the library knows besides those that are promised, some of which it does not read safely.
TEST(Picture, what_is_not_let_in) {
    for (const std::string& bytes : {std::string(), "P5 2 2 65535\n" + std::string(8, '\1'), std::string("P6 1 1 255\n\1\2\3"), "P5" + std::string(60, '9') + " 1 9\n\1",
                                     "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" + std::string(4, '\1')})
        EXPECT_EQ(refused(bytes), "it is in no known format") << bytes;
}

// Twenty-eight bytes that want a picture of 8000 x 8000, three times over while it is decoded.
TEST(Picture, a_picture_out_of_all_proportion) {
    EXPECT_EQ(refused(std::string("GIF89a\x40\x1f\x40\x1f\0\0\0,\0\0\0\0\x40\x1f\x40\x1f\0\2\1\x44\0;", 28)), "it expands too much");
}

}  // namespace
}  // namespace myriad::scenes::importing
