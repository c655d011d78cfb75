#include "tools/metrics.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "engine/error.hpp"

namespace myriad::tools {
namespace {

constexpr double psnr_cap = 200;

constexpr MetricName names[] = {
    {"relMSE", &Metrics::rel_mse, "mean (t-r)^2 / (r^2 + 0.01)"},
    {"MSE", &Metrics::mse, "mean (t-r)^2"},
    {"PSNR", &Metrics::psnr, "dB, clamped sRGB, peak 1, at most 200"},
    {"SSIM", &Metrics::ssim, "clamped sRGB luma, 1 is identical"},
    {"FLIP", &Metrics::flip, "visible difference, clamped to [0,1], mean"},
    {"p95FLIP", &Metrics::p95_flip, "its 95th percentile over pixels"},
    {"HDR-FLIP", &Metrics::hdr_flip, "the greatest over exposures, mean"},
    {"p95HDR-FLIP", &Metrics::p95_hdr_flip, "its 95th percentile over pixels"},
    {"MAE", &Metrics::mae, "mean |t-r|"},
    {"maxAbs", &Metrics::max_abs, "max |t-r|"},
    {"p95Abs", &Metrics::p95_abs, "95th percentile of |t-r| over pixels"},
    {"failing", &Metrics::failing, "share of pixels beyond the tolerance"},
    {"clipped", &Metrics::clipped, "share of reference values above 1"},
};

using Planes = std::array<std::span<const float>, 3>;

Planes planes_of(const Image& image, std::string_view layer) {
    const auto rgb = image.rgb(layer);
    if (rgb) return {rgb->r, rgb->g, rgb->b};
    std::string held;
    for (const Image::Channel& channel : image.channels) held += (held.empty() ? "" : ", ") + channel.name;
    throw InputError("'" + image.origin + "' has no " + (layer.empty() ? "channels R, G, B" : "layer '" + std::string(layer) + "'") +
                     "; it has " + (held.empty() ? "none" : held));
}

void require_same_size(const Image& r, const Image& t) {
    auto size = [](const Image& i) { return "'" + i.origin + "' is " + std::to_string(i.width) + "x" + std::to_string(i.height); };
    if (r.width != t.width || r.height != t.height)
        throw InputError(size(r) + " but " + size(t) + "; compare images of one size");
    if (!r.pixels()) throw InputError("'" + r.origin + "' has no pixels; compare images that have some");
}

NonFinite count_nonfinite(const Planes& planes, uint32_t width) {
    NonFinite count;
    for (size_t i = 0; i < planes[0].size(); ++i)
        for (const auto& plane : planes) {
            if (std::isfinite(plane[i])) continue;
            if (!count.total()) count.x = static_cast<uint32_t>(i % width), count.y = static_cast<uint32_t>(i / width);
            ++(std::isnan(plane[i]) ? count.nan : count.inf);
        }
    return count;
}

// Normalised Gaussian taps, sigma 1.5, centred, 11 of them or as many as the side has pixels.
std::vector<double> gaussian(uint32_t side) {
    std::vector<double> taps(std::min(side, 11u));
    double sum = 0;
    for (size_t i = 0; i < taps.size(); ++i) {
        const double x = static_cast<double>(i) - (static_cast<double>(taps.size()) - 1) / 2;
        sum += taps[i] = std::exp(-x * x / (2 * 1.5 * 1.5));
    }
    for (double& tap : taps) tap /= sum;
    return taps;
}

// Mean SSIM of two luma planes. Down the columns first, so that only one row of moments is held.
double mean_ssim(const std::vector<float>& r, const std::vector<float>& t, uint32_t width, uint32_t height) {
    constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    const std::vector<double> across = gaussian(width), down = gaussian(height);
    using Moments = std::array<double, 5>;  // E[r], E[t], E[r^2], E[t^2], E[rt]
    std::vector<Moments> row(width);
    const size_t columns = width - across.size() + 1, rows = height - down.size() + 1;
    double sum = 0;
    for (size_t y = 0; y < rows; ++y) {
        for (size_t x = 0; x < width; ++x) {
            Moments m{};
            for (size_t k = 0; k < down.size(); ++k) {
                const double a = r[(y + k) * width + x], b = t[(y + k) * width + x], w = down[k];
                m[0] += w * a, m[1] += w * b, m[2] += w * a * a, m[3] += w * b * b, m[4] += w * a * b;
            }
            row[x] = m;
        }
        for (size_t x = 0; x < columns; ++x) {
            Moments m{};
            for (size_t k = 0; k < across.size(); ++k)
                for (size_t i = 0; i < m.size(); ++i) m[i] += across[k] * row[x + k][i];
            const double rr = m[2] - m[0] * m[0], tt = m[3] - m[1] * m[1], rt = m[4] - m[0] * m[1];
            sum += (2 * m[0] * m[1] + c1) * (2 * rt + c2) / ((m[0] * m[0] + m[1] * m[1] + c1) * (rr + tt + c2));
        }
    }
    return sum / static_cast<double>(rows * columns);
}

}  // namespace

std::span<const MetricName> metric_names() { return names; }

Metrics measure(const Image& reference, const Image& test, double tolerance, std::string_view layer) {
    require_same_size(reference, test);
    const Planes r = planes_of(reference, layer), t = planes_of(test, layer);
    const size_t pixels = reference.pixels();

    Metrics m;
    m.tolerance = tolerance;
    m.reference = count_nonfinite(r, reference.width);
    m.test = count_nonfinite(t, reference.width);
    if (!m.finite()) {
        for (const MetricName& metric : names) m.*metric.value = std::numeric_limits<double>::quiet_NaN();
        return m;
    }

    constexpr double luma[] = {0.2126, 0.7152, 0.0722};
    std::vector<float> greatest(pixels), luma_r(pixels), luma_t(pixels);
    double display_mse = 0;
    uint64_t failing = 0, clipped = 0;
    for (size_t i = 0; i < pixels; ++i) {
        double worst = 0, lr = 0, lt = 0;
        for (size_t c = 0; c < 3; ++c) {
            const double a = r[c][i], b = t[c][i], d = std::abs(b - a);
            m.mse += d * d;
            m.rel_mse += d * d / (a * a + rel_mse_epsilon);
            m.mae += d;
            worst = std::max(worst, d);
            clipped += a > 1;
            const double da = srgb_encode(a), db = srgb_encode(b);
            display_mse += (db - da) * (db - da);
            lr += luma[c] * da;
            lt += luma[c] * db;
        }
        m.max_abs = std::max(m.max_abs, worst);
        failing += worst > tolerance;
        greatest[i] = static_cast<float>(worst);
        luma_r[i] = static_cast<float>(lr);
        luma_t[i] = static_cast<float>(lt);
    }
    const double n = static_cast<double>(pixels), values = 3 * n;
    m.mse /= values;
    m.rel_mse /= values;
    m.mae /= values;
    m.failing = static_cast<double>(failing) / n;
    m.clipped = static_cast<double>(clipped) / values;
    m.psnr = std::min(psnr_cap, -10 * std::log10(display_mse / values));  // log10(0) is -inf: capped
    m.p95_abs = percentile(std::move(greatest), 0.95);
    m.ssim = mean_ssim(luma_r, luma_t, reference.width, reference.height);
    return m;
}

std::vector<float> flip_errors(Flip kind, const Image& reference, const Image& test, double ppd, std::string_view layer) {
    require_same_size(reference, test);
    const Planes r = planes_of(reference, layer), t = planes_of(test, layer);
    const auto flip = kind == Flip::ldr ? ldr_flip : hdr_flip;
    std::vector<float> errors = flip({r[0], r[1], r[2]}, {t[0], t[1], t[2]}, reference.width, reference.height, ppd);
    for (const Planes& planes : {r, t})
        for (const auto& plane : planes)
            for (size_t i = 0; i < errors.size(); ++i)
                if (!std::isfinite(plane[i])) errors[i] = std::numeric_limits<float>::quiet_NaN();
    return errors;
}

namespace {

double mean_of(const std::vector<float>& errors) {
    double sum = 0;
    for (float error : errors) sum += error;
    return sum / static_cast<double>(errors.size());
}

}  // namespace

double mean_flip(const Image& reference, const Image& test) { return mean_of(flip_errors(Flip::ldr, reference, test)); }

void measure_flip(Metrics& metrics, const Image& reference, const Image& test, double ppd, std::string_view layer) {
    if (!metrics.finite()) return;
    const auto put = [&](Flip kind, double& mean, double& p95) {
        std::vector<float> errors = flip_errors(kind, reference, test, ppd, layer);
        mean = mean_of(errors);
        p95 = percentile(std::move(errors), 0.95);
    };
    put(Flip::ldr, metrics.flip, metrics.p95_flip);
    put(Flip::hdr, metrics.hdr_flip, metrics.p95_hdr_flip);
}

Image absolute_difference(const Image& reference, const Image& test, std::string_view layer) {
    require_same_size(reference, test);
    const Planes r = planes_of(reference, layer), t = planes_of(test, layer);
    Image difference;
    difference.width = reference.width;
    difference.height = reference.height;
    constexpr const char* channels[] = {"R", "G", "B"};
    for (size_t c = 0; c < 3; ++c) {
        std::vector<float>& d = difference.add(channels[c]);
        for (size_t i = 0; i < d.size(); ++i) d[i] = std::abs(t[c][i] - r[c][i]);
    }
    return difference;
}

std::vector<float> greatest_channel(const Image::Rgb& rgb) {
    std::vector<float> greatest(rgb.r.size());
    for (size_t i = 0; i < greatest.size(); ++i) {
        const float sum = rgb.r[i] + rgb.g[i] + rgb.b[i];  // NaN or Inf when one of them is
        greatest[i] = std::isfinite(sum) ? std::max({rgb.r[i], rgb.g[i], rgb.b[i]}) : sum;
    }
    return greatest;
}

double percentile(std::vector<float> values, double share) {
    assert(!values.empty() && share > 0 && share <= 1);
    const auto rank = static_cast<size_t>(std::ceil(share * static_cast<double>(values.size())));
    auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max<size_t>(rank, 1) - 1);
    std::ranges::nth_element(values, at);
    return *at;
}

}  // namespace myriad::tools
