#include "passes/geometry/geometry.hpp"

#include <numbers>

#include "engine/testing.hpp"
#include "passes/geometry/geometry_ref.hpp"
#include "passes/geometry/test_scene.hpp"

namespace myriad::passes {
namespace {

using glm::dvec3;
using Wrap = scenes::Texture::Wrap;
constexpr double pi_d = std::numbers::pi;

TEST(Geometry, twin_filters_by_hand) {
    scenes::Texture t;
    t.width = 2, t.height = 1;
    t.rgba = {0, 0, 0, 255, 255, 255, 255, 255};
    EXPECT_EQ(texture_ref(t, {0.25, 0.5}, true).x, 0);      // the centres of the texels
    EXPECT_EQ(texture_ref(t, {0.75, 0.5}, true).x, 1);
    EXPECT_EQ(texture_ref(t, {0.5, 0.5}, true).x, 0.5);     // half-way, in linear light
    EXPECT_EQ(texture_ref(t, {0, 0.5}, true).x, 0.5);       // repeats
    EXPECT_EQ(texture_ref(t, {-0.25, 7.5}, true).x, 1);
    t.wrap_u = Wrap::clamp;
    EXPECT_EQ(texture_ref(t, {-3, 0.5}, true).x, 0);
    EXPECT_EQ(texture_ref(t, {3, 0.5}, true).x, 1);
    t.wrap_u = Wrap::mirror;
    EXPECT_EQ(texture_ref(t, {-0.25, 0.5}, true).x, 0);
    EXPECT_EQ(texture_ref(t, {1.25, 0.5}, true).x, 1);
    EXPECT_EQ(texture_ref(t, {1.75, 0.5}, true).x, 0);
    t.rgba = {188, 188, 188, 255, 188, 188, 188, 255};
    EXPECT_NEAR(texture_ref(t, {0.3, 0.5}, true).x, 0.502886, 1e-6);  // sRGB's middle grey
    EXPECT_NEAR(texture_ref(t, {0.3, 0.5}, false).x, 188 / 255.0, 1e-12);
}

// The shared formulae of filtering against the twin's, along one axis.
TEST(Geometry, texel_pairs_equal_the_twin) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> anywhere(-4, 4);
    for (const Wrap wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror})
        for (const uint32_t size : {1u, 2u, 3u, 64u, 1000u}) {
            scenes::Texture t;
            t.width = size, t.height = 1, t.wrap_u = wrap;
            for (uint32_t i = 0; i < 4 * size; ++i) t.rgba.push_back(uint8_t(random()));
            for (int i = 0; i < 2000; ++i) {
                const float x = i < 9 ? float(i - 4) : i < 18 ? (i - 13 + 0.5f) / float(size) : anywhere(random);
                const TexelPair pair = texel_pair(x, size, uint(wrap));
                ASSERT_LT(std::max(pair.low, pair.high), size);
                const double filtered = (1 - double(pair.weight)) * t.rgba[4 * pair.low] + double(pair.weight) * t.rgba[4 * pair.high];
                ASSERT_NEAR(filtered / 255, texture_ref(t, {double(x), 0.5}, false).x, 1e-6 * size + 1e-6) << uint(wrap) << " " << size << " " << x;
            }
            for (const float absurd : {1e9f, -1e30f, std::numeric_limits<float>::infinity(), std::nanf(""), 16777215.0f, -1e-30f, 1e-40f}) {
                const TexelPair pair = texel_pair(absurd, size, uint(wrap));
                EXPECT_LT(std::max(pair.low, pair.high), size) << absurd;
                EXPECT_TRUE(pair.weight >= 0 && pair.weight <= 1) << absurd;
            }
        }
}

TEST(Geometry, textures_are_packed_once_and_only_when_used) {
    std::mt19937 random(5);
    TestScene test;
    test.material(vec3(1));
    test.texture(3, 2, random);
    test.texture(5, 1, random);
    EXPECT_TRUE(geometry_data(test.scene, test.triangles).texels.empty());
    test.scene.materials[test.material(vec3(1))].base_color_texture = {1};
    test.scene.materials[test.material(vec3(1))].metallic_roughness_texture = {1};
    test.scene.materials[test.material(vec3(1))].emissive_texture = {0};  // black emission: not needed
    const GeometryData data = geometry_data(test.scene, test.triangles);
    EXPECT_EQ(data.texels.size(), srgb_table_size + 5);
    EXPECT_EQ(data.materials[0].base_color_texture, no_texture);
    EXPECT_EQ(data.textures[data.materials[1].base_color_texture].first, data.textures[data.materials[2].metallic_texture].first);
    EXPECT_EQ(data.materials[3].emission_texture, no_texture);
    EXPECT_EQ(uintBitsToFloat(data.texels[255]), 1.0f);
    EXPECT_EQ(uintBitsToFloat(data.texels[0]), 0.0f);
}

