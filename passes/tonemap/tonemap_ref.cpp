#include "passes/tonemap/tonemap_ref.hpp"

#include <algorithm>

namespace myriad::passes {

double tonemap_ref(double radiance, double exposure) {
    double x = radiance * exposure;
    if (!(x > 0)) return 0;
    x = std::min(x, 1e6);
    const double y = std::min((2.51 * x * x + 0.03 * x) / (2.43 * x * x + 0.59 * x + 0.14), 1.0);
    return 255 * (y <= 0.0031308 ? 12.92 * y : 1.055 * std::pow(y, 1 / 2.4) - 0.055);  // IEC 61966-2-1
}

}  // namespace myriad::passes
