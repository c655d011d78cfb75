// Sections are those of the LDR paper unless the HDR paper is named.
#include "tools/flip.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/parallel.hpp"

namespace myriad::tools {
namespace {

constexpr double pi = std::numbers::pi;
constexpr size_t block = 32;  // values that are summed side by side, so that the sums stay in registers

struct Plane {
    Plane(size_t w, size_t h) : width(w), height(h), values(w * h) {}
    size_t width, height;
    std::vector<float> values;
};

// A filter along one axis, symmetric (even) or antisymmetric: taps[k] is the weight at +k.
struct Taps {
    bool even = true;
    std::vector<float> weights;
    std::ptrdiff_t radius() const { return std::ptrdiff_t(weights.size()) - 1; }
};

// out[i] = sum over k of taps at k times in(i, k), where in(i, k) points at what lies k away from value i.
template <bool even, class In>
void sum_taps(const Taps& taps, size_t count, float* out, const In& in) {
    for (size_t at = 0; at < count; at += block) {
        float sums[block];
        const float* centre = in(at, 0);
        for (size_t i = 0; i < block; ++i) sums[i] = even ? taps.weights[0] * centre[i] : 0;
        for (std::ptrdiff_t k = 1; k <= taps.radius(); ++k) {
            const float *after = in(at, k), *before = in(at, -k), weight = taps.weights[size_t(k)];
            for (size_t i = 0; i < block; ++i) sums[i] += weight * (even ? after[i] + before[i] : after[i] - before[i]);
        }
        std::copy_n(sums, std::min(block, count - at), out + at);
    }
}

void sum_taps(const Taps& taps, size_t count, float* out, const auto& in) {
    taps.even ? sum_taps<true>(taps, count, out, in) : sum_taps<false>(taps, count, out, in);
}

// Beyond the border the image goes on as it ends.
Plane across(const Plane& plane, const Taps& taps) {
    Plane out(plane.width, plane.height);
    const size_t radius = size_t(taps.radius());
    std::vector<float> row(plane.width + 2 * radius + block);
    for (size_t y = 0; y < plane.height; ++y) {
        const float* from = &plane.values[y * plane.width];
        std::fill_n(row.begin(), radius, from[0]);
        std::copy_n(from, plane.width, row.begin() + std::ptrdiff_t(radius));
        std::fill(row.begin() + std::ptrdiff_t(radius + plane.width), row.end(), from[plane.width - 1]);
        const float* centre = row.data() + radius;
        sum_taps(taps, plane.width, &out.values[y * plane.width], [&](size_t x, std::ptrdiff_t k) { return centre + x + k; });
    }
    return out;
}

Plane down(Plane plane, const Taps& taps) {
    Plane out(plane.width, plane.height);
    plane.values.resize(plane.values.size() + block);  // the last block of the last row is read whole
    for (size_t y = 0; y < plane.height; ++y)
        sum_taps(taps, plane.width, &out.values[y * plane.width], [&](size_t x, std::ptrdiff_t k) {
            const std::ptrdiff_t line = std::clamp<std::ptrdiff_t>(std::ptrdiff_t(y) + k, 0, std::ptrdiff_t(plane.height) - 1);
            return &plane.values[size_t(line) * plane.width + x];
        });
    return out;
}

Taps make_taps(std::ptrdiff_t radius, bool even, const auto& value) {
    Taps taps{even, {}};
    for (std::ptrdiff_t k = 0; k <= radius; ++k) taps.weights.push_back(float(value(double(k))));
    return taps;
}

Taps gaussian(std::ptrdiff_t radius, double minus_exponent) {  // exp(-minus_exponent k^2), of sum 1
    double sum = 0;
    for (std::ptrdiff_t k = -radius; k <= radius; ++k) sum += std::exp(-minus_exponent * double(k * k));
    return make_taps(radius, true, [&](double k) { return std::exp(-minus_exponent * k * k) / sum; });
}

// ---- Section 4.1.1: contrast sensitivity of the eye as filters, sums of one or two Gaussians, of sum 1 in two dimensions ----

struct Sensitivity {
    double a1, b1, a2, b2;  // Table 1: a1 sqrt(pi/b1) exp(-pi^2 x^2/b1) + the same of a2, b2; x in degrees
};
constexpr Sensitivity achromatic{1, 0.0047, 0, 1e-5}, red_green{1, 0.0053, 0, 1e-5}, blue_yellow{34.1, 0.04, 13.5, 0.025};

std::ptrdiff_t sensitivity_radius(double ppd) { return std::ptrdiff_t(std::ceil(3 * std::sqrt(blue_yellow.b1 / (2 * pi * pi)) * ppd)); }

// Both are separable, their sum is not: each is filtered with by itself.
Plane see(const Plane& plane, const Sensitivity& s, double ppd) {
    const std::ptrdiff_t radius = sensitivity_radius(ppd);
    const auto weight = [&](double a, double b) {
        double sum = 0;
        for (std::ptrdiff_t k = -radius; k <= radius; ++k) sum += std::exp(-pi * pi * double(k * k) / (b * ppd * ppd));
        return a * std::sqrt(pi / b) * sum * sum;
    };
    const auto filtered = [&](double b) {
        const Taps taps = gaussian(radius, pi * pi / (b * ppd * ppd));
        return down(across(plane, taps), taps);
    };
    Plane out = filtered(s.b1);
    if (s.a2 == 0) return out;
    const Plane second = filtered(s.b2);
    const double w1 = weight(s.a1, s.b1), w2 = weight(s.a2, s.b2);
    const float share = float(w2 / (w1 + w2));
    for (size_t i = 0; i < out.values.size(); ++i) out.values[i] += share * (second.values[i] - out.values[i]);
    return out;
}

// ---- Colours ----

// Linear sRGB to XYZ over the XYZ of white (CIE D65: x = 0.31271, y = 0.32902), so that rows sum to 1; and back.
constexpr float to_xyz[3][3] = {{0.43389538843f, 0.376242372912f, 0.189862238658f},
                                {0.212636821396f, 0.715182982109f, 0.072180196495f},
                                {0.017752423125f, 0.109465628683f, 0.872781948192f}};
constexpr float from_xyz[3][3] = {{3.0803419911f, -1.5373989715f, -0.5429430196f},
                                  {-0.9211783955f, 1.875929983f, 0.0452484125f},
                                  {0.0528812928f, -0.2040112061f, 1.1511299132f}};

using Colour = std::array<float, 3>;

Colour transform(const float (&m)[3][3], const Colour& v) {
    Colour out;
    for (size_t i = 0; i < 3; ++i) out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
    return out;
}

// Section 4.1.2: CIELAB, its a* and b* scaled by 0.01 L* (Hunt: darker is less colourful).
Colour hunt_lab(const Colour& rgb) {
    constexpr float delta = 6 / 29.f;
    Colour f = transform(to_xyz, rgb);
    for (float& v : f) v = v > delta * delta * delta ? std::cbrt(v) : v / (3 * delta * delta) + 4 / 29.f;
    const float lightness = 116 * f[1] - 16, hunt = 0.01f * lightness;
    return {lightness, hunt * 500 * (f[0] - f[1]), hunt * 200 * (f[1] - f[2])};
}

// Section 4.1.3: the HyAB distance, redistributed to [0, 1].
float distance(const Colour& a, const Colour& b) {
    return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

float colour_error(const Colour& a, const Colour& b) {
    constexpr float qc = 0.7f, pc = 0.4f, pt = 0.95f;
    static const float most = std::pow(distance(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), qc);
    const float d = std::pow(distance(a, b), qc), bend = pc * most;
    return d < bend ? d * pt / bend : pt + (d - bend) / (most - bend) * (1 - pt);
}

// ---- Section 4.2: edges and points, by first and second derivatives of a Gaussian ----

double feature_sigma(double ppd) { return 0.5 * 0.082 * ppd; }  // a feature is 0.082 degrees wide
std::ptrdiff_t feature_radius(double ppd) { return std::ptrdiff_t(std::ceil(3 * feature_sigma(ppd))); }

struct Features {
    std::vector<float> edges, points;  // lengths of the two responses, across and down
};

Features features(const Plane& luminance, double ppd) {
    const double sigma = feature_sigma(ppd), exponent = 1 / (2 * sigma * sigma);
    const std::ptrdiff_t radius = feature_radius(ppd);
    const auto first = [&](double k) { return k * std::exp(-exponent * k * k); };
    const auto second = [&](double k) { return (k * k / (sigma * sigma) - 1) * std::exp(-exponent * k * k); };
    double slope = 0, positive = 0, negative = 0;  // what is positive sums to 1, what is negative to -1
    for (std::ptrdiff_t k = -radius; k <= radius; ++k) {
        const double d1 = first(double(k)), d2 = second(double(k));
        slope += std::max(d1, 0.), positive += std::max(d2, 0.), negative -= std::min(d2, 0.);
    }
    const Taps smooth = gaussian(radius, exponent), edge = make_taps(radius, false, [&](double k) { return first(k) / slope; }),
               point = make_taps(radius, true, [&](double k) { return second(k) / (second(k) > 0 ? positive : negative); });
    const auto length = [](Plane a, const Plane& b) {
        for (size_t i = 0; i < a.values.size(); ++i) a.values[i] = std::sqrt(a.values[i] * a.values[i] + b.values[i] * b.values[i]);
        return std::move(a.values);
    };
    const Plane smoothed = across(luminance, smooth);
    return {length(down(across(luminance, edge), smooth), down(smoothed, edge)),
            length(down(across(luminance, point), smooth), down(smoothed, point))};
}

// ---- Both pipelines ----

using Rgb = std::array<Plane, 3>;

struct Seen {
    std::vector<Colour> lab;
    Features features;
};

Seen look(const Rgb& rgb, double ppd) {
    const size_t width = rgb[0].width, height = rgb[0].height;
    // The opponent space YCxCz without its scales and offset, which linear filters of sum 1 let through; this Y is (Y+16)/116.
    Rgb opponent = {Plane(width, height), Plane(width, height), Plane(width, height)};
    for (size_t i = 0; i < width * height; ++i) {
        const Colour xyz = transform(to_xyz, {rgb[0].values[i], rgb[1].values[i], rgb[2].values[i]});
        opponent[0].values[i] = xyz[1], opponent[1].values[i] = xyz[0] - xyz[1], opponent[2].values[i] = xyz[1] - xyz[2];
    }
    Seen seen{{}, features(opponent[0], ppd)};
    const Plane y = see(opponent[0], achromatic, ppd), cx = see(opponent[1], red_green, ppd), cz = see(opponent[2], blue_yellow, ppd);
    seen.lab.resize(width * height);
    for (size_t i = 0; i < width * height; ++i) {
        Colour colour = transform(from_xyz, {y.values[i] + cx.values[i], y.values[i], y.values[i] - cz.values[i]});
        for (float& v : colour) v = std::clamp(v, 0.f, 1.f);
        seen.lab[i] = hunt_lab(colour);
    }
    return seen;
}

// What a display shows of some rows of an image; above the first row and below the last the image goes on as it ends.
Rgb shown(const Image::Rgb& image, size_t width, size_t height, std::ptrdiff_t begin, std::ptrdiff_t end, const auto& display) {
    const size_t rows = size_t(end - begin);
    Rgb out = {Plane(width, rows), Plane(width, rows), Plane(width, rows)};
    const std::span<const float> planes[] = {image.r, image.g, image.b};
    for (size_t c = 0; c < 3; ++c)
        for (size_t y = 0; y < rows; ++y) {
            const size_t row = size_t(std::clamp<std::ptrdiff_t>(begin + std::ptrdiff_t(y), 0, std::ptrdiff_t(height) - 1));
            for (size_t x = 0; x < width; ++x) {
                const float v = planes[c][row * width + x];
                out[c].values[y * width + x] = v > 0 ? std::min(float(display(v)), 1.f) : 0;
            }
        }
    return out;
}

// The greatest error of each pixel over the displays. In bands of rows: they fit into the cache, and cores share them out.
std::vector<float> flip(const Image::Rgb& reference, const Image::Rgb& test, size_t width, size_t height, double ppd, const auto& displays) {
    std::vector<float> errors(width * height);
    const std::ptrdiff_t margin = std::max(feature_radius(ppd), sensitivity_radius(ppd));
    engine::parallel_pieces(height, size_t(std::max<std::ptrdiff_t>(64, 4 * margin)), [&](size_t begin, size_t end) {
        const std::ptrdiff_t from = std::ptrdiff_t(begin) - margin, to = std::ptrdiff_t(end) + margin;
        const size_t skip = size_t(margin) * width;
        for (const auto& display : displays) {
            const auto see_rows = [&](const Image::Rgb& image) { return look(shown(image, width, height, from, to, display), ppd); };
            const Seen r = see_rows(reference), t = see_rows(test);
            for (size_t i = begin * width, k = skip; i < end * width; ++i, ++k) {
                const float colour = colour_error(r.lab[k], t.lab[k]);
                const float edge = std::abs(r.features.edges[k] - t.features.edges[k]), point = std::abs(r.features.points[k] - t.features.points[k]);
                const float feature = std::sqrt(std::numbers::sqrt2_v<float> / 2 * std::max(edge, point));
                // Section 4.3. A pixel of no difference in colour has none, whatever lies around it.
                if (colour > 0) errors[i] = std::clamp(std::pow(colour, 1 - feature), errors[i], 1.f);
            }
        }
    });
    return errors;
}

// ---- The HDR paper, section 3.1 ----

// 2.51 x^2 + 0.03 x over 2.43 x^2 + 0.59 x + 0.14 at x = 0.6 v.
float aces(float v) {
    const float x = std::min(0.6f * v, 1e4f);  // where it is above 1, and its square a number
    return x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f);
}

double before_aces(double y) {
    const double a = 2.51 - 2.43 * y, b = 0.03 - 0.59 * y, c = -0.14 * y;
    return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a) / 0.6;
}

}  // namespace