TEST(Geometry, a_surface_turns_to_the_ray) {
    Surface s{vec3(0), {0, 0, 1}, glm::normalize(vec3(0.9f, 0, 0.3f)), vec3(1), vec3(0.04f), 0, vec3(2), false, 1};
    EXPECT_EQ(face_towards(s, {0, 0, -1}).emission, vec3(2));
    EXPECT_EQ(face_towards(s, {0, 0, -1}).geometric_normal, vec3(0, 0, 1));
    EXPECT_EQ(face_towards(s, {0, 0, 1}).emission, vec3(0));
    EXPECT_EQ(face_towards(s, {0, 0, 1}).geometric_normal, vec3(0, 0, -1));
    const vec3 grazing = glm::normalize(vec3(1, 0, -0.1f));  // sees the face, but the shading normal leans away
    const Surface seen = face_towards(s, grazing);
    EXPECT_NEAR(glm::dot(seen.shading_normal, grazing), 0, 1e-6);
    EXPECT_NEAR(glm::length(seen.shading_normal), 1, 1e-6);
    EXPECT_EQ(unit_or(vec3(0), {0, 1, 0}), vec3(0, 1, 0));
    EXPECT_NEAR(glm::length(unit_or(vec3(1e-30f, 2e-30f, 0), vec3(0))), 1, 1e-6);
    EXPECT_NEAR(glm::length(unit_or(vec3(1e30f, 2e30f, 0), vec3(0))), 1, 1e-6);
}

TEST(Lights, power_of_each_kind) {
    using Type = scenes::Light::Type;
    TestScene test;
    const uint32_t plain = test.material(vec3(1)), lamp = test.material(vec3(1), {3, 6, 9}), both = test.material(vec3(1), {1, 1, 1}, true);
    const uint32_t textured = test.material(vec3(1), {1, 1, 1});
    scenes::Texture half;
    half.width = 2, half.height = 1, half.rgba = {0, 0, 0, 255, 255, 255, 255, 255};
    test.scene.textures.push_back(half);
    test.scene.materials[textured].emissive_texture = {0};

    const auto power = [&] { return light_data(test.scene, test.triangles, geometry_data(test.scene, test.triangles)).power; };
    EXPECT_EQ(power(), 0);
    test.quad({0, 0, 0}, {2, 0, 0}, {0, 3, 0}, plain);
    EXPECT_EQ(power(), 0);
    double sum = 0;
    test.light(Type::point, vec3(0), {0, 0, -1}, {1, 2, 3});
    EXPECT_NEAR(power(), sum += 4 * pi_d * 2, 1e-5);
    test.light(Type::spot, vec3(0), {0, 0, -1}, {1, 1, 1}, 0.5f, 1.0f);
    EXPECT_NEAR(power(), sum += 2 * pi_d * ((1 - std::cos(0.5)) + (std::cos(0.5) - std::cos(1.0)) / 3), 1e-5);
    test.light(Type::directional, vec3(0), {0, 1, -1}, {5, 5, 5});
    EXPECT_NEAR(power(), sum += 5 * 6 * std::sqrt(0.5), 1e-4);  // the bounds are the quad
    test.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, lamp);
    EXPECT_NEAR(power(), sum += 6 * pi_d, 1e-4);
    test.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, both);
    EXPECT_NEAR(power(), sum += 2 * pi_d, 1e-4);
    test.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, textured);
    EXPECT_NEAR(power(), sum += 0.5 * pi_d, 1e-4);
    test.quad({0, 0, 0}, {0, 0, 0}, {0, 1, 0}, lamp);  // no area
    EXPECT_NEAR(power(), sum, 1e-4);

    const LightData data = light_data(test.scene, test.triangles, geometry_data(test.scene, test.triangles));
    EXPECT_EQ(data.punctual, 3u);
    ASSERT_EQ(data.lights.size(), 3u + 6);
    EXPECT_EQ(data.lights.back().cdf, 1.0f);
    EXPECT_NEAR(data.lights[0].cdf, 8 * pi_d / sum, 1e-6);
    EXPECT_EQ(data.lights[3].triangle, 2u);
    EXPECT_EQ(data.lights[3].type, light_triangle);
    for (size_t i = 1; i < data.lights.size(); ++i) EXPECT_GE(data.lights[i].cdf, data.lights[i - 1].cdf);
}

TEST(Lights, lights_without_power_have_no_share) {
    TestScene test;
    test.material(vec3(1));
    for (float intensity : {0.0f, 1.0f, 0.0f, 2.0f, 0.0f}) test.light(scenes::Light::Type::point, vec3(0), {0, 0, -1}, vec3(intensity));
    const LightData data = light_data(test.scene, test.triangles, geometry_data(test.scene, test.triangles));
    const std::vector<float> expected{0, float(1.0 / 3), float(1.0 / 3), 1, 1};
    for (size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(data.lights[i].cdf, expected[i]) << i;
}

TEST(Lights, a_hundred_thousand_emitters) {
    TestScene test;
    test.material(vec3(1), vec3(1));
    std::mt19937 random(1);
    test.soup(100000, 5, random);
    const LightData data = light_data(test.scene, test.triangles, geometry_data(test.scene, test.triangles));
    double sum = 0, worst = 0;
    for (size_t i = 0; i < data.lights.size(); ++i) {
        sum += pi_d * double(data.lights[i].extent.x) / data.power;
        worst = std::max(worst, std::abs(sum - double(data.lights[i].cdf)));
    }
    EXPECT_LT(worst, 1e-7);
}

}  // namespace
}  // namespace myriad::passes
