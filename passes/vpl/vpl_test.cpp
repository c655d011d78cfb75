#include "passes/vpl/vpl.hpp"

#include <numbers>

#include "engine/testing.hpp"
#include "passes/geometry/test_scene.hpp"
#include "passes/vpl/vpl_ref.hpp"

namespace myriad::passes {
namespace {

using glm::dvec3;
using Type = scenes::Light::Type;
constexpr double pi_d = std::numbers::pi;

class VplTest : public engine::DeviceTest {
protected:
    struct Result {
        std::vector<Vpl> vpls;
        std::vector<View> views;
    };
    Result run(const TestScene& test, uint32_t max_vpls, uint32_t bounces, uint32_t seed = 1) {
        const UploadedScene scene(device, test);
        VplPass pass(device, max_vpls, scene.bvh.constants());
        engine::Recorder recorder(device);
        pass.record(recorder, scene.geometry, scene.bvh, scene.lights, bounces, seed);
        recorder.submit_and_wait();
        EXPECT_EQ(engine::download(device, pass.exhausted())[0], 0u);
        const uint32_t count = engine::download(device, pass.count())[0];
        EXPECT_LE(count, max_vpls);
        return {engine::download(device, pass.vpls(), count), engine::download(device, pass.views(), count)};
    }

    static TestScene box(const vec3& albedo) {
        TestScene test;
        test.room({-1, -2, -3}, {3, 2, 1}, test.material(albedo));
        return test;
    }

    static dvec3 flux_of(const std::vector<Vpl>& vpls, uint32_t bounce) {
        dvec3 sum(0);
        for (const Vpl& v : vpls)
            if (v.bounce == bounce) sum += dvec3(v.flux);
        return sum;
    }
    static ::testing::AssertionResult near(const dvec3& expected, const dvec3& actual, double relative) {
        if (glm::length(expected - actual) <= relative * glm::length(expected)) return ::testing::AssertionSuccess();
        return ::testing::AssertionFailure() << actual.x << " " << actual.y << " " << actual.z << " found, " << expected.x << " "
                                             << expected.y << " " << expected.z << " expected";
    }