std::vector<float> ldr_flip(const Image::Rgb& reference, const Image::Rgb& test, uint32_t width, uint32_t height, double ppd) {
    const auto same = [](float v) { return v; };
    return flip(reference, test, width, height, ppd, std::array{same});
}

FlipExposures flip_exposures(const Image::Rgb& reference) {
    std::vector<float> luminances;
    for (size_t i = 0; i < reference.r.size(); ++i) {
        const float luminance = transform(to_xyz, {reference.r[i], reference.g[i], reference.b[i]})[1];
        luminances.push_back(std::isfinite(luminance) && luminance > 0 ? luminance : 0);
    }
    const float greatest = luminances.empty() ? 0 : *std::ranges::max_element(luminances);
    if (greatest == 0) return {};
    const auto median_of = [&] {
        const auto middle = luminances.begin() + std::ptrdiff_t(luminances.size() / 2);
        std::ranges::nth_element(luminances, middle);
        return *middle;
    };
    float median = median_of();
    if (median == 0) std::erase(luminances, 0.f), median = median_of();
    const double bright = before_aces(0.85);
    FlipExposures exposures{std::log2(bright / greatest), std::log2(bright / median), 1};
    if (exposures.last > exposures.first) exposures.count = std::max(2u, uint32_t(std::ceil(exposures.last - exposures.first)));
    return exposures;
}

std::vector<float> hdr_flip(const Image::Rgb& reference, const Image::Rgb& test, uint32_t width, uint32_t height, double ppd) {
    struct Display {
        double scale;
        float operator()(float v) const { return aces(float(std::min(v * scale, 1e30))); }
    };
    const FlipExposures exposures = flip_exposures(reference);
    std::vector<Display> displays;
    for (uint32_t i = 0; i < exposures.count; ++i) {
        const double share = exposures.count > 1 ? i / double(exposures.count - 1) : 0;
        displays.push_back({std::exp2(std::lerp(exposures.first, exposures.last, share))});
    }
    return flip(reference, test, width, height, ppd, displays);
}

}  // namespace myriad::tools
