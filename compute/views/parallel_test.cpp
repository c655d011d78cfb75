// The formulae of parallel.h against geometry in doubles, on the host: the kernels compile the same text.
#include "compute/views/parallel.h"

#include <random>

#include <gtest/gtest.h>

namespace myriad {
namespace {

using glm::dvec2, glm::dvec3;

constexpr double ulp = 1.0 / (1 << 23);

class Parallel : public ::testing::Test {
protected:
    double uniform(double lo = -1, double hi = 1) { return std::uniform_real_distribution<double>(lo, hi)(random); }
    // Any, and those that look along an axis or nearly.
    vec3 direction() {
        dvec3 d(uniform(), uniform(), uniform());
        if (random() % 4 == 0) d = dvec3(random() % 3 == 0, random() % 3 == 1, random() % 3 == 2) * (random() % 2 ? 1.0 : -1.0) + 1e-4 * uniform() * d;
        return glm::dot(d, d) > 1e-3 ? vec3(glm::normalize(d)) : vec3(0, -1, 0);
    }
    View view(uint columns, float half) { return {vec3(uniform(), uniform(), uniform()), -1 - float(columns), direction(), half}; }

    std::mt19937 random{7};
};

TEST_F(Parallel, frames_are_orthonormal_and_upright) {
    for (int i = 0; i < 20000; ++i) {
        const vec3 n = direction();
        const ParallelFrame f = parallel_frame(n);
        const dvec3 a(f.across), d(f.down);
        ASSERT_NEAR(glm::length(a), 1, 4 * ulp);
        ASSERT_NEAR(glm::length(d), 1, 8 * ulp);
        ASSERT_LT(std::abs(glm::dot(a, d)) + std::abs(glm::dot(a, dvec3(n))) + std::abs(glm::dot(d, dvec3(n))), 8 * ulp);
        if (std::abs(n.y) < 0.999f) { ASSERT_TRUE(f.across.y == 0 && f.down.y <= 0) << "the horizon is level, and up is up"; }
    }
}

TEST_F(Parallel, a_view_keeps_its_columns_and_its_texels) {
    for (uint size : {2u, 32u, 1024u})
        for (uint columns : {1u, 2u, 45u, 1000u, 2 * size * size}) {
            if (columns > 2 * size * size) continue;
            const View v = view(columns, 3);
            EXPECT_TRUE(is_parallel(v));
            EXPECT_EQ(parallel_columns(v), columns);
            EXPECT_EQ(parallel_rows(v, size), 2 * size * size / columns);
            EXPECT_LE(parallel_columns(v) * parallel_rows(v, size), map_texels(size));
            EXPECT_FLOAT_EQ(parallel_texel(v, size) * float(size) / 2, 3);
        }
    EXPECT_FALSE(is_parallel(view_of_nothing()));
    EXPECT_FALSE(is_parallel({vec3(0), -1, vec3(1, 0, 0), 0})) << "one that sees all around";
}

// A line of sight through a texel's middle meets a sphere if and only if the middle lies in its disc.
TEST_F(Parallel, footprints_are_exact) {
    const uint size = 32;
    size_t met = 0, passed = 0;
    for (int i = 0; i < 3000; ++i) {
        const View v = view(50, float(uniform(0.5, 2)));
        const double texel = double(v.sin_phi) * 2 / size, r = texel * std::exp(uniform(-3, 3));
        const dvec3 n(v.direction), across(parallel_frame(v.direction).across), down(parallel_frame(v.direction).down);
        const dvec3 d = across * (uniform(0, 50) * texel) + down * (uniform(0, 40) * texel) + n * uniform(0, 5);
        const vec2 middle = parallel_place(v, parallel_frame(v.direction), vec3(d), size);
        const float radius = float(r) / parallel_texel(v, size);
        const uint x0 = parallel_first(middle.x, radius, 50), x1 = parallel_end(middle.x, radius, 50);
        const uint y0 = parallel_first(middle.y, radius, 40), y1 = parallel_end(middle.y, radius, 40);
        for (uint y = 0; y < 40; ++y)
            for (uint x = 0; x < 50; ++x) {
                const dvec3 line = across * ((x + 0.5) * texel) + down * ((y + 0.5) * texel) - d;
                const double off = glm::length(line - n * glm::dot(line, n)) / texel, disc = glm::length(dvec2(x + 0.5, y + 0.5) - dvec2(middle));
                ASSERT_NEAR(off, disc, 1e-3);
                const bool in_rectangle = x >= x0 && x < x1 && y >= y0 && y < y1;
                if (off < r / texel - 1e-3) { ASSERT_TRUE(in_rectangle) << "the disc's rectangle lacks a texel that is met"; }
                met += off < r / texel, passed += in_rectangle;
            }
        ASSERT_TRUE(x1 <= 50 && y1 <= 40);
        if (radius < 0.3f) { ASSERT_LE((x1 - std::min(x0, x1)) * (y1 - std::min(y0, y1)), 1u); }
    }
    EXPECT_TRUE(met > 0.6 * double(passed) && met > 10000) << met << " of " << passed;
}

TEST_F(Parallel, fits_is_the_diameter_and_nested) {
    for (int i = 0; i < 100000; ++i) {
        const View v = view(45, float(std::exp(uniform(-14, 14))));
        const uint size = 2u << random() % 10;
        const float epsilon = float(std::exp(uniform(-3, 3))), outer = float(double(epsilon) * v.sin_phi / size * (1 + (random() % 2 ? 1e-6 : 1.0) * uniform()));
        const float inner = outer * float(uniform(0.999, 1));
        if (parallel_fits(v, outer, size, epsilon)) { ASSERT_TRUE(parallel_fits(v, inner, size, epsilon)); }
        const double diameter = 2 * double(outer) / parallel_texel(v, size);
        if (std::abs(diameter / epsilon - 1) > 1e-6) { ASSERT_EQ(parallel_fits(v, outer, size, epsilon), diameter < epsilon); }
    }
}

}  // namespace
}  // namespace myriad
