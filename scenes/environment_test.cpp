// Environments: where directions lie, what the cells hold, and that their lights do on average what the whole picture does.
#include "scenes/environment.hpp"

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "engine/error.hpp"
#include "scenes/scene.hpp"

namespace myriad::scenes {
namespace {

using glm::dvec3;
constexpr double pi = std::numbers::pi;

Environment picture(uint32_t height, const std::function<glm::vec3(uint32_t x, uint32_t y)>& radiance) {
    Environment e;
    e.name = "test.exr", e.width = 2 * height, e.height = height;
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < e.width; ++x) e.texels.push_back(radiance(x, y));
    return e;
}

// A sky over darker ground, noise, and a few lamps a thousand times as bright.
Environment daylight(uint32_t seed, bool coloured) {
    std::mt19937 random(seed);
    std::lognormal_distribution<float> noise(0, 1);
    return picture(24, [&](uint32_t, uint32_t y) {
        const float v = noise(random) * (y < 12 ? 1.0f : 0.2f) * (random() % 200 == 0 ? 1000.0f : 1.0f);
        return coloured ? v * glm::vec3(noise(random), noise(random), noise(random)) : glm::vec3(v);
    });
}

double luminance(const dvec3& c) { return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b; }

// Irradiance of the whole picture: texels cut into parts, so that cosines are integrated, too.
dvec3 exact(const Environment& e, const dvec3& normal) {
    constexpr int parts = 8;
    dvec3 sum(0);
    for (uint32_t y = 0; y < e.height; ++y)
        for (uint32_t x = 0; x < e.width; ++x)
            for (int i = 0; i < parts * parts; ++i)
                sum += std::max(0.0, glm::dot(normal, e.direction(x + (i % parts + 0.5) / parts, y + (i / parts + 0.5) / parts))) * e.solid_angle(y) / (parts * parts) *
                       dvec3(e.texels[y * e.width + x]);
    return sum;
}

dvec3 sampled(const std::vector<EnvironmentCell>& cells, const dvec3& normal) {
    dvec3 sum(0);
    for (const EnvironmentCell& cell : cells) sum += std::max(0.0, glm::dot(normal, cell.towards)) * cell.irradiance;
    return sum;
}

TEST(Environment, LiesAroundTheSceneAsInViewersOfGltf) {
    Environment e = picture(8, [](uint32_t, uint32_t) { return glm::vec3(1); });
    const auto near = [](const dvec3& a, const dvec3& b) { return glm::length(a - b) < 1e-12; };
    EXPECT_TRUE(near(e.direction(8, 4), {1, 0, 0}));
    EXPECT_TRUE(near(e.direction(12, 4), {0, 0, 1})) << "right of the middle";
    EXPECT_TRUE(near(e.direction(3, 0), {0, 1, 0}));
    EXPECT_TRUE(near(e.direction(3, 8), {0, -1, 0}));
    e.rotation = pi / 2;
    EXPECT_TRUE(near(e.direction(8, 4), {0, 0, -1})) << "anticlockwise, seen from above";
    double sum = 0;
    for (uint32_t y = 0; y < 8; ++y) sum += 16 * e.solid_angle(y);
    EXPECT_NEAR(sum, 4 * pi, 1e-12);
}

TEST(Environment, CellsShareLuminanceEvenlyAndHoldAllThatThePictureHolds) {
    const Environment e = daylight(3, true);
    dvec3 whole(0);
    for (uint32_t y = 0; y < e.height; ++y)
        for (uint32_t x = 0; x < e.width; ++x) whole += e.solid_angle(y) * dvec3(e.texels[y * e.width + x]);
    for (uint32_t count : {1u, 2u, 7u, 256u, 1000u, 5000u}) {
        SCOPED_TRACE(count);
        const auto cells = environment_cells(e, count, 1);
        ASSERT_EQ(cells.size(), count);
        dvec3 sum(0);
        double solid_angle = 0;
        for (const EnvironmentCell& c : cells) {
            sum += c.irradiance, solid_angle += c.solid_angle;
            ASSERT_NEAR(luminance(c.irradiance) * count / luminance(whole), 1, 1e-4);
            ASSERT_NEAR(glm::length(c.towards), 1, 1e-12);
            // Where the direction lies in the picture.
            const double column = (std::atan2(c.towards.z, c.towards.x) / (2 * pi) + 0.5) * e.width, row = std::acos(c.towards.y) / pi * e.height;
            ASSERT_TRUE(column >= c.column0 - 1e-6 && column <= c.column1 + 1e-6) << column << " in " << c.column0 << " " << c.column1;
            ASSERT_TRUE(row >= std::floor(c.row0) - 1e-6 && row <= std::ceil(c.row1) + 1e-6) << row << " in " << c.row0 << " " << c.row1;
        }
        for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(sum[channel] / whole[channel], 1, 1e-9);
        EXPECT_NEAR(solid_angle, 4 * pi, 1e-9);
    }
}

// A diffuse receiver that nothing hides, in every direction: no bias over seeds, and far less noise than independent samples have.
TEST(Environment, LightsAreUnbiasedOverSeedsAndStratified) {
    const Environment e = daylight(5, false);
    constexpr int seeds = 400;
    double noise = 0, independent = 0;
    for (const dvec3& normal : {dvec3(0, 1, 0), dvec3(0, -1, 0), dvec3(1, 0, 0), glm::normalize(dvec3(-1, 2, 3)), glm::normalize(dvec3(2, -1, -2))}) {
        const double truth = exact(e, normal).g;
        double sum = 0, squares = 0, one = 0, one_squares = 0;
        for (int seed = 0; seed < seeds; ++seed) {
            const double v = sampled(environment_cells(e, 64, uint32_t(seed)), normal).g, w = sampled(environment_cells(e, 1, uint32_t(seed)), normal).g;
            sum += v, squares += v * v, one += w, one_squares += w * w;
        }
        const double mean = sum / seeds, deviation = std::sqrt(std::max(squares / seeds - mean * mean, 0.0));
        EXPECT_LT(std::abs(mean - truth), 4 * deviation / std::sqrt(seeds) + 1e-6 * truth) << mean << " " << truth;
        noise += deviation, independent += std::sqrt((one_squares / seeds - one / seeds * one / seeds) / 64);
    }
    EXPECT_LT(noise, 0.35 * independent);
}

// A cell's light has the mean colour of the cell: exact in sum, and off by what colours vary along with cosines within cells.
TEST(Environment, ColoursAreMeansOfCells) {
    const Environment e = daylight(7, true);
    for (const auto& [count, most] : {std::pair{64u, 0.05}, {1024u, 0.015}}) {
        const dvec3 normal = glm::normalize(dvec3(1, 2, -1)), truth = exact(e, normal);
        dvec3 mean(0);
        for (uint32_t seed = 0; seed < 100; ++seed) mean += sampled(environment_cells(e, count, seed), normal) / 100.0;
        for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(mean[channel] / truth[channel], 1, most) << count;
    }
}

TEST(Environment, ASunHasAllTheLightsThatItsFluxAsksFor) {
    const Environment e = picture(16, [](uint32_t x, uint32_t y) { return glm::vec3(x == 20 && y == 5 ? 1e6f : 1e-3f); });
    size_t in_sun = 0;
    for (const EnvironmentCell& c : environment_cells(e, 256, 9)) in_sun += glm::dot(c.towards, e.direction(20.5, 5.5)) > std::cos(0.2);
    EXPECT_GE(in_sun, 255u);
    const Environment black_but_one = picture(16, [](uint32_t x, uint32_t y) { return glm::vec3(x == 31 && y == 15 ? 1.0f : 0.0f); });
    for (const EnvironmentCell& c : environment_cells(black_but_one, 33, 2)) EXPECT_LT(c.towards.y, std::cos(pi * 15 / 16) + 1e-9);
}

TEST(Environment, ABlackOneIsRefused) {
    EXPECT_THROW(environment_cells(picture(4, [](uint32_t, uint32_t) { return glm::vec3(0); }), 8, 1), InputError);
}

TEST(Environment, ItsLightsComeLastAndDependOnTheSeedAlone) {
    Scene a, b, c;
    for (Scene* scene : {&a, &b, &c}) scene->lights.resize(2);
    apply_environment(a, daylight(1, true), 32, 4), apply_environment(b, daylight(1, true), 32, 4), apply_environment(c, daylight(1, true), 32, 5);
    ASSERT_EQ(a.lights.size(), 34u);
    ASSERT_EQ(a.environment->solid_angles.size(), 32u);
    size_t differ = 0;
    for (size_t i = 2; i < 34; ++i) {
        EXPECT_EQ(a.lights[i].type, Light::Type::directional);
        EXPECT_TRUE(a.lights[i].direction == b.lights[i].direction && a.lights[i].intensity == b.lights[i].intensity);
        EXPECT_EQ(a.lights[i].intensity, c.lights[i].intensity);
        differ += a.lights[i].direction != c.lights[i].direction;
    }
    EXPECT_GT(differ, 30u);
}

}  // namespace
}  // namespace myriad::scenes
