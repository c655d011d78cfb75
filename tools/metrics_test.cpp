// The constants come from a separate program in another language (Python, double, direct two-dimensional windows and the
// textbook form of variance), written from the formulas in metrics.hpp, or from the hand computation beside them.
#include "tools/metrics.hpp"

#include <cmath>
#include <limits>

#include "tools/temp_folder.hpp"

namespace myriad::tools {
namespace {

Image grey(uint32_t width, uint32_t height, std::vector<float> values) {
    Image image;
    image.width = width, image.height = height;
    for (const char* name : {"R", "G", "B"}) image.add(name) = values;
    return image;
}

// v = ((7x + 13y) mod 17) / 17; reference (v, v/2, 1.25 - v); test 0.9 r + 0.05 on odd squares of a chessboard.
std::pair<Image, Image> pattern(uint32_t width, uint32_t height) {
    Image r, t;
    r.width = t.width = width, r.height = t.height = height;
    r.origin = "ref.exr", t.origin = "test.exr";
    for (int c = 0; c < 3; ++c) {
        const std::string name(1, "RGB"[c]);
        auto &a = r.add(name), &b = t.add(name);
        for (uint32_t i = 0; i < width * height; ++i) {
            const uint32_t x = i % width, y = i / width;
            const double v = (x * 7 + y * 13) % 17 / 17.;
            a[i] = static_cast<float>(c == 0 ? v : c == 1 ? 0.5 * v : 1.25 - v);
            b[i] = static_cast<float>(0.9 * a[i] + 0.05 * ((x + y) % 2));
        }
    }
    return {r, t};
}

TEST(metrics, by_hand) {
    // r = (1, 0), t = (1.5, 0.1): squares 0.25 and 0.01; r^2 + 0.01 = 1.01 and 0.01.
    const Metrics m = measure(grey(2, 1, {1, 0}), grey(2, 1, {1.5f, 0.1f}), 0.2);
    EXPECT_NEAR(m.mse, 0.13, 1e-8);
    EXPECT_NEAR(m.rel_mse, (0.25 / 1.01 + 1) / 2, 1e-7);
    EXPECT_NEAR(m.mae, 0.3, 1e-8);
    EXPECT_EQ(m.max_abs, 0.5);
    EXPECT_EQ(m.p95_abs, 0.5);
    EXPECT_EQ(m.failing, 0.5);
    EXPECT_EQ(m.clipped, 0) << "1 is not above 1";
    // Display values (1, 0) and (1, e), e = 1.055 * 0.1^(1/2.4) - 0.055 = 0.349190213; PSNR = 10 log10(2 / e^2).
    EXPECT_NEAR(m.psnr, 12.149059, 1e-6);
}

TEST(metrics, ssim_of_flat_images_by_hand) {
    // No variance: SSIM = (2ab + c1) / (a^2 + b^2 + c1), a = 1, b = 0, c1 = 1e-4.
    const Metrics m = measure(grey(20, 20, std::vector<float>(400, 1)), grey(20, 20, std::vector<float>(400, 0)), 0);
    EXPECT_NEAR(m.ssim, 1e-4 / 1.0001, 1e-12);
    EXPECT_EQ(m.psnr, 0) << "as far apart as clamped images can be";
}

TEST(metrics, against_an_independent_program) {
    struct Case {
        uint32_t width, height;
        double rel_mse, mse, psnr, ssim, mae, p95, failing, clipped;
    };
    for (const Case& c : {Case{13, 12, 0.017250796089975526, 0.0023399470620442445, 26.96538651065928, 0.9522975473952052,
                               0.03863122300284668, 0.1191176176071167, 0.6410256410256411, 0.09615384615384616},
                          Case{16, 16, 0.016704924346474446, 0.002336811702130695, 27.4830805612395, 0.9389818328926945,
                               0.038556986437470187, 0.1191176176071167, 0.64453125, 0.09765625},
                          Case{4, 3, 0.006488655475422926, 0.002317377651659669, 32.96185489706971, 0.9954217288363265,
                               0.03398692711359925, 0.125, 0.5833333333333334, 0.1111111111111111}}) {
        const auto [r, t] = pattern(c.width, c.height);
        const Metrics m = measure(r, t, 0.05);
        EXPECT_NEAR(m.rel_mse, c.rel_mse, 1e-12);
        EXPECT_NEAR(m.mse, c.mse, 1e-12);
        EXPECT_NEAR(m.psnr, c.psnr, 1e-8);
        EXPECT_NEAR(m.ssim, c.ssim, 1e-6);  // luma planes are floats here
        EXPECT_NEAR(m.mae, c.mae, 1e-12);
        EXPECT_EQ(m.max_abs, 0.125);
        EXPECT_NEAR(m.p95_abs, c.p95, 1e-9);
        EXPECT_NEAR(m.failing, c.failing, 1e-12);
        EXPECT_NEAR(m.clipped, c.clipped, 1e-12);
    }
}

TEST(metrics, identical_images) {
    for (auto [width, height] : {std::pair{1u, 1u}, {3u, 2u}, {11u, 11u}, {40u, 30u}}) {
        const Image r = pattern(width, height).first;
        const Metrics m = measure(r, r, 0);
        EXPECT_EQ(m.mse + m.rel_mse + m.mae + m.max_abs + m.p95_abs + m.failing, 0);
        EXPECT_EQ(m.psnr, 200);
        EXPECT_NEAR(m.ssim, 1, 1e-12);
        EXPECT_TRUE(m.finite());
    }
}

TEST(metrics, one_wrong_value_moves_every_metric) {
    const Image r = pattern(20, 20).first;
    const Metrics same = measure(r, r, 0.01);
    for (size_t channel = 0; channel < 3; ++channel)
        for (size_t pixel : {0, 19, 210, 399}) {
            Image t = r;
            t.channels[channel].values[pixel] = r.channels[channel].values[pixel] > 0.5 ? 0.f : 1.f;
            const Metrics m = measure(r, t, 0.01);
            EXPECT_GT(m.mse, same.mse);
            EXPECT_GT(m.rel_mse, same.rel_mse);
            EXPECT_GT(m.mae, same.mae);
            EXPECT_GT(m.max_abs, same.max_abs);
            EXPECT_LT(m.psnr, 60);
            // The windows hardly see the corners: 1e-6 of the weight of one window.
            if (pixel == 210) { EXPECT_LT(m.ssim, 0.9999999); }
            EXPECT_EQ(m.failing, 1. / 400);
            EXPECT_EQ(m.p95_abs, 0) << "one pixel in 400 is not 5 %";
        }
}

TEST(metrics, rel_mse_is_not_symmetric_and_mse_is) {
    const auto [r, t] = pattern(20, 20);
    EXPECT_EQ(measure(r, t, 0).mse, measure(t, r, 0).mse);
    EXPECT_NE(measure(r, t, 0).rel_mse, measure(t, r, 0).rel_mse);
}

// Otherwise by flip_test.cpp.
TEST(metrics, flip_is_measured_where_it_is_asked_for) {
    const auto [r, t] = pattern(40, 30);
    Metrics m = measure(r, t, 0);
    EXPECT_TRUE(std::isnan(m.flip) && std::isnan(m.hdr_flip));
    measure_flip(m, r, t);
    EXPECT_NEAR(m.flip, 0.1167758, 1e-5);  // this and the next: NVIDIA's evaluator
    EXPECT_NEAR(m.p95_flip, 0.1308104, 3e-5);
    EXPECT_NEAR(m.hdr_flip, 0.1399386, 1e-5);
    EXPECT_NEAR(m.p95_hdr_flip, 0.1903050, 3e-5);
    Image bad = t;
    bad.channels[1].values[7] = std::numeric_limits<float>::infinity();
    m = measure(r, bad, 0);
    measure_flip(m, r, bad);
    EXPECT_TRUE(std::isnan(m.flip) && std::isnan(m.p95_hdr_flip));
    const std::vector<float> errors = flip_errors(Flip::ldr, r, bad);
    EXPECT_TRUE(std::isnan(errors[7]) && std::isfinite(errors[8]));
}

TEST(metrics, percentile_is_nearest_rank) {
    std::vector<float> values;
    for (int i = 20; i >= 1; --i) values.push_back(static_cast<float>(i));
    EXPECT_EQ(percentile(values, 0.95), 19);
    EXPECT_EQ(percentile(values, 0.951), 20);
    EXPECT_EQ(percentile(values, 1), 20);
    EXPECT_EQ(percentile(values, 0.001), 1);
    EXPECT_EQ(percentile({4}, 0.5), 4);
}

TEST(metrics, non_finite_values_are_counted_and_poison_the_rest) {
    const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    const auto [r, t] = pattern(20, 10);
    Image bad = t;
    bad.channels[2].values[45] = nan;
    bad.channels[0].values[45] = -inf;
    bad.channels[1].values[60] = inf;
    const Metrics m = measure(r, bad, 0);
    EXPECT_FALSE(m.finite());
    EXPECT_EQ(m.reference.total(), 0u);
    EXPECT_EQ(m.test.nan, 1u);
    EXPECT_EQ(m.test.inf, 2u);
    EXPECT_EQ(m.test.x, 5u);
    EXPECT_EQ(m.test.y, 2u);
    for (const MetricName& metric : metric_names()) EXPECT_TRUE(std::isnan(m.*metric.value)) << metric.name;
    EXPECT_EQ(measure(bad, r, 0).reference.total(), 3u);
    EXPECT_FALSE(measure(bad, bad, 0).finite()) << "identical, and still a failure";
}

TEST(metrics, difference_image) {
    const Image d = absolute_difference(grey(2, 1, {1, 2}), grey(2, 1, {1.5f, 0}));
    EXPECT_EQ(d.rgb()->g[0], 0.5f);
    EXPECT_EQ(d.rgb()->g[1], 2.f);
    const float r[] = {1, 2}, g[] = {3, 0}, b[] = {2, std::numeric_limits<float>::infinity()};
    EXPECT_EQ(greatest_channel({r, g, b}), (std::vector<float>{3, std::numeric_limits<float>::infinity()}));
}

TEST(metrics, refuses_images_that_do_not_match) {
    const Image r = pattern(4, 3).first, wide = pattern(5, 3).first;
    const std::string sizes = input_error([&] { measure(r, wide, 0); });
    EXPECT_TRUE(contains(sizes, "4x3") && contains(sizes, "5x3")) << sizes;
    EXPECT_TRUE(contains(input_error([&] { absolute_difference(wide, r); }), "one size"));
    const std::string layer = input_error([&] { measure(r, r, 0, "direct"); });
    EXPECT_TRUE(contains(layer, "ref.exr") && contains(layer, "'direct'") && contains(layer, "R, G, B")) << layer;
    EXPECT_TRUE(contains(input_error([&] { flip_errors(Flip::hdr, r, wide); }), "one size"));
    EXPECT_TRUE(contains(input_error([&] { measure(Image{}, Image{}, 0); }), "no pixels"));
}

}  // namespace
}  // namespace myriad::tools
