#include "tools/exposure.hpp"

#include <algorithm>
#include <cmath>

namespace myriad::tools {
namespace {

// Where the curve x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14) of passes/tonemap is y: the positive root of its quadratic.
double before_curve(double y) {
    const double a = 2.51 - 2.43 * y, b = 0.03 - 0.59 * y, c = -0.14 * y;
    return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

}  // namespace

double auto_exposure(const Image::Rgb& radiance) {
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < radiance.r.size(); ++i) {
        const double luminance = 0.2126 * radiance.r[i] + 0.7152 * radiance.g[i] + 0.0722 * radiance.b[i];
        if (!(luminance > 0) || !std::isfinite(luminance)) continue;
        sum += std::log(luminance);
        ++count;
    }
    if (!count) return 1;
    return std::clamp(before_curve(0.18) / std::exp(sum / double(count)), 1e-30, 1e30);
}

}  // namespace myriad::tools