    // How many VPLs of either list have no partner in the other, in order. A path that meets an edge may go another way.
    static size_t unmatched(const std::vector<Vpl>& a, const std::vector<Vpl>& b, double tolerance) {
        const auto same_vpl = [&](const Vpl& v, const Vpl& w) {
            return glm::length(dvec3(v.position) - dvec3(w.position)) <= tolerance && v.bounce == w.bounce &&
                   glm::dot(unpack_direction(v.normal), unpack_direction(w.normal)) > 0.9999f &&
                   glm::length(v.flux - w.flux) <= 1e-3f * glm::length(w.flux) + 1e-12f;
        };
        size_t i = 0, j = 0, lonely = 0;
        while (i < a.size() && j < b.size()) {
            size_t skip = 0, left = 0;  // the nearest pair ahead that matches
            bool found = false;
            for (skip = 0; skip < 16 && !found; ++skip)
                for (left = 0; left <= skip && !found; ++left)
                    found = i + left < a.size() && j + skip - left < b.size() && same_vpl(a[i + left], b[j + skip - left]);
            if (!found) return lonely + (a.size() - i) + (b.size() - j);
            --skip, --left;
            lonely += skip;
            i += left + 1, j += skip - left + 1;
        }
        return lonely + (a.size() - i) + (b.size() - j);
    }
};

TEST_F(VplTest, closed_box_keeps_the_energy_of_a_point_light) {  // spec, invariant 7
    const vec3 albedo(0.8f, 0.5f, 0.25f), intensity(3, 2, 1);
    for (uint32_t paths : {1u, 63u, 64u, 65u, 1000u, 4096u}) {
        TestScene test = box(albedo);
        test.light(Type::point, {0.5f, 0.3f, -0.7f}, {0, 0, -1}, intensity);
        const auto got = run(test, 3 * paths + 2, 3);  // two slots more than paths need
        ASSERT_EQ(got.vpls.size(), 3 * paths);
        dvec3 flux = 4 * pi_d * dvec3(intensity);
        for (uint32_t bounce = 1; bounce <= 3; ++bounce) {
            flux *= dvec3(albedo);
            EXPECT_TRUE(near(flux, flux_of(got.vpls, bounce), 2e-6)) << paths << " paths, bounce " << bounce;
        }
    }
}

TEST_F(VplTest, white_box_keeps_all_energy_for_64_bounces) {
    TestScene test = box(vec3(1));
    test.light(Type::spot, {0.5f, 0.3f, -0.7f}, {1, 2, -1}, vec3(5), 0.3f, 0.8f);
    const auto got = run(test, 64 * 100, vpl_max_bounces);
    ASSERT_EQ(got.vpls.size(), 6400u);
    const double flux = 5 * 2 * pi_d * ((1 - std::cos(0.3)) + (std::cos(0.3) - std::cos(0.8)) / 3);
    for (uint32_t bounce = 1; bounce <= 64; ++bounce) EXPECT_TRUE(near(dvec3(flux), flux_of(got.vpls, bounce), 2e-6)) << bounce;
}

TEST_F(VplTest, emitters_and_punctual_lights_share_the_paths) {
    const vec3 albedo(0.8f, 0.5f, 0.25f);
    TestScene test = box(albedo);
    const uint32_t lamp = test.material(albedo, {4, 4, 4});
    test.quad({0, 1.9f, -1}, {1, 0, 0}, {0, 0, 1}, lamp);             // 1 m^2 that looks down
    test.light(Type::point, {0.5f, 0.3f, -0.7f}, {0, 0, -1}, vec3(1));  // 4 pi W, as the lamp
    const auto got = run(test, 3 * 1000, 2);
    ASSERT_EQ(got.vpls.size(), 500u + 1000 + 1000);  // half the paths start on the lamp
    EXPECT_TRUE(near(dvec3(4 * pi_d), flux_of(got.vpls, 0), 1e-5));
    EXPECT_TRUE(near(8 * pi_d * dvec3(albedo), flux_of(got.vpls, 1), 1e-5));
    EXPECT_TRUE(near(8 * pi_d * dvec3(albedo) * dvec3(albedo), flux_of(got.vpls, 2), 1e-5));
    for (const Vpl& v : got.vpls)
        if (v.bounce == 0) {
            EXPECT_EQ(unpack_direction(v.normal), vec3(0, -1, 0));
            EXPECT_NEAR(v.position.y, 1.9, 1e-4);
            EXPECT_LT(v.position.y, 1.9f);
        }
}

TEST_F(VplTest, a_double_sided_emitter_shines_both_ways) {
    TestScene test = box(vec3(0.5f));
    test.quad({0, 0, 0}, {1, 0, 0}, {0, 0, 1}, test.material(vec3(0.5f), {1, 2, 3}, true));
    const auto got = run(test, 2000, 1);
    size_t up = 0;
    for (const Vpl& v : got.vpls) up += v.bounce == 0 && unpack_direction(v.normal).y > 0;
    EXPECT_EQ(up, 500u);
    EXPECT_TRUE(near(2 * pi_d * dvec3(1, 2, 3), flux_of(got.vpls, 0), 1e-5));
}

TEST_F(VplTest, textured_emission_is_unbiased_over_seeds) {
    TestScene test = box(vec3(0.5f));
    const uint32_t lamp = test.material(vec3(0), {1, 1, 1});
    test.scene.materials[lamp].emissive_texture = {test.texture(4, 4, random)};
    test.quad({0, 1.9f, -1}, {1, 0, 0}, {0, 0, 1}, lamp);
    // Bilinear weights add up to one a texel under wrapping: the mean over the quad is the mean of the texels.
    dvec3 mean(0);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) {
            const uint8_t* c = &test.scene.textures[0].rgba[4 * (4 * y + x)];
            mean += dvec3(srgb_to_linear(c[0]), srgb_to_linear(c[1]), srgb_to_linear(c[2])) / 16.0;
        }
    dvec3 sum(0);
    for (uint32_t seed = 0; seed < 16; ++seed) sum += flux_of(run(test, 2 * 512, 1, seed).vpls, 0) / 16.0;
    EXPECT_TRUE(near(pi_d * mean, sum, 2e-3));
}

TEST_F(VplTest, sunlight_through_the_bounds) {
    // The floor is all there is: every ray must meet it, for the outline of its bounds is itself.
    TestScene test;
    test.quad({-3, 1, -2}, {0, 0, 4}, {6, 0, 0}, test.material({0.5f, 0.25f, 1}));
    test.light(Type::directional, vec3(0), {1, -1, 0.3f}, vec3(2, 4, 8));
    const auto got = run(test, 1000, 1);
    ASSERT_EQ(got.vpls.size(), 1000u);
    EXPECT_TRUE(near(24 / std::sqrt(2.09) * dvec3(1, 1, 8), flux_of(got.vpls, 1), 1e-5));
    size_t quarter = 0;
    for (const Vpl& v : got.vpls) quarter += v.position.x < 0 && v.position.z < 0;
    EXPECT_NEAR(double(quarter), 250, 8);

    // A block: what its three lit faces get, by hand. All sides of the sun.
    for (const vec3& way : {vec3(1, -2, 3), vec3(-1, 2, -3), vec3(-3, -1, 2), vec3(0, 0, 1), vec3(0, -1, 0)}) {
        TestScene block;
        block.room({3, 2, 1}, {1, -1, -1}, block.material(vec3(0.5f)));  // inside out: seen from outside
        block.light(Type::directional, vec3(0), way, vec3(1));
        const dvec3 d = glm::normalize(dvec3(way));
        const double lit = std::abs(d.x) * 3 * 2 + std::abs(d.y) * 2 * 2 + std::abs(d.z) * 2 * 3;
        const auto vpls = run(block, 777, 1).vpls;
        EXPECT_GE(vpls.size(), 775u);  // a ray along an edge may slip by
        EXPECT_TRUE(near(dvec3(0.5 * lit), flux_of(vpls, 1), 3e-3));
        for (const Vpl& v : vpls) ASSERT_LT(glm::dot(dvec3(unpack_direction(v.normal)), d), 1e-4);
    }
}

TEST_F(VplTest, lie_on_surfaces_and_look_at_the_lit_side) {
    TestScene test = box(vec3(0.5f));
    test.light(Type::point, {0.5f, 0.3f, -0.7f}, {0, 0, -1}, vec3(1));
    const auto got = run(test, 2000, 4);
    ASSERT_EQ(got.vpls.size(), 2000u);
    for (size_t i = 0; i < got.vpls.size(); ++i) {
        const Vpl& v = got.vpls[i];
        const vec3 n = unpack_direction(v.normal), low = v.position - vec3(-1, -2, -3), high = vec3(3, 2, 1) - v.position;
        // From the wall that the normal belongs to, a hair to the inside.
        const float from_wall = glm::dot(glm::max(n, vec3(0)), low) + glm::dot(glm::max(-n, vec3(0)), high);
        ASSERT_GT(from_wall, 0.0f) << i;
        ASSERT_LT(from_wall, 2e-5f) << i;
        ASSERT_GT(glm::dot(n, vec3(1, 0, -1) - v.position), 0.0f) << i;
        ASSERT_EQ(got.views[i].position, v.position) << i;
        ASSERT_EQ(got.views[i].direction, n) << i;
        ASSERT_EQ(got.views[i].cos_phi, 0.0f);
        ASSERT_EQ(got.views[i].sin_phi, 1.0f);
    }
}

// Cut-outs let paths through where they are not, and shine where they are; unlit surfaces end paths and send none.
TEST_F(VplTest, equal_the_twin_where_surfaces_have_holes) {
    using Alpha = scenes::Material::Alpha;
    TestScene test;
    test.material({0.8f, 0.6f, 0.4f});
    test.textured(random).alpha = Alpha::mask;
    test.textured(random, scenes::Texture::Wrap::mirror).alpha = Alpha::mask;
    test.textured(random).unlit = true;
    test.soup(400, 4, random);
    test.decorate(random);
    test.light(Type::point, {0, 1, 0}, {0, 0, -1}, vec3(5));
    test.light(Type::directional, vec3(0), {1, -2, 0.5f}, vec3(0.3f));
    for (uint32_t bounces : {0u, 1u, 3u}) {
        const auto expected = vpl_ref(test.scene, test.triangles, 3000, bounces, 11);
        EXPECT_GT(expected.size(), 300u);
        EXPECT_LE(unmatched(expected, run(test, 3000, bounces, 11).vpls, 2e-3), expected.size() / 50) << bounces;
        TestScene solid = test;
        for (scenes::Material& m : solid.scene.materials) m.alpha = Alpha::opaque;
        EXPECT_GT(unmatched(vpl_ref(solid.scene, solid.triangles, 3000, bounces, 11), run(test, 3000, bounces, 11).vpls, 2e-3), expected.size() / 5) << bounces;
    }
    for (scenes::Material& m : test.scene.materials) m.unlit = true;
    test.scene.lights.clear();
    EXPECT_TRUE(run(test, 100, 2).vpls.empty());
}

TEST_F(VplTest, blended_panes_take_their_share_of_light) {
    TestScene test;
    test.quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, test.material(vec3(1)));
    scenes::Material& m = test.scene.materials[test.material(vec3(1))];
    m.alpha = scenes::Material::Alpha::blend, m.base_color.a = 0.3f;
    test.quad({-1, 1, -1}, {0, 0, 2}, {2, 0, 0}, 1);
    test.light(Type::directional, vec3(0), {0, -1, 0}, vec3(1));
    double pane = 0, floor = 0;
    for (const Vpl& v : run(test, 20000, 1).vpls) (v.position.y > 0.5f ? pane : floor) += double(v.flux.x);
    EXPECT_NEAR(pane, 0.3 * 4, 0.05);
    EXPECT_NEAR(floor, 0.7 * 4, 0.05);
    // And one that shines does so for its share of the area.
    test.scene.lights.clear();
    test.scene.materials[1].emissive = vec3(1);
    double sum = 0;
    for (const Vpl& v : run(test, 20000, 0).vpls) sum += double(v.flux.x);
    EXPECT_NEAR(sum, 0.3 * 4 * std::numbers::pi, 0.2);
}

