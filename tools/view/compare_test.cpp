#include "tools/view/compare.hpp"

#include <gtest/gtest.h>

#include "tools/metrics.hpp"

namespace myriad::tools::view {
namespace {

Image image(std::vector<float> r, std::vector<float> g, std::vector<float> b) {
    Image out;
    out.width = uint32_t(r.size()), out.height = 1;
    out.add("R") = std::move(r), out.add("G") = std::move(g), out.add("B") = std::move(b);
    return out;
}

TEST(view_compare, errors_are_the_roots_of_relMSE_terms) {
    const Image reference = image({0, 1, 2}, {0, 1, 2}, {0, 1, 2}), test = image({0.1f, 1, 2}, {0, 1.5f, 2}, {0, 0.9f, 2});
    const std::vector<float> errors = relative_errors(reference, test);
    EXPECT_FLOAT_EQ(errors[0], 0.1f / 0.1f);
    EXPECT_FLOAT_EQ(errors[1], 0.5f / std::sqrt(1.01f)) << "the worst of the channels";
    EXPECT_EQ(errors[2], 0);
    // Of grey images the mean of their squares is relMSE itself.
    const Image grey = image({0.1f, 0.2f, 3}, {0.1f, 0.2f, 3}, {0.1f, 0.2f, 3}), other = image({0.3f, 0.1f, 2}, {0.3f, 0.1f, 2}, {0.3f, 0.1f, 2});
    double sum = 0;
    for (const float e : relative_errors(grey, other)) sum += double(e) * double(e);
    EXPECT_NEAR(sum / 3, measure(grey, other, 0).rel_mse, 1e-6);
}

}  // namespace
}  // namespace myriad::tools::view
