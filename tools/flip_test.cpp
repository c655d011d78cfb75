// Constants are of three kinds: flat images, where filters vanish, by the formulas of the papers in another program (Python, double,
// colours from the primaries of sRGB); NVIDIA's own evaluator (github.com/NVlabs/flip, revision 1eb247cabcf2, C++ on the CPU, default
// parameters, linear input), fed with the images below; and what must hold of any image.
#include "tools/flip.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tools/metrics.hpp"

namespace myriad::tools {
namespace {

using Colour = std::array<float, 3>;

Image make(uint32_t width, uint32_t height, const auto& value) {  // value(x, y, channel)
    Image image;
    image.width = width, image.height = height;
    for (int c = 0; c < 3; ++c) {
        std::vector<float>& plane = image.add(std::string(1, "RGB"[c]));
        for (uint32_t i = 0; i < width * height; ++i) plane[i] = static_cast<float>(value(int(i % width), int(i / width), c));
    }
    return image;
}

Image flat(Colour colour) {
    return make(5, 4, [&](int, int, int c) { return colour[size_t(c)]; });
}
Image grey(float v) { return flat({v, v, v}); }

struct Pair {
    Image reference, test;
};

Pair chessboard(uint32_t width, uint32_t height) {  // as in metrics_test.cpp
    const Image r = make(width, height, [](int x, int y, int c) {
        const double v = (x * 7 + y * 13) % 17 / 17.;
        return c == 0 ? v : c == 1 ? 0.5 * v : 1.25 - v;
    });
    return {r, make(width, height, [&](int x, int y, int c) {
                return 0.9 * r.channels[size_t(c)].values[size_t(y) * width + size_t(x)] + 0.05 * ((x + y) % 2);
            })};
}

Pair waves(uint32_t width, uint32_t height) {  // smooth, with a box that is off
    const auto smooth = [](int x, int y, int c) { return float(0.5 + 0.4 * std::sin(x * 0.21 + c) * std::cos(y * 0.17 - c)); };
    return {make(width, height, smooth), make(width, height, [&](int x, int y, int c) {
                const bool box = x >= 10 && x < 20 && y >= 8 && y < 14;
                return box ? smooth(x, y, c) * 0.7 + 0.1 * c : double(smooth(x, y, c));
            })};
}

Pair bright(uint32_t width, uint32_t height) {  // from 1/64 to 64
    const auto light = [](int x, int y, int c) { return std::exp2(6 * std::sin(x * 0.13) * std::cos(y * 0.11 + c * 0.3)); };
    return {make(width, height, light),
            make(width, height, [&](int x, int y, int c) { return light(x, y, c) * (1 + 0.2 * std::sin(x * 0.9) * std::cos(y * 0.7)); })};
}

double mean(const std::vector<float>& errors) {
    double sum = 0;
    for (float e : errors) sum += e;
    return sum / double(errors.size());
}

std::vector<float> ldr(const Image& r, const Image& t, double ppd = flip_ppd) { return ldr_flip(*r.rgb(), *t.rgb(), r.width, r.height, ppd); }
std::vector<float> hdr(const Image& r, const Image& t, double ppd = flip_ppd) { return hdr_flip(*r.rgb(), *t.rgb(), r.width, r.height, ppd); }

TEST(flip, flat_images_by_formula) {
    struct Case {
        Colour a, b;
        double error;
    };
    for (const Case& c : {Case{{0, 0, 0}, {1, 1, 1}, 0.9673798}, Case{{0.2f, 0.2f, 0.2f}, {0.5f, 0.5f, 0.5f}, 0.5358436},
                          Case{{0.5f, 0.5f, 0.5f}, {0.51f, 0.51f, 0.51f}, 0.0406977},
                          Case{{0.001f, 0.001f, 0.001f}, {0.002f, 0.002f, 0.002f}, 0.0535854},
                          Case{{0.8f, 0.2f, 0.1f}, {0.1f, 0.3f, 0.6f}, 0.9499791}, Case{{0, 1, 0}, {0, 0, 1}, 1}})
        for (float error : ldr(flat(c.a), flat(c.b))) EXPECT_NEAR(error, c.error, 3e-5);
}

TEST(flip, agrees_with_nvidias_evaluator) {
    struct Case {
        Pair images;
        double ppd, ldr_mean, ldr_max, hdr_mean, hdr_max;
    };
    for (const Case& c : {Case{chessboard(40, 30), flip_ppd, 0.1167758, 0.1666532, 0.1399386, 0.5188558},
                          Case{chessboard(13, 12), 30, 0.1475572, 0.2171494, 0.1526844, 0.5766171},
                          Case{waves(40, 30), 30, 0.0299718, 0.5350134, 0.0286100, 0.5821486},
                          Case{waves(67, 50), flip_ppd, 0.0125554, 0.3893523, 0.0122595, 0.3748147},
                          Case{bright(40, 30), 30, 0.0779116, 0.3878869, 0.1206856, 0.2926510},
                          Case{bright(67, 50), flip_ppd, 0.0551005, 0.2375966, 0.0771562, 0.2137381}}) {
        const auto& [r, t] = c.images;
        const std::vector<float> l = ldr(r, t, c.ppd), h = hdr(r, t, c.ppd);
        EXPECT_NEAR(mean(l), c.ldr_mean, 1e-5);
        EXPECT_NEAR(*std::ranges::max_element(l), c.ldr_max, 3e-5);
        EXPECT_NEAR(mean(h), c.hdr_mean, 1e-5);
        EXPECT_NEAR(*std::ranges::max_element(h), c.hdr_max, 3e-5);
    }
}

TEST(flip, nothing_differs_from_itself) {
    for (const Pair& pair : {chessboard(1, 1), chessboard(40, 3), waves(3, 40), bright(33, 20)}) {
        EXPECT_EQ(ldr(pair.reference, pair.reference), std::vector<float>(pair.reference.pixels()));
        EXPECT_EQ(hdr(pair.test, pair.test), std::vector<float>(pair.reference.pixels()));
    }
}

TEST(flip, is_symmetric) {
    const auto [r, t] = waves(30, 20);
    EXPECT_EQ(ldr(r, t), ldr(t, r));
}

TEST(flip, greater_errors_are_greater) {
    double last = 0, last_box = 0;
    const Image r = make(24, 24, [](int, int, int) { return 0.2; });
    for (float t = 0.21f; t < 1; t *= 1.2f) {
        const double now = mean(ldr(grey(0.2f), grey(t)));
        EXPECT_GT(now, last);
        const double box = mean(ldr(r, make(24, 24, [&](int x, int y, int) { return x / 6 == 1 && y / 6 == 1 ? t : 0.2f; })));
        EXPECT_GT(box, last_box);
        last = now, last_box = box;
    }
}

TEST(flip, edges_make_it_greater_than_their_colours) {
    const Image r = make(40, 40, [](int, int, int) { return 0.2; }), step = make(40, 40, [](int x, int, int) { return x < 20 ? 0.2 : 0.3; });
    const std::vector<float> errors = ldr(r, step);
    EXPECT_GT(errors[20 * 40 + 20], 1.1 * errors[20 * 40 + 39]) << "far from the edge there is but colour";
}

// Images are worked on in bands of rows, so an image on its side is worked on otherwise.
TEST(flip, of_an_image_on_its_side) {
    const auto [r, t] = bright(18, 150);
    const auto turned = [](const Image& image) {
        return make(image.height, image.width, [&](int x, int y, int c) {
            return image.channels[size_t(c)].values[size_t(x) * image.width + size_t(y)];
        });
    };
    for (auto* kind : {ldr_flip, hdr_flip}) {
        const Image sr = turned(r), st = turned(t);
        const std::vector<float> up = kind(*r.rgb(), *t.rgb(), 18, 150, 30), side = kind(*sr.rgb(), *st.rgb(), 150, 18, 30);
        for (size_t i = 0; i < up.size(); ++i) ASSERT_NEAR(up[i], side[i % 18 * 150 + i / 18], 2e-5) << i;
    }
}

TEST(flip, exposures_span_the_maximum_and_the_median) {
    const auto of = [](std::vector<float> v) {
        return flip_exposures({v, v, v});
    };
    const double bright = 1.0832967;  // log2 of what is tone mapped to 0.85
    const FlipExposures e = of({1, 64, 2, 4, 8});
    EXPECT_NEAR(e.first, bright - 6, 1e-5);
    EXPECT_NEAR(e.last, bright - 2, 1e-5);
    EXPECT_EQ(e.count, 4u);
    EXPECT_EQ(of({1, 1, 1}).count, 1u) << "one luminance, one exposure";
    EXPECT_EQ(of({1, 1, 1.5f}).count, 2u);
    EXPECT_NEAR(of({0, 0, 0, 0, 2, 4, 8}).last, bright - 2, 1e-5) << "the median of what is lit";
    EXPECT_EQ(of({0, 0}).count, 1u);
    EXPECT_EQ(of({0, 0}).first, 0);
}

TEST(hdr_flip, by_formula) {
    // Flat 4 against flat 8: at the exposure that makes 4 to 0.85.
    for (float error : hdr(grey(4), grey(8))) EXPECT_NEAR(error, 0.1447528, 1e-4);
    EXPECT_EQ(mean(ldr(grey(4), grey(8))), 0) << "a display shows both as white";
}

TEST(hdr_flip, knows_no_unit) {
    const auto [r, t] = bright(25, 20);
    const auto scaled = [](Image image, float s) {
        for (auto& channel : image.channels)
            for (float& v : channel.values) v *= s;
        return image;
    };
    EXPECT_NEAR(mean(hdr(scaled(r, 1000), scaled(t, 1000))), mean(hdr(r, t)), 1e-5);
    EXPECT_GT(std::abs(mean(ldr(scaled(r, 1000), scaled(t, 1000))) - mean(ldr(r, t))), 0.01);
}

TEST(hdr_flip, sees_at_least_what_each_exposure_shows) {
    const auto [r, t] = bright(25, 20);
    const std::vector<float> errors = hdr(r, t);
    EXPECT_GT(mean(errors), 0.01);
    EXPECT_LT(*std::ranges::max_element(errors), 1);
}

TEST(flip, survives_any_value_and_distance) {
    const float inf = std::numeric_limits<float>::infinity(), most = std::numeric_limits<float>::max();
    auto [r, t] = bright(9, 7);
    t.channels[0].values[3] = std::numeric_limits<float>::quiet_NaN(), t.channels[1].values[20] = inf, t.channels[2].values[30] = -inf;
    r.channels[0].values[40] = most, r.channels[1].values[50] = -most, r.channels[2].values[60] = std::numeric_limits<float>::denorm_min();
    const auto check = [](const std::vector<float>& errors) {
        for (float error : errors) EXPECT_TRUE(error >= 0 && error <= 1) << error;
    };
    for (const auto& errors : {ldr(r, t), hdr(r, t), hdr(t, r), hdr(grey(0), grey(1)), hdr(grey(-1), grey(0))}) check(errors);
    for (double ppd : {double(flip_least_ppd), double(flip_most_ppd)}) check(ldr(r, t, ppd));
}

TEST(flip, farther_off_less_is_seen) {
    const auto [r, t] = chessboard(40, 40);
    EXPECT_GT(mean(ldr(r, t, 15)), 1.5 * mean(ldr(r, t, 120)));
}

}  // namespace
}  // namespace myriad::tools
