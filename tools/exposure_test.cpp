#include "tools/exposure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "passes/tonemap/tonemap_io.h"

namespace myriad::tools {
namespace {

double exposure_of(const std::vector<float>& grey) { return auto_exposure({grey, grey, grey}); }

TEST(exposure, brings_the_geometric_mean_to_middle_grey) {
    for (float scale : {1e-6f, 1.f, 1e6f}) {
        const double exposure = exposure_of({scale * 0.25f, scale * 1.f, scale * 4.f});  // geometric mean: scale
        EXPECT_NEAR(filmic(float(exposure * scale)), 0.18, 1e-5) << scale;
    }
}

TEST(exposure, ignores_what_is_black_or_broken) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    EXPECT_DOUBLE_EQ(exposure_of({2, 0, -1, nan, inf}), exposure_of({2}));
    EXPECT_EQ(exposure_of({0, 0}), 1);
    EXPECT_EQ(exposure_of({}), 1);
}

TEST(exposure, stays_a_float) {
    EXPECT_TRUE(std::isfinite(float(exposure_of({1e-45f}))));
    EXPECT_GT(float(exposure_of({3e38f})), 0);
}

TEST(exposure, weighs_colours_by_luminance) {
    const std::vector<float> one{1}, none{0};
    EXPECT_GT(auto_exposure({none, none, one}), auto_exposure({one, none, none}));
    EXPECT_GT(auto_exposure({one, none, none}), auto_exposure({none, one, none}));
}

}  // namespace
}  // namespace myriad::tools