TEST_F(VplTest, equal_the_twin) {
    TestScene closed = box({0.9f, 0.6f, 0.3f});
    closed.quad({0, 1.9f, -1}, {1, 0, 0}, {0, 0, 1}, closed.material(vec3(0.7f), {1, 2, 3}));
    closed.light(Type::point, {0.5f, 0.3f, -0.7f}, {0, 0, -1}, vec3(1));
    closed.light(Type::spot, {0.5f, 0.3f, -0.7f}, {1, 2, -1}, vec3(2), 0.1f, 0.9f);
    for (uint32_t bounces : {0u, 1u, 2u, 5u})
        for (uint32_t size : {6u, 7u, 100u, 1001u}) {
            const auto expected = vpl_ref(closed.scene, closed.triangles, size, bounces, 7);
            EXPECT_LE(unmatched(expected, run(closed, size, bounces, 7).vpls, 1e-3), size / 50) << bounces << " " << size;
        }

    // Open, so that most paths die; all kinds of light, black surfaces, both kinds of sides.
    TestScene open;
    open.material({0.8f, 0.6f, 0.4f});
    open.material(vec3(0));
    open.material({0.2f, 0.9f, 0.7f}, {0.1f, 0.2f, 0.1f}, true);
    open.soup(600, 6, random);
    open.light(Type::directional, vec3(0), {1, -2, 0.5f}, vec3(1));
    open.light(Type::point, {0, 1, 0}, {0, 0, -1}, vec3(5));
    open.light(Type::point, {0, 1, 0}, {0, 0, -1}, vec3(0));
    open.light(Type::spot, {3, 3, 3}, {-1, -1, -1}, vec3(40), 0, 0.4f);
    for (uint32_t bounces : {1u, 3u}) {
        const auto expected = vpl_ref(open.scene, open.triangles, 3000, bounces, 11);
        const auto got = run(open, 3000, bounces, 11);
        EXPECT_GT(got.vpls.size(), 300u);
        EXPECT_LT(got.vpls.size(), 2900u);
        EXPECT_LE(unmatched(expected, got.vpls, 2e-3), expected.size() / 50) << bounces;
    }
}

