#include "passes/gbuffer/gbuffer.hpp"

#include "engine/testing.hpp"
#include "passes/gbuffer/gbuffer_ref.hpp"
#include "passes/geometry/test_scene.hpp"

namespace myriad::passes {
namespace {

using glm::dvec3;

class GBufferTest : public engine::DeviceTest {
protected:
    struct Pixels {
        std::vector<vec4> positions, albedo, emitted;
        std::vector<uvec2> normals;
        std::vector<Gloss> gloss;
    };
    Pixels run(const TestScene& test, uint32_t width, uint32_t height) {
        const UploadedScene scene(device, test);
        GBufferPass pass(device, width, height, scene.bvh.constants(), true);
        engine::Recorder recorder(device);
        pass.record(recorder, scene.geometry, scene.bvh, test.scene.cameras[0], test.scene.background);
        recorder.submit_and_wait();
        EXPECT_EQ(engine::download(device, pass.exhausted())[0], 0u);
        const GBuffer& g = pass.gbuffer();
        return {engine::download(device, g.positions), engine::download(device, g.albedo), engine::download(device, g.emitted),
                engine::download(device, g.normals), engine::download(device, g.gloss)};
    }

    static bool another_gloss(const PixelRef& e, const Gloss& got) {
        const GlossRef& gloss = e.surface.gloss;
        if (is_matte(got) || gloss.roughness == 0) return !is_matte(got) || gloss.roughness != 0;
        const Lobe lobe = lobe_of(got, vec3(0, 0, 1));
        return !(length(gloss.f0 - dvec3(lobe.f0)) <= 2e-4 && std::abs(std::pow(gloss.roughness, 4) - lobe.alpha2) <= 3e-4 &&
                 length(dvec3(lobe.view) + e.direction) <= 2e-4);
    }
    // How many pixels differ from the twin's by more than rounding. Rays along edges may: they meet another triangle.
    static size_t differing(const TestScene& test, const Pixels& got, uint32_t width, uint32_t height, double scale) {
        const auto expected = gbuffer_ref(test.scene, test.triangles, test.scene.cameras[0], width, height);
        size_t wrong = 0;
        for (size_t i = 0; i < expected.size(); ++i) {
            const PixelRef& e = expected[i];
            const auto far = [](const dvec3& a, const dvec3& b, double tolerance) { return !(glm::length(a - b) <= tolerance); };
            bool bad = (e.depth > 0) != (got.positions[i].w > 0);
            if (e.depth > 0)
                bad = bad || far(e.surface.position, dvec3(got.positions[i]), 3e-6 * scale) ||
                      !(std::abs(e.depth - double(got.positions[i].w)) <= 3e-6 * scale) ||
                      far(e.surface.shading_normal, dvec3(unpack_direction(got.normals[i].x)), 2e-4) ||
                      far(e.surface.geometric_normal, dvec3(unpack_direction(got.normals[i].y)), 2e-4) ||
                      far(e.surface.albedo, dvec3(got.albedo[i]), 1e-4) || far(e.surface.emission, dvec3(got.emitted[i]), 1e-4) ||
                      another_gloss(e, got.gloss[i]);
            else
                bad = bad || !is_matte(got.gloss[i]) || got.positions[i] != vec4(0) || got.normals[i] != uvec2(0) || got.albedo[i] != vec4(0) || got.emitted[i] != vec4(test.scene.background, 0);
            wrong += bad;
        }
        return wrong;
    }

