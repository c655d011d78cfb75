#include "passes/tonemap/tonemap.hpp"

#include <algorithm>
#include <limits>

#include "engine/testing.hpp"
#include "passes/tonemap/tonemap_ref.hpp"

namespace myriad::passes {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

class TonemapTest : public engine::DeviceTest {
protected:
    std::vector<uint> run(const std::vector<vec4>& radiance, float exposure) {
        const auto on = on_device(radiance);
        TonemapPass tonemap(device, radiance.size());
        engine::Recorder recorder(device);
        tonemap.record(recorder, on, exposure);
        recorder.submit_and_wait();
        return engine::download(device, tonemap.pixels());
    }
    // Grey levels in one channel, the others black.
    std::vector<int> bytes(const std::vector<float>& levels, float exposure, int channel = 0) {
        std::vector<vec4> radiance(levels.size(), vec4(0));
        for (size_t i = 0; i < levels.size(); ++i) radiance[i][channel] = levels[i];
        std::vector<int> out;
        for (uint word : run(radiance, exposure)) {
            EXPECT_EQ(word & ~(255u << 8 * channel), 0xff000000u) << "other channels stay black, and all is opaque";
            out.push_back(int(word >> 8 * channel & 255));
        }
        return out;
    }
    // Either neighbour is right where rounding is a tie to within what the device's pow errs.
    static size_t differing(const std::vector<vec4>& radiance, float exposure, const std::vector<uint>& got) {
        size_t wrong = 0;
        for (size_t i = 0; i < radiance.size(); ++i)
            for (int c = 0; c < 3; ++c) wrong += !(std::abs(double(got[i] >> 8 * c & 255) - tonemap_ref(radiance[i][c], exposure)) <= 0.502);
        return wrong;
    }
    std::vector<vec4> random_radiance(size_t n) {
        std::uniform_real_distribution<float> exponent(-8, 4);
        std::vector<vec4> radiance(n);
        for (vec4& r : radiance) r = {std::pow(10.0f, exponent(random)), std::pow(10.0f, exponent(random)), std::pow(10.0f, exponent(random)), 1};
        return radiance;
    }
};

TEST_F(TonemapTest, twin_knows_values_by_hand) {
    EXPECT_EQ(tonemap_ref(0, 1), 0);
    EXPECT_NEAR(tonemap_ref(1, 1), 255 * (1.055 * std::pow(2.54 / 3.16, 1 / 2.4) - 0.055), 1e-9);
    EXPECT_NEAR(tonemap_ref(1e30, 1), 255, 1e-9);
    EXPECT_EQ(tonemap_ref(nan, 1), 0);
}

TEST_F(TonemapTest, equals_the_twin) {
    for (size_t n : {1, 63, 64, 65, 20000})
        for (float exposure : {0.01f, 1.0f, 30.0f}) {
            const auto radiance = random_radiance(n);
            EXPECT_EQ(differing(radiance, exposure, run(radiance, exposure)), 0u) << n << " at " << exposure;
        }
}

TEST_F(TonemapTest, endpoints) {
    EXPECT_EQ(bytes({0, -0.0f, 7.25f, 8, 1e4f, 1e19f, 1e20f, 3e38f, infinity}, 1), (std::vector<int>{0, 0, 255, 255, 255, 255, 255, 255, 255}));
    EXPECT_EQ(bytes({1, 3e38f}, 3e38f), (std::vector<int>{255, 255}));
}

TEST_F(TonemapTest, what_is_no_radiance_is_black) {
    EXPECT_EQ(bytes({nan, -nan, -1e-30f, -0.02f, -1, -10, -1e20f, -infinity}, 1), std::vector<int>(8, 0));
    EXPECT_EQ(bytes({0}, infinity), std::vector<int>{0});
}

TEST_F(TonemapTest, brighter_is_never_darker) {
    std::vector<float> levels;
    for (float x = 1e-6f; x < 1e6f; x *= 1.0005f) levels.push_back(x);
    for (int channel : {0, 1, 2}) {
        const auto got = bytes(levels, 1, channel);
        EXPECT_TRUE(std::is_sorted(got.begin(), got.end()));
        for (int level = 0; level < 256; ++level) EXPECT_TRUE(std::binary_search(got.begin(), got.end(), level)) << level << " is never used";
    }
}

TEST_F(TonemapTest, comparator_sees_the_next_byte) {
    const auto radiance = random_radiance(64);
    auto got = run(radiance, 1);
    ASSERT_EQ(differing(radiance, 1, got), 0u);
    got[5] ^= 2;
    EXPECT_EQ(differing(radiance, 1, got), 1u);
}

}  // namespace
}  // namespace myriad::passes
