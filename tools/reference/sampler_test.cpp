#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "tools/reference/sampler.hpp"

namespace myriad::reference {
namespace {

// Of the second pair of some pixel: each box of area 1/64, of any shape that halving gives, holds one of 64 samples. And of the next 64.
TEST(ReferenceSampler, pairs_are_nets) {
    for (const uint32_t first : {0u, 64u, 640u})
        for (int across = 0; across <= 6; ++across) {
            std::set<int> boxes;
            for (uint32_t i = first; i < first + 64; ++i) {
                Sampler sampler(3, 1234, i);
                sampler.pair();
                const glm::vec2 x = sampler.pair();
                boxes.insert(int(x.x * float(1 << across)) * 64 + int(x.y * float(64 >> across)));
            }
            EXPECT_EQ(boxes.size(), 64u) << across;
        }
}

TEST(ReferenceSampler, pairs_do_not_know_each_other) {
    double sum = 0, product = 0;
    constexpr uint32_t count = 1 << 14;
    for (uint32_t i = 0; i < count; ++i) {
        Sampler sampler(1, 77, i);
        const double a = double(sampler.one()), b = double(sampler.pair().y);
        sampler.dice();
        const double c = double(sampler.pair().x);
        sum += a + b + c, product += (a - 0.5) * (b - 0.5) + (b - 0.5) * (c - 0.5) + (a - 0.5) * (c - 0.5);
    }
    EXPECT_NEAR(sum / count, 1.5, 1e-3);
    EXPECT_NEAR(product / count, 0, 3 * std::sqrt(3.0) / 12 / 128);
}

TEST(ReferenceSampler, pixels_seeds_and_samples_differ) {
    std::set<std::pair<float, float>> seen;
    for (uint32_t seed = 0; seed < 8; ++seed)
        for (uint32_t pixel = 0; pixel < 8; ++pixel)
            for (uint32_t i = 0; i < 8; ++i) {
                const glm::vec2 x = Sampler(seed, pixel, i).pair();
                seen.insert({x.x, x.y});
            }
    EXPECT_EQ(seen.size(), 512u);
}

}  // namespace
}  // namespace myriad::reference
