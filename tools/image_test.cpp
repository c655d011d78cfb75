#include "tools/image.hpp"

#include <cmath>

#include "tools/temp_folder.hpp"

namespace myriad::tools {
namespace {

TEST(image, splits_interleaved_texels_into_planes) {
    Image image;
    image.width = 2, image.height = 1;
    const float texels[] = {1, 2, 3, 9, 4, 5, 6, 9};
    image.add({"direct.R", "direct.G", "direct.B"}, texels, 4);
    const auto rgb = image.rgb("direct");
    ASSERT_TRUE(rgb);
    EXPECT_EQ(rgb->r[1], 4);
    EXPECT_EQ(rgb->g[0], 2);
    EXPECT_EQ(rgb->b[1], 6);
    EXPECT_EQ(image.find("direct.A"), nullptr);
    EXPECT_FALSE(image.rgb()) << "a layer is not the beauty";
}

TEST(image, layers_may_be_colours_vectors_or_one_plane) {
    Image image;
    image.width = image.height = 1;
    float value = 0;
    for (const char* name : {"N.X", "N.Y", "N.Z", "Z"}) image.add(name)[0] = ++value;
    EXPECT_EQ(image.rgb("N")->b[0], 3);
    EXPECT_EQ(image.rgb("Z")->r[0], 4);
    EXPECT_EQ(image.rgb("Z")->b[0], 4);
    EXPECT_FALSE(image.rgb("P"));
    image.add("Y")[0] = 7;  // a grey image
    EXPECT_EQ(image.rgb()->g[0], 7);
}

TEST(image, srgb_encoding) {
    EXPECT_EQ(srgb_encode(-1), 0);
    EXPECT_EQ(srgb_encode(std::nan("")), 0);
    EXPECT_EQ(srgb_encode(5), 1);
    EXPECT_NEAR(srgb_encode(0.5), 0.735356983052449, 1e-12);  // 1.055 * 0.5^(1/2.4) - 0.055, by hand
    EXPECT_NEAR(srgb_encode(0.002), 0.02584, 1e-12);          // the linear part
}

TEST(image, require_readable_names_the_file_and_the_cure) {
    TempFolder folder;
    const std::string missing = input_error([&] { require_readable(folder / "none.exr"); });
    EXPECT_TRUE(contains(missing, "none.exr") && contains(missing, "No such file")) << missing;
    EXPECT_TRUE(contains(input_error([&] { require_readable(folder.path); }), "folder"));
    put(folder / "some", "x");
    require_readable(folder / "some");
}

}  // namespace
}  // namespace myriad::tools