    // All that a material can be.
    void materials(TestScene& test) {
        using enum scenes::Texture::Wrap;
        test.material({0.8f, 0.5f, 0.2f});
        test.material({0.1f, 0.9f, 0.3f}, {1, 2, 3});
        test.material({0.7f, 0.7f, 0.7f}, {3, 1, 0.5f}, true);
        for (const auto& [u, v] : {std::pair{repeat, repeat}, {clamp, mirror}, {mirror, clamp}, {mirror, repeat}}) {
            auto& m = test.scene.materials[test.material({0.9f, 1, 0.8f}, {1, 1, 2}, u == mirror)];
            m.metallic = 0.6f;
            m.base_color_texture = {test.texture(7, 5, random, u, v)};
            m.metallic_roughness_texture = {test.texture(1, 3, random, v, u)};
            m.emissive_texture = {test.texture(16, 1, random, u, v)};
        }
    }
};

TEST_F(GBufferTest, equals_the_twin_on_random_triangles) {
    for (const float extent : {2.0f, 20.0f}) {
        TestScene test;
        materials(test);
        test.soup(300, extent, random);
        test.look({0.1f, 0.2f, 2 * extent}, vec3(0), 1.1f);
        const auto got = run(test, 67, 41);
        EXPECT_LE(differing(test, got, 67, 41, 2 * extent), 67u * 41 / 200);
    }
}

// Vertex colours, both sets of coordinates, transforms, bent normals with and without tangents, unlit surfaces, cut-outs and
// blended ones, in front of a sky.
TEST_F(GBufferTest, equals_the_twin_with_all_that_glTF_says_of_a_surface) {
    using Alpha = scenes::Material::Alpha;
    for (const bool decorated : {false, true}) {
        TestScene test;
        test.scene.background = {0.25f, 0.5f, 2};
        for (const Alpha alpha : {Alpha::opaque, Alpha::mask, Alpha::blend}) {
            test.textured(random).alpha = alpha;
            test.textured(random, scenes::Texture::Wrap::mirror, scenes::Texture::Wrap::clamp).alpha = alpha;
            scenes::Material& unlit = test.textured(random);
            unlit.alpha = alpha, unlit.unlit = true;
            scenes::Material& plain = test.scene.materials[test.material(vec3(0.5f))];
            plain.alpha = alpha, plain.base_color.a = 0.6f;
        }
        test.soup(300, 3, random);
        if (decorated) test.decorate(random);
        test.look({0.1f, 0.2f, 8}, vec3(0), 1.1f);
        const auto got = run(test, 67, 41);
        EXPECT_LE(differing(test, got, 67, 41, 8), 67u * 41 / 100) << decorated;
        // Each of these things is seen: without it the picture is another.
        const auto changes = [&](const char* what, auto change) {
            TestScene other = test;
            for (scenes::Material& m : other.scene.materials) change(m);
            change(other.triangles);
            EXPECT_GT(differing(other, got, 67, 41, 8), 67u * 41 / 50) << what << decorated;
        };
        const auto material = [&](const char* what, auto change) {
            changes(what, [&](auto& of) { if constexpr (std::is_same_v<std::decay_t<decltype(of)>, scenes::Material>) change(of); });
        };
        const auto vertices = [&](const char* what, auto change) {
            changes(what, [&](auto& of) { if constexpr (std::is_same_v<std::decay_t<decltype(of)>, scenes::Triangles>) change(of); });
        };
        material("roughness", [](scenes::Material& m) { m.roughness *= 0.8f; });
        material("alpha", [](scenes::Material& m) { m.alpha = Alpha::opaque; });
        material("cutoff", [](scenes::Material& m) { m.alpha_cutoff = 0.3f; });
        material("unlit", [](scenes::Material& m) { m.unlit = false; });
        material("normal texture", [](scenes::Material& m) { m.normal_texture = {}; });
        material("normal scale", [](scenes::Material& m) { m.normal_scale = 1; });
        material("transform", [](scenes::Material& m) { m.base_color_texture.transform = glm::mat3x2(1, 0, 0, 1, 0, 0); });
        if (!decorated) continue;
        material("set", [](scenes::Material& m) { m.base_color_texture.set ^= 1; });
        vertices("colours", [](scenes::Triangles& t) { t.colors.clear(); });
        vertices("tangents", [](scenes::Triangles& t) { t.tangents.clear(); });
    }
}

// A texel that points up in its image tilts the normal up on the surface, whichever way texture and instance run.
TEST_F(GBufferTest, normal_textures_point_where_they_say) {
    const vec3 tilted = glm::normalize(2.0f * vec3(160, 200, 250) / 255.0f - 1.0f);
    for (const bool tangents : {false, true})
        for (const bool mirrored : {false, true}) {
            TestScene test;
            scenes::Texture t;
            t.width = t.height = 1, t.rgba = {160, 200, 250, 255};
            test.scene.textures.push_back(t);
            test.scene.materials[test.material(vec3(1))].normal_texture = {0};
            // v falls upwards; mirrored: u falls to the right.
            test.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 0, mirrored ? vec2(1, 1) : vec2(0, 1), mirrored ? vec2(0, 0) : vec2(1, 0));
            if (tangents) test.triangles.tangents.assign(4, mirrored ? vec4(-1, 0, 0, -1) : vec4(1, 0, 0, 1));
            test.scene.cameras = {{"", mat4(1), 0.1f}};
            test.scene.cameras[0].to_world[3] = vec4(0, 0, 10, 1);
            const vec3 seen = unpack_direction(run(test, 1, 1).normals[0].x);
            EXPECT_NEAR(glm::length(seen - tilted * vec3(mirrored ? -1 : 1, 1, 1)), 0, 1e-3) << tangents << mirrored << " " << seen.x << " " << seen.y;
        }
}

TEST_F(GBufferTest, coordinates_that_do_not_span_leave_the_normal) {
    TestScene test;
    test.textured(random).base_color_texture = {};
    const vec3 n = glm::normalize(vec3(0.3f, 0.1f, 1));
    for (const auto& uv : {std::array{vec2(0), vec2(0), vec2(0)}, {vec2(1), vec2(2), vec2(3)}, {vec2(0), vec2(std::nanf("")), vec2(0, 1)}}) {
        test.triangles = {};
        for (int k = 0; k < 3; ++k) test.vertex({k == 1 ? 9.0f : -3.0f, k == 2 ? 9.0f : -3.0f, 0}, n, uv[size_t(k)]);
        test.triangles.triangles.push_back({0, 1, 2, 0});
        test.look({0, 0, 3}, vec3(0));
        for (const uvec2& normals : run(test, 2, 2).normals) EXPECT_NEAR(glm::length(unpack_direction(normals.x) - n), 0, 1e-3);
    }
}

// A pane of alpha 1/4 in front of another and of the sky: a quarter of the pixels, and 3/16.
TEST_F(GBufferTest, blended_panes_are_there_for_their_share_of_pixels) {
    TestScene test;
    for (int i = 0; i < 2; ++i) {
        scenes::Material& m = test.scene.materials[test.material(vec3(i == 0, i == 1, 0))];
        m.alpha = scenes::Material::Alpha::blend, m.base_color.a = 0.25f;
        test.quad({-9, -9, -float(i)}, {18, 0, 0}, {0, 18, 0}, uint32_t(i));
    }
    test.look({0, 0, 3}, vec3(0));
    const auto got = run(test, 256, 256);
    size_t first = 0, second = 0;
    for (const vec4& albedo : got.albedo) first += albedo.x > 0, second += albedo.y > 0;
    EXPECT_NEAR(first / 65536.0, 0.25, 0.002);
    EXPECT_NEAR(second / 65536.0, 3 / 16.0, 0.004);
}

TEST_F(GBufferTest, every_size_of_image) {
    TestScene test;
    materials(test);
    test.soup(60, 3, random);
    test.look({0, 0, 6}, vec3(0));
    for (const auto& [w, h] : {std::pair{1u, 1u}, {63u, 1u}, {64u, 1u}, {65u, 1u}, {1u, 65u}, {9u, 7u}})
        EXPECT_LE(differing(test, run(test, w, h), w, h, 6), 1u) << w << " x " << h;
}

TEST_F(GBufferTest, row_0_is_the_top_and_column_0_the_left) {
    TestScene test;
    const uint32_t red = test.material({1, 0, 0}), green = test.material({0, 1, 0}), blue = test.material({0, 0, 1});
    test.quad({-1, 0, 0}, {1, 0, 0}, {0, 1, 0}, red);     // upper left
    test.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, green);    // upper right
    test.quad({-1, -1, 0}, {2, 0, 0}, {0, 1, 0}, blue);   // below
    test.scene.cameras = {{"", mat4(1), 1.5707963f}};
    test.scene.cameras[0].to_world[3] = vec4(0, 0, 1, 1);
    // Scale in a camera's node does not change what it sees.
    for (float scale : {1.0f, 20.0f}) {
        for (int axis = 0; axis < 3; ++axis) test.scene.cameras[0].to_world[axis] = scale * mat4(1)[axis];
        const auto got = run(test, 2, 2);
        EXPECT_EQ(vec3(got.albedo[0]), vec3(1, 0, 0));
        EXPECT_EQ(vec3(got.albedo[1]), vec3(0, 1, 0));
        EXPECT_EQ(vec3(got.albedo[2]), vec3(0, 0, 1));
        EXPECT_EQ(vec3(got.albedo[3]), vec3(0, 0, 1));
        EXPECT_NEAR(got.positions[0].x, -0.5, 1e-6);
        EXPECT_NEAR(got.positions[0].y, 0.5, 1e-6);
        EXPECT_NEAR(got.positions[0].w, 1, 1e-6);
    }
}

