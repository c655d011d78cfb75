#include "tools/view/raster.hpp"

#include <imgui.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>

namespace myriad::tools::view {
namespace {

constexpr uint32_t width = 70, height = 67;
constexpr uint32_t black = 0xff000000u;

// Triangles as ImGui would list them, over black.
class Drawing {
public:
    explicit Drawing(const Texture& texture) {
        list.CmdBuffer.push_back({});
        list.CmdBuffer[0].ClipRect = {0, 0, float(width), float(height)};
        list.CmdBuffer[0].TextureId = const_cast<Texture*>(&texture);
    }
    void triangle(const ImDrawVert& a, const ImDrawVert& b, const ImDrawVert& c) {
        for (const ImDrawVert& v : {a, b, c}) list.IdxBuffer.push_back(ImDrawIdx(list.VtxBuffer.Size)), list.VtxBuffer.push_back(v);
        list.CmdBuffer[0].ElemCount += 3;
    }
    void rectangle(ImVec2 low, ImVec2 high, uint32_t colour, ImVec2 from = {0, 0}, ImVec2 to = {0, 0}) {
        const ImDrawIdx first = ImDrawIdx(list.VtxBuffer.Size);
        for (const ImDrawVert& v : {ImDrawVert{low, from, colour}, {{high.x, low.y}, {to.x, from.y}, colour}, {high, to, colour}, {{low.x, high.y}, {from.x, to.y}, colour}})
            list.VtxBuffer.push_back(v);
        for (const int i : {0, 1, 2, 0, 2, 3}) list.IdxBuffer.push_back(ImDrawIdx(first + i));
        list.CmdBuffer[0].ElemCount += 6;
    }
    std::vector<uint32_t> pixels() {
        std::vector<uint32_t> out(width * height, black);
        ImDrawList* lists = &list;
        ImDrawData data;
        data.CmdLists = &lists, data.CmdListsCount = 1;
        draw(data, out, width, height);
        return out;
    }
    ImDrawList list{nullptr};
};

const uint32_t white_texel = ~0u;
const Texture white{1, 1, &white_texel};

TEST(view_raster, a_pixel_is_covered_when_its_middle_is) {
    Drawing drawing(white);
    drawing.rectangle({2.4f, 3.6f}, {5.5f, 6.6f}, 0xff0000ffu);
    const auto pixels = drawing.pixels();
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) EXPECT_EQ(pixels[y * width + x], x >= 2 && x < 5 && y >= 4 && y < 7 ? 0xff0000ffu : black) << x << "," << y;
}

TEST(view_raster, rectangles_are_what_their_triangles_are) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> place(-10, 80);
    for (int i = 0; i < 300; ++i) {
        const ImVec2 a{place(random), place(random)}, b{place(random), place(random)};
        const ImVec2 low{std::min(a.x, b.x), std::min(a.y, b.y)}, high{std::max(a.x, b.x), std::max(a.y, b.y)};
        const uint32_t colour = random() | 0x01000000u;
        Drawing fast(white), slow(white);
        fast.rectangle(low, high, colour);
        const ImVec2 none{0, 0};
        slow.triangle({low, none, colour}, {{high.x, low.y}, none, colour}, {high, none, colour});
        slow.triangle({low, none, colour}, {high, none, colour}, {{low.x, high.y}, none, colour});
        EXPECT_EQ(fast.pixels(), slow.pixels());
    }
}

// A fan of see-through triangles around a point: were one pixel theirs twice, or nobody's, it would show.
TEST(view_raster, of_a_shared_edge_each_pixel_belongs_to_one) {
    std::mt19937 random(6);
    std::uniform_real_distribution<float> place(10, 55);
    for (int turn = 0; turn < 50; ++turn) {
        Drawing drawing(white);
        const ImVec2 middle{turn % 2 ? place(random) : 32.5f, turn % 2 ? place(random) : 32.5f}, none{0, 0};
        const std::vector<ImVec2> around = {{0, 0}, {30, 0}, {70, 0}, {70, 40}, {70, 67}, {20, 67}, {0, 67}, {0, 10}};
        for (size_t i = 0; i < around.size(); ++i)
            drawing.triangle({middle, none, 0x80ffffffu}, {around[i], none, 0x80ffffffu}, {around[(i + 1) % around.size()], none, 0x80ffffffu});
        const auto pixels = drawing.pixels();
        EXPECT_EQ(std::ranges::count(pixels, 0xff808080u), width * height);
    }
}

TEST(view_raster, blends_textures_colours_and_what_is_below) {
    const uint32_t texels[] = {0xff0000ffu, 0xff00ff00u, 0x80ffffffu, 0x00123456u};
    const Texture texture{2, 2, texels};
    Drawing drawing(texture);
    drawing.rectangle({0, 0}, {4, 4}, ~0u, {0, 0}, {1, 1});
    drawing.rectangle({10, 0}, {14, 4}, 0xff8000ffu, {0, 0}, {1, 1});
    const auto pixels = drawing.pixels();
    EXPECT_EQ(pixels[0], 0xff0000ffu);
    EXPECT_EQ(pixels[3], 0xff00ff00u);
    EXPECT_EQ(pixels[3 * width], 0xff808080u);
    EXPECT_EQ(pixels[3 * width + 3], black) << "nothing is there";
    EXPECT_EQ(pixels[10], 0xff0000ffu);
    EXPECT_EQ(pixels[13], black) << "green through purple";
}

TEST(view_raster, smooth_textures_pass_from_texel_to_texel) {
    const uint32_t texels[] = {black, ~0u};
    const Texture texture{2, 1, texels, true};
    Drawing drawing(texture);
    drawing.rectangle({0, 0}, {64, 1}, ~0u, {0, 0}, {1, 1});
    const auto pixels = drawing.pixels();
    EXPECT_EQ(pixels[0], black);
    EXPECT_EQ(pixels[63], ~0u);
    EXPECT_TRUE(std::is_sorted(pixels.begin(), pixels.begin() + 64));
    EXPECT_NEAR(double(pixels[32] & 255), 128, 5);
}

TEST(view_raster, clips) {
    Drawing drawing(white);
    drawing.list.CmdBuffer[0].ClipRect = {5, 6, 9, 8};
    drawing.rectangle({-1000, -1000}, {1000, 1000}, ~0u);
    drawing.triangle({{-500, -500}, {0, 0}, ~0u}, {{900, 0}, {0, 0}, ~0u}, {{0, 900}, {0, 0}, ~0u});
    EXPECT_EQ(std::ranges::count(drawing.pixels(), ~0u), 4 * 2);
}

}  // namespace
}  // namespace myriad::tools::view
