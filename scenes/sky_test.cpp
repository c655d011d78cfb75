// The default sky against what a hemisphere of constant radiance does, and when it comes.
#include "scenes/sky.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace myriad::scenes {
namespace {

using glm::dvec3;

// Irradiance that the lights give a plane with this normal.
double irradiance(const std::vector<Light>& lights, const dvec3& normal) {
    double sum = 0;
    for (const Light& light : lights) sum += std::max(0.0, glm::dot(normal, -dvec3(light.direction))) * double(light.intensity.g);
    return sum;
}

TEST(Sky, HasTheIrradianceOfAHemisphere) {
    const double pi = std::acos(-1.0);
    for (uint32_t count : {16u, default_sky_lights, 256u}) {
        const std::vector<Light> lights = sky_lights(3, count);
        ASSERT_EQ(lights.size(), count);
        double worst = 0;
        for (const Light& light : lights) {
            EXPECT_EQ(light.type, Light::Type::directional);
            EXPECT_LT(light.direction.y, 0) << "from below";
            EXPECT_NEAR(glm::length(dvec3(light.direction)), 1, 1e-6);
        }
        EXPECT_NEAR(irradiance(lights, {0, 1, 0}), 3 * pi, 3e-5) << count;  // level ground: exactly
        // A plane that is tilted by an angle sees this much of the hemisphere: pi L (1 + cos angle) / 2.
        for (int tilt = 0; tilt <= 180; tilt += 15)
            for (int turn = 0; turn < 360; turn += 10) {
                const double t = tilt * pi / 180, a = turn * pi / 180;
                const double exact = 3 * pi * (1 + std::cos(t)) / 2;
                worst = std::max(worst, std::abs(irradiance(lights, {std::sin(t) * std::cos(a), std::cos(t), std::sin(t) * std::sin(a)}) - exact));
            }
        EXPECT_LT(worst / (3 * pi), 2.0 / count) << count;
    }
}

TEST(Sky, DirectionsKeepTheirDistance) {
    // Each has a solid angle of 2 pi / count to itself: a cap of that size has a radius of acos(1 - 1 / count).
    const std::vector<Light> lights = sky_lights(1, default_sky_lights);
    const double radius = std::acos(1 - 1.0 / default_sky_lights);
    for (size_t i = 0; i < lights.size(); ++i)
        for (size_t k = 0; k < i; ++k)
            EXPECT_GT(std::acos(glm::dot(dvec3(lights[i].direction), dvec3(lights[k].direction))), radius) << i << " " << k;
}

Scene triangle() {
    Scene scene;
    scene.materials.resize(1);
    scene.meshes.push_back({"triangle", {{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .indices = {0, 1, 2}}}});
    scene.instances.push_back({});
    return scene;
}

TEST(Sky, ComesWhereNothingShines) {
    Scene scene = triangle();
    EXPECT_TRUE(needs_sky(scene));
    scene.lights.push_back({.intensity = {0, 0, 0}});
    EXPECT_TRUE(needs_sky(scene)) << "a light that is off";
    scene.lights[0].intensity = {0, 0, 1};
    EXPECT_FALSE(needs_sky(scene));
    scene = triangle();
    scene.materials[0].emissive = {0.01f, 0, 0};
    EXPECT_FALSE(needs_sky(scene));
    scene.materials[0].emissive_texture.texture = 0;
    EXPECT_TRUE(needs_sky(scene)) << "a texture that glows";
    scene.materials[0].emissive = {2, 0, 0};
    EXPECT_FALSE(needs_sky(scene)) << "a texture that is meant to shine";
    scene = triangle();
    scene.materials[0].emissive = glm::vec3(1);
    scene.instances.clear();
    EXPECT_FALSE(needs_sky(scene)) << "nothing there to be lit";
    scene = triangle();
    scene.materials.push_back({.emissive = glm::vec3(1)});
    EXPECT_TRUE(needs_sky(scene)) << "nobody wears what shines";
    scene.materials[0].unlit = true;
    EXPECT_FALSE(needs_sky(scene)) << "light would change nothing";
}

TEST(Sky, IsSaidAndCanBeRefused) {
    Scene scene = triangle();
    apply_sky(scene, SkyChoice::off);
    EXPECT_TRUE(scene.lights.empty() && scene.warnings.empty());
    EXPECT_EQ(scene.background, glm::vec3(0));
    apply_sky(scene, SkyChoice::automatic);
    EXPECT_EQ(scene.lights.size(), default_sky_lights);
    EXPECT_EQ(scene.background, glm::vec3(default_sky_radiance));
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_NE(scene.warnings[0].find("no light"), std::string::npos);
    apply_sky(scene, SkyChoice::automatic);  // it has light now
    EXPECT_EQ(scene.lights.size(), default_sky_lights);
    apply_sky(scene, SkyChoice::on);
    EXPECT_EQ(scene.lights.size(), 2 * default_sky_lights);
    EXPECT_EQ(scene.warnings.size(), 1u);
}

}  // namespace
}  // namespace myriad::scenes
