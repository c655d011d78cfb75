#include "passes/direct/direct.hpp"

#include <numbers>

#include "engine/testing.hpp"
#include "passes/direct/direct_ref.hpp"
#include "passes/geometry/test_scene.hpp"

namespace myriad::passes {
namespace {

using glm::dvec3;
using Type = scenes::Light::Type;

class DirectTest : public engine::DeviceTest {
protected:
    struct Result {
        std::vector<vec4> radiance, positions;
    };
    Result run(const TestScene& test, uint32_t width, uint32_t height, uint32_t lights_a_dispatch = 0) {
        const UploadedScene scene(device, test);
        EXPECT_EQ(DirectPass::needed(scene.lights), !test.scene.lights.empty());
        GBufferPass gbuffer(device, width, height, scene.bvh.constants(), scene.data.glossy);
        DirectPass direct(device, width, height, lights_a_dispatch, scene.bvh.constants({{glossy_constant, scene.data.glossy}}));
        engine::Recorder recorder(device);
        gbuffer.record(recorder, scene.geometry, scene.bvh, test.scene.cameras[0]);
        direct.record(recorder, gbuffer.gbuffer(), scene.bvh, scene.lights);
        recorder.submit_and_wait();
        EXPECT_EQ(engine::download(device, direct.exhausted())[0], 0u);
        return {engine::download(device, direct.radiance()), engine::download(device, gbuffer.gbuffer().positions)};
    }

    // A floor at y = 0 that a camera looks down on.
    static TestScene floor(const vec3& albedo) {
        TestScene test;
        test.quad({-50, 0, -50}, {0, 0, 100}, {100, 0, 0}, test.material(albedo));
        test.look({0, 5, 0.01f}, vec3(0), 1.2f);
        return test;
    }

