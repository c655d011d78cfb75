// How far one image is from another. Every metric is the formula below and nothing else; r is the reference, t the test,
// linear radiance; sums run in double over all pixels and the channels R, G, B.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/flip.hpp"
#include "tools/image.hpp"

namespace myriad::tools {

struct NonFinite {
    uint64_t nan = 0, inf = 0;  // values, not pixels
    uint32_t x = 0, y = 0;      // the first pixel that has one, in row order
    uint64_t total() const { return nan + inf; }
};

// The square of the radiance (0.1) below which errors count as absolute rather than relative ones.
inline constexpr double rel_mse_epsilon = 1e-2;

struct Metrics {
    double mse = 0;      // mean of (t - r)^2
    double rel_mse = 0;  // mean of (t - r)^2 / (r^2 + rel_mse_epsilon)
    // -10 log10(mean of (t' - r')^2), dB, where ' clamps to [0, 1] and encodes as sRGB: radiance has no peak, a display
    // has (1), and errors count about as they are seen. Capped at 200 dB, beyond what floats resolve, so that identical
    // images have a number.
    double psnr = 0;
    // Wang et al. 2004 on the luma 0.2126 R' + 0.7152 G' + 0.0722 B': Gaussian window 11x11, sigma 1.5, K1 = 0.01,
    // K2 = 0.03, L = 1, mean over the windows that lie inside the image. Below 11 pixels a side the window shrinks to it.
    double ssim = 0;
    // How visible the difference is, in [0, 1]: tools/flip.hpp; the mean over pixels and the 95th percentile as below. By measure_flip,
    // and NaN without it, for they take a hundred times as long as all the others.
    double flip = not_measured, p95_flip = not_measured, hdr_flip = not_measured, p95_hdr_flip = not_measured;
    double mae = 0;      // mean of |t - r|
    double max_abs = 0;  // max of |t - r|
    double p95_abs = 0;  // 95th percentile, nearest rank, over pixels of the greatest |t - r| of the three channels
    double failing = 0;  // share of pixels whose greatest |t - r| exceeds `tolerance`
    // Share of r above 1, to which PSNR, SSIM and FLIP are blind: near 1 they say nothing.
    double clipped = 0;

    double tolerance = 0;
    NonFinite reference, test;

    static constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

    // NaN or Inf anywhere is a failure whatever the metrics, which are then all NaN.
    bool finite() const { return reference.total() + test.total() == 0; }
};

// The metrics by their names in `compare` (its table, its JSON, its limits), in the order to print them.
struct MetricName {
    const char* name;
    double Metrics::*value;
    const char* meaning;
};
std::span<const MetricName> metric_names();

// InputError when the sizes differ or an image lacks the layer (Image::rgb). `tolerance` is in the unit of the layer.
Metrics measure(const Image& reference, const Image& test, double tolerance, std::string_view layer = "");

// Adds FLIP and HDR-FLIP to what `measure` found of the same images; they stay NaN where these are not finite.
void measure_flip(Metrics& metrics, const Image& reference, const Image& test, double ppd = flip_ppd, std::string_view layer = "");

// The errors of each pixel by FLIP or HDR-FLIP, NaN where a value of either image is not finite. InputError as for measure.
enum class Flip { ldr, hdr };
std::vector<float> flip_errors(Flip kind, const Image& reference, const Image& test, double ppd = flip_ppd, std::string_view layer = "");

// Their mean by FLIP, alone: HDR-FLIP looks at every exposure and takes several times as long.
double mean_flip(const Image& reference, const Image& test);

// |t - r| as an image with channels R, G, B; errors as for measure.
Image absolute_difference(const Image& reference, const Image& test, std::string_view layer = "");

// The greatest channel of each pixel (NaN and Inf win).
std::vector<float> greatest_channel(const Image::Rgb& rgb);

// Nearest rank: the least value v with at least `share` of the values <= v. Values finite, not empty; 0 < share <= 1.
double percentile(std::vector<float> values, double share);

}  // namespace myriad::tools