TEST_F(VplTest, comparator_sees_missing_and_wrong_ones) {
    TestScene test = box(vec3(0.5f));
    test.light(Type::point, {0.5f, 0.3f, -0.7f}, {0, 0, -1}, vec3(1));
    auto vpls = run(test, 100, 1).vpls;
    ASSERT_EQ(unmatched(vpls, vpls, 1e-3), 0u);
    auto wrong = vpls;
    wrong[40].flux *= 1.01f;
    EXPECT_EQ(unmatched(vpls, wrong, 1e-3), 2u);
    wrong.erase(wrong.begin() + 40);
    EXPECT_EQ(unmatched(vpls, wrong, 1e-3), 1u);
}

TEST_F(VplTest, the_pattern_is_fixed_and_the_seed_changes_it) {
    TestScene test = box(vec3(0.5f));
    test.light(Type::point, {0.5f, 0.3f, -0.7f}, {0, 0, -1}, vec3(1));
    const auto first = run(test, 500, 2, 5).vpls, again = run(test, 500, 2, 5).vpls, other = run(test, 500, 2, 6).vpls;
    ASSERT_EQ(first.size(), again.size());
    EXPECT_EQ(std::memcmp(first.data(), again.data(), first.size() * sizeof(Vpl)), 0);
    size_t moved = 0;
    for (size_t i = 0; i < first.size(); ++i) moved += first[i].position != other[i].position;
    EXPECT_GT(moved, 490u);
}