TEST_F(GBufferTest, normals_face_the_camera_and_backs_do_not_shine) {
    TestScene test;
    const uint32_t single = test.material({0.5f, 0.5f, 0.5f}, {1, 1, 1}), doubled = test.material({0.5f, 0.5f, 0.5f}, {1, 1, 1}, true);
    test.quad({-2, -1, 0}, {1, 0, 0}, {0, 2, 0}, single);   // front
    test.quad({-1, -1, 0}, {0, 2, 0}, {1, 0, 0}, single);   // back
    test.quad({0, -1, 0}, {1, 0, 0}, {0, 2, 0}, doubled);   // front
    test.quad({1, -1, 0}, {0, 2, 0}, {1, 0, 0}, doubled);   // back
    test.scene.cameras = {{"", mat4(1), 0.1f}};
    test.scene.cameras[0].to_world[3] = vec4(0, 0, 10, 1);
    const auto got = run(test, 4, 1);
    for (int i = 0; i < 4; ++i) {
        EXPECT_EQ(unpack_direction(got.normals[i].x), vec3(0, 0, 1)) << i;
        EXPECT_EQ(unpack_direction(got.normals[i].y), vec3(0, 0, 1)) << i;
        EXPECT_EQ(vec3(got.albedo[i]), vec3(0.5f)) << i;
        EXPECT_EQ(vec3(got.emitted[i]), vec3(i == 1 ? 0.0f : 1.0f)) << i;
    }
}