    static size_t differing(const TestScene& test, const Result& got, uint32_t width, uint32_t height, double tolerance = 5e-4) {
        const auto expected = direct_ref(test.scene, test.triangles, gbuffer_ref(test.scene, test.triangles, test.scene.cameras[0], width, height));
        size_t wrong = 0;
        for (size_t i = 0; i < expected.size(); ++i)
            wrong += !(glm::length(expected[i] - dvec3(got.radiance[i])) <= 1e-5 + tolerance * glm::length(expected[i]));
        return wrong;
    }
};

TEST_F(DirectTest, point_light_over_a_plane) {
    const vec3 albedo(0.8f, 0.5f, 0.1f), intensity(10, 20, 30);
    TestScene test = floor(albedo);
    test.light(Type::point, {1, 2, -1}, {0, 0, -1}, intensity);
    const auto got = run(test, 31, 17);
    for (size_t i = 0; i < got.radiance.size(); ++i) {
        const dvec3 d = dvec3(1, 2, -1) - dvec3(got.positions[i]);
        const dvec3 expected = dvec3(albedo) / std::numbers::pi * dvec3(intensity) * (d.y / glm::length(d)) / glm::dot(d, d);
        ASSERT_LE(glm::length(dvec3(got.radiance[i]) - expected), 1e-5 * glm::length(expected) + 1e-9) << i;
    }
}

// Within its radius a light grows no more.
TEST_F(DirectTest, a_light_with_a_radius_over_a_plane) {
    TestScene test = floor(vec3(1));
    test.light(Type::point, {1, 2, -1}, {0, 0, -1}, vec3(10));
    test.scene.lights[0].radius = 3;
    const auto got = run(test, 31, 17);
    size_t inside = 0;
    for (size_t i = 0; i < got.radiance.size(); ++i) {
        const dvec3 d = dvec3(1, 2, -1) - dvec3(got.positions[i]);
        inside += glm::length(d) < 3;
        const double expected = 10 / std::numbers::pi * (d.y / glm::length(d)) / std::max(glm::dot(d, d), 9.0);
        ASSERT_NEAR(got.radiance[i].x, expected, 1e-5 * expected + 1e-9) << i;
    }
    EXPECT_GT(inside, 10u);
    EXPECT_LT(inside, got.radiance.size());
    EXPECT_EQ(differing(test, got, 31, 17), 0u);
}

TEST_F(DirectTest, directional_light_is_irradiance_across_its_way) {
    TestScene test = floor(vec3(0.5f));
    test.light(Type::directional, vec3(0), {1, -2, 0.5f}, vec3(3, 2, 1));
    const double cosine = 2 / std::sqrt(1 + 4 + 0.25);
    for (const vec4& radiance : run(test, 9, 5).radiance)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(radiance[c], 0.5 / std::numbers::pi * cosine * (3 - c), 1e-6);
}

TEST_F(DirectTest, spot_falls_off_as_the_extension_recommends) {
    // By hand: cos_inner 0.9, cos_outer 0.8; a cosine of 0.85 is half-way, hence a quarter.
    scenes::Light by_hand{Type::spot, "", vec3(0), vec3(0, 0, -1), vec3(1), std::acos(0.9f), std::acos(0.8f)};
    EXPECT_NEAR(incident_ref(by_hand, {std::sqrt(1 - 0.85 * 0.85), 0, -0.85}).irradiance.x, 0.25, 1e-6);

    for (const auto& [inner, outer] : {std::pair{0.0f, 0.785398f}, {0.3f, 0.6f}, {0.5f, 0.5f}, {0.0f, 0.02f}, {0.2f, 1.57f}}) {
        TestScene test = floor(vec3(0.9f));
        test.light(Type::spot, {0.5f, 3, 0}, {0.1f, -1, 0.2f}, vec3(50), inner, outer);
        const auto got = run(test, 61, 61);
        EXPECT_LE(differing(test, got, 61, 61), inner == outer ? 12u : 0u) << inner << " " << outer;  // the step's edge may fall either way
    }
}

TEST_F(DirectTest, an_occluder_casts_its_shadow) {
    TestScene test = floor(vec3(1));
    test.quad({-1, 1, -1}, {0, 0, 2}, {2, 0, 0}, test.material(vec3(0.5f)));
    test.light(Type::point, {0, 2, 0}, {0, 0, -1}, vec3(10));
    test.look({8, 6, 0}, vec3(0));
    const auto got = run(test, 64, 64);
    size_t lit = 0, dark = 0;
    for (size_t i = 0; i < got.radiance.size(); ++i) {
        const vec4 p = got.positions[i];
        const float across = std::max(std::abs(p.x), std::abs(p.z));
        // The shadow of a half-width of 1 at half the height is 2 wide each way.
        if (p.w == 0 || p.y > 0.5f || std::abs(across - 2) < 1e-3f) continue;
        EXPECT_EQ(got.radiance[i].x > 0, across > 2) << p.x << " " << p.z;
        (across > 2 ? lit : dark) += 1;
    }
    EXPECT_GT(lit, 100u);
    EXPECT_GT(dark, 100u);
}

TEST_F(DirectTest, light_falls_through_holes) {
    using Alpha = scenes::Material::Alpha;
    TestScene test;
    for (const Alpha alpha : {Alpha::opaque, Alpha::mask, Alpha::mask}) test.textured(random).alpha = alpha;
    test.soup(150, 4, random);
    test.decorate(random);
    test.light(Type::point, {3, 4, 6}, {0, 0, -1}, vec3(50));
    test.light(Type::directional, vec3(0), {-1, -2, -3}, vec3(2));
    test.look({0, 0, 10}, vec3(0), 1);
    const auto got = run(test, 60, 48);
    EXPECT_LE(differing(test, got, 60, 48), 60u * 48 / 50);
    for (scenes::Material& m : test.scene.materials) m.alpha = Alpha::opaque;
    EXPECT_GT(differing(test, got, 60, 48), 60u * 48 / 10);
}

// A pane of alpha 0.3 before the light dims it by 0.3, two of them by 0.51; nothing of it is where it is not.
TEST_F(DirectTest, shadows_of_blended_surfaces_are_right_in_the_mean) {
    for (const int panes : {1, 2}) {
        TestScene test = floor(vec3(1));
        scenes::Material& m = test.scene.materials[test.material(vec3(0.5f))];
        m.alpha = scenes::Material::Alpha::blend, m.base_color.a = 0.3f;
        for (int i = 0; i < panes; ++i) test.quad({-100, 20.0f + float(i), -100}, {0, 0, 200}, {200, 0, 0}, 1);
        test.light(Type::directional, vec3(0), {0, -1, 0}, vec3(std::numbers::pi_v<float>));
        double sum = 0;
        for (const vec4& radiance : run(test, 200, 200).radiance) {
            ASSERT_TRUE(radiance.x == 0 || std::abs(radiance.x - 1) < 1e-4);
            sum += double(radiance.x);
        }
        EXPECT_NEAR(sum / 40000, std::pow(0.7, panes), 0.01);
    }
}

TEST_F(DirectTest, equals_the_twin_on_random_scenes) {
    std::uniform_real_distribution<float> unit(-1, 1);
    for (uint32_t lights : {1u, 2u, 7u, 70u}) {
        TestScene test;
        test.material({0.8f, 0.6f, 0.4f});
        test.material({0.2f, 0.9f, 0.7f}, vec3(1), true);
        test.soup(150, 5, random);
        for (uint32_t i = 0; i < lights; ++i)
            test.light(Type(i % 3), 6.0f * vec3(unit(random), unit(random), unit(random)), vec3(unit(random), unit(random), 0.1f),
                       vec3(5, 10, 3) / float(lights), 0.2f, 1.2f);
        test.look({0, 0, 10}, vec3(0), 1);
        const auto got = run(test, 48, 36);
        EXPECT_LE(differing(test, got, 48, 36), 48u * 36 / 50) << lights;
        // Spread over dispatches, as on devices that end loops silently: the same sums in the same order but for groups.
        for (uint32_t some : {1u, 3u, 69u}) {
            const auto spread = run(test, 48, 36, some);
            for (size_t i = 0; i < got.radiance.size(); ++i)
                ASSERT_LE(glm::length(got.radiance[i] - spread.radiance[i]), 1e-5f * glm::length(got.radiance[i])) << some << " " << i;
        }
    }
}

TEST_F(DirectTest, glossy_surfaces_equal_the_twin) {
    TestScene test;
    for (const auto& [metallic, roughness] : {std::pair{1.0f, 0.3f}, {0.0f, 0.15f}, {0.5f, 0.6f}, {1.0f, 1.0f}, {0.0f, 1.0f}}) {
        scenes::Material& m = test.scene.materials[test.material({0.9f, 0.6f, 0.3f})];
        m.metallic = metallic, m.roughness = roughness;
    }
    test.textured(random).roughness = 0.7f;
    test.soup(150, 4, random);
    for (int i = 0; i < 3; ++i) test.light(Type(i), {3, 4, 6}, {-1, -2, -3}, vec3(20, 10, 5), 0.2f, 1.2f);
    test.look({0, 0, 9}, vec3(0), 1);
    const auto got = run(test, 64, 48);
    // Packed normals are off by 4e-5, which is much beside a narrow lobe's width, and some of the texture's are narrow.
    EXPECT_LE(differing(test, got, 64, 48, 0.03), 64u * 48 / 50);
    for (scenes::Material& m : test.scene.materials) m.metallic = 0, m.roughness = 1;
    EXPECT_GT(differing(test, got, 64, 48, 0.03), 64u * 48 / 10);
}

// A mirror's highlight is where it must be, and as bright: irradiance over four times the solid angle of the slopes' disc, pi alpha^2.
TEST_F(DirectTest, highlights_of_a_metal_floor) {
    TestScene test = floor(vec3(1));
    test.scene.materials[0].metallic = 1, test.scene.materials[0].roughness = 0.3f;
    test.look({0, 5, 1e-3f}, vec3(0), 0.2f);
    test.light(Type::directional, vec3(0), {0, -1, 0}, vec3(1));
    const auto got = run(test, 65, 65);
    size_t brightest = 0;
    for (size_t i = 0; i < got.radiance.size(); ++i)
        if (got.radiance[i].x > got.radiance[brightest].x) brightest = i;
    EXPECT_LT(glm::length(vec3(got.positions[brightest])), 0.02f);
    EXPECT_NEAR(got.radiance[brightest].x * 4 * std::numbers::pi * std::pow(0.3, 4), 1, 0.01);
}

TEST_F(DirectTest, lights_in_hard_places_give_finite_light) {
    TestScene test = floor(vec3(1));
    test.scene.materials[0].roughness = 0;
    test.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 0);
    for (const vec3& at : {vec3(0), vec3(0, 0, 0.01f), vec3(0, 5, 0.01f), vec3(1e6f), vec3(0, 1e-20f, 0)}) {
        test.light(Type::point, at, {0, 0, -1}, vec3(1));
        test.light(Type::spot, at, {0, 0, -1}, vec3(1), 0, 0);
    }
    test.light(Type::directional, vec3(0), {1, 0, 0}, vec3(1));  // grazing
    test.light(Type::point, {0, 1, 0}, {0, 0, -1}, vec3(0));
    for (const vec4& radiance : run(test, 33, 33).radiance) {
        ASSERT_TRUE(std::isfinite(radiance.x + radiance.y + radiance.z));
        ASSERT_GE(std::min(radiance.x, std::min(radiance.y, radiance.z)), 0.0f);
    }
}

TEST_F(DirectTest, no_light_and_nothing_to_see) {
    TestScene dark = floor(vec3(1));
    for (const vec4& radiance : run(dark, 8, 8).radiance) EXPECT_EQ(radiance, vec4(0));
    TestScene empty;
    empty.material(vec3(1));
    empty.light(Type::point, vec3(0), {0, 0, -1}, vec3(1));
    empty.light(Type::directional, vec3(0), {0, 0, -1}, vec3(1));
    empty.look({0, 0, 1}, vec3(0));
    for (const vec4& radiance : run(empty, 8, 8).radiance) EXPECT_EQ(radiance, vec4(0));
}

TEST_F(DirectTest, comparator_sees_a_wrong_pixel) {
    TestScene test = floor(vec3(1));
    test.light(Type::point, {0, 2, 0}, {0, 0, -1}, vec3(10));
    auto got = run(test, 8, 8);
    ASSERT_EQ(differing(test, got, 8, 8), 0u);
    got.radiance[9] *= 1.01f;
    EXPECT_EQ(differing(test, got, 8, 8), 1u);
}

}  // namespace
}  // namespace myriad::passes