TEST_F(VplTest, a_pass_can_be_recorded_again_with_less) {
    TestScene lit = box(vec3(0.5f)), dark = box(vec3(0.5f)), black = box(vec3(0));
    lit.light(Type::point, {0.5f, 0.3f, -0.7f}, {0, 0, -1}, vec3(1));
    black.light(Type::point, {0.5f, 0.3f, -0.7f}, {0, 0, -1}, vec3(1));
    const UploadedScene one(device, lit), two(device, dark), three(device, black);
    VplPass pass(device, 300, one.bvh.constants());
    engine::Recorder recorder(device);
    const auto count = [&](const UploadedScene& scene, uint32_t bounces) {
        pass.record(recorder, scene.geometry, scene.bvh, scene.lights, bounces, 1);
        recorder.submit_and_wait();
        return engine::download(device, pass.count())[0];
    };
    EXPECT_EQ(count(one, 3), 300u);
    EXPECT_EQ(count(one, 7), 294u);
    EXPECT_EQ(count(two, 3), 0u);    // no light
    EXPECT_EQ(count(one, 0), 0u);    // and nothing that emits by itself
    EXPECT_EQ(count(three, 3), 0u);  // nothing reflects
    EXPECT_EQ(count(one, 1), 300u);
    EXPECT_THROW(VplPass(device, 2, one.bvh.constants()).sure_paths(one.lights, 3), InputError);
    EXPECT_EQ(VplPass(device, 2, one.bvh.constants()).sure_paths(two.lights, 3), 0u);
}

TEST_F(VplTest, at_any_scale_and_far_away_they_are_finite) {
    for (const auto& [scale, offset] : {std::pair{1e-6f, 0.0f}, {1e6f, 0.0f}, {1.0f, 1e6f}}) {
        TestScene test;
        test.room(scale * vec3(-1, -2, -3) + offset, scale * vec3(3, 2, 1) + offset, test.material(vec3(0.5f)));
        test.quad(scale * vec3(0, 1.8f, -1) + offset, {scale, 0, 0}, {0, 0, scale}, test.material(vec3(0.5f), vec3(1)));
        test.triangles.triangles.emplace_back(0, 0, 0, 1);  // emits from no area
        test.light(Type::point, scale * vec3(0.5f, 0.3f, -0.7f) + offset, {0, 0, -1}, vec3(scale * scale));
        test.light(Type::point, scale * vec3(-1, -2, -3) + offset, {0, 0, -1}, vec3(scale * scale));  // in a corner
        test.light(Type::spot, scale * vec3(0, -2, 0) + offset, {0, 1, 0}, vec3(scale * scale), 0, 0);  // on the floor, no width
        test.light(Type::directional, vec3(0), {0, -1, 0}, vec3(1));
        const auto vpls = run(test, 1000, 3).vpls;
        EXPECT_GT(vpls.size(), 300u) << scale;
        for (const Vpl& v : vpls) {
            ASSERT_TRUE(std::isfinite(v.position.x + v.position.y + v.position.z + v.flux.x + v.flux.y + v.flux.z));
            const vec3 at = (v.position - offset) / scale;
            // Units in the last place of 1e6 are 1/16 m, and a ray starts 2 m off: there only the order is right.
            const float slack = offset > 0 ? 5.0f : 1e-4f;
            ASSERT_TRUE(glm::all(glm::greaterThan(at, vec3(-1, -2, -3) - slack)) && glm::all(glm::lessThan(at, vec3(3, 2, 1) + slack)))
                << at.x << " " << at.y << " " << at.z;
        }
    }
}

TEST_F(VplTest, an_empty_scene_has_none) {
    TestScene empty;
    empty.material(vec3(1));
    empty.light(Type::point, vec3(0), {0, 0, -1}, vec3(1));
    empty.light(Type::directional, vec3(0), {0, 0, -1}, vec3(1));
    EXPECT_TRUE(run(empty, 64, 2).vpls.empty());
}

}  // namespace
}  // namespace myriad::passes