TEST_F(GBufferTest, far_away_and_at_any_scale) {
    for (const auto& [scale, offset] : {std::pair{1e-6f, 0.0f}, {1e6f, 0.0f}, {1.0f, 1e4f}}) {
        TestScene test;
        materials(test);
        test.soup(100, 3, random);
        for (vec3& p : test.triangles.positions) p = scale * p + vec3(offset);
        test.look(scale * vec3(0, 0, 8) + vec3(offset), vec3(offset));
        const auto got = run(test, 40, 30);
        const double reach = std::abs(offset) + 8 * scale;
        // Far from the origin the vertices themselves are coarse; only positions and finiteness are asked there.
        if (offset == 0) { EXPECT_LE(differing(test, got, 40, 30, reach), 40u * 30 / 100) << scale; }
        for (const auto* values : {&got.positions, &got.albedo, &got.emitted})
            for (const vec4& v : *values) ASSERT_TRUE(std::isfinite(v.x + v.y + v.z + v.w));
    }
}

TEST_F(GBufferTest, hard_scenes_are_finite) {
    TestScene nothing;
    nothing.material({1, 1, 1});
    nothing.look({0, 0, 1}, vec3(0));
    for (const vec4& p : run(nothing, 8, 8).positions) EXPECT_EQ(p, vec4(0));

    TestScene test;  // zero area, needles, a plane edge-on through the eye, zero normals, absurd texture coordinates
    materials(test);
    const uint32_t v = test.vertex(vec3(0), vec3(0), vec2(1e30f, -std::numeric_limits<float>::infinity()));
    const uint32_t a = test.vertex({1, 0, 0}, vec3(0), vec2(std::nanf(""))), b = test.vertex({0, 1, 1e-20f}, vec3(0));
    for (uint32_t m = 0; m < test.scene.materials.size(); ++m) {
        test.triangles.triangles.emplace_back(v, v, v, m);
        test.triangles.triangles.emplace_back(v, a, a, m);
        test.triangles.triangles.emplace_back(v, a, b, m);
        test.quad({-3, 0.02f * float(m), -1}, {6, 0, 0}, {0, 0, 6}, m);
        test.quad({-3, -0.4f, float(m) - 3}, {6, 0, 0}, {0, 1e-6f, 0}, m);
    }
    test.look({0, 0, 3}, vec3(0));
    const auto got = run(test, 33, 33);
    size_t seen = 0;
    for (const auto* values : {&got.positions, &got.albedo, &got.emitted})
        for (const vec4& p : *values) ASSERT_TRUE(std::isfinite(p.x + p.y + p.z + p.w));
    for (const vec4& p : got.positions) seen += p.w > 0;
    EXPECT_GT(seen, 0u);
}

TEST_F(GBufferTest, comparator_sees_a_wrong_pixel) {
    TestScene test;
    materials(test);
    test.quad({-3, -3, 0}, {6, 0, 0}, {0, 6, 0}, 3);
    test.look({0, 0, 3}, vec3(0));
    auto got = run(test, 4, 4);
    ASSERT_EQ(differing(test, got, 4, 4, 3), 0u);
    got.albedo[5].y += 0.01f;
    got.normals[6].x = pack_direction({0, 1, 0});
    EXPECT_EQ(differing(test, got, 4, 4, 3), 2u);
}

}  // namespace
}  // namespace myriad::passes
