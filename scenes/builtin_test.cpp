// The built-in scenes: deterministic, clean, closed, and what their description promises.
#include "scenes/scene.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "scenes/builtin/kit.hpp"
#include "scenes/builtin_kit.hpp"

namespace myriad::scenes {
namespace {

using glm::vec3;

struct Atrium : BuiltinTest<Atrium> {
    static constexpr const char* source = "builtin:atrium";
};

TEST(Kit, RandomIsFixed) {
    kit::Random a(1), b(1), c(2);
    const uint32_t first = a.bits();
    EXPECT_EQ(first, b.bits());
    EXPECT_NE(first, c.bits());
    double sum = 0;
    for (int i = 0; i < 10000; ++i) {
        const float x = a.real();
        ASSERT_TRUE(x >= 0 && x < 1);
        sum += x;
    }
    EXPECT_NEAR(sum / 10000, 0.5, 0.02);
}

TEST(Kit, SolidsAreClosedAndFaceOutward) {
    Primitive box, lathe, ring;
    kit::box(box, {-1, 0, 2}, {1, 3, 2.5f}, 0.4f);
    EXPECT_EQ(open_edges(box), 0u);
    EXPECT_NEAR(signed_volume(box), 2 * 3 * 0.5, 1e-3);
    kit::lathe(lathe, {{0, 0}, {1, 0}, {1, 2}, {0, 2}}, 64);
    EXPECT_EQ(open_edges(lathe), 0u);
    EXPECT_NEAR(signed_volume(lathe), 2 * 3.14159, 0.02);
    kit::ring(ring, {{-1, 0}, {0, 0}, {0, 0.5f}, {-1, 0.5f}, {-1, 0}}, {4, 2}, 1);
    EXPECT_EQ(open_edges(ring), 0u);
    EXPECT_NEAR(signed_volume(ring), (10 * 6 - 8 * 4) * 0.5, 1e-3);  // around the rectangle: its projection is negative
    box.indices.resize(box.indices.size() - 3);
    EXPECT_EQ(open_edges(box), 3u);  // the check can fail
}

TEST(Kit, MirroredAppendKeepsTheFront) {
    Primitive box, mirrored;
    kit::box(box, {1, 1, 1}, {2, 3, 4}, 1);
    kit::append(mirrored, box, glm::mat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1));
    EXPECT_NEAR(signed_volume(mirrored), 6, 1e-4);
    for (size_t i = 0; i < mirrored.indices.size(); i += 3) {
        const auto at = [&](size_t k) { return mirrored.positions[mirrored.indices[i + k]]; };
        EXPECT_GT(glm::dot(glm::cross(at(1) - at(0), at(2) - at(0)), mirrored.normals[mirrored.indices[i]]), 0);
    }
}

TEST(Kit, SrgbIsTheFormulaRounded) {
    for (int i = -100; i <= 100100; ++i) {
        const double x = std::clamp(double(float(i) * 1e-5f), 0.0, 1.0), encoded = 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055);
        const double code = kit::srgb8(float(i) * 1e-5f);
        ASSERT_LE(std::abs(code - encoded), 0.501) << x;
    }
}

TEST(Builtin, EqualSeedsEqualScenes) {
    for (const char* source : {"builtin:atrium?detail=0.5", "builtin:cathedral?detail=0.25", "builtin:cornell", "builtin:hairball?strands=300", "builtin:particles?detail=0.25", "builtin:teatime?detail=0.25"})
        EXPECT_EQ(hash_of(source, 1), hash_of(source, 1)) << source;
    for (const char* source : {"builtin:atrium?detail=0.5", "builtin:cathedral?detail=0.25", "builtin:hairball?strands=300", "builtin:teatime?detail=0.25"})
        EXPECT_NE(hash_of(source, 1), hash_of(source, 2)) << source;
}

TEST(Builtin, TrianglesAreClean) {
    for (const char* source : {"builtin:atrium", "builtin:atrium?detail=0.25", "builtin:cathedral", "builtin:cathedral?detail=0.25", "builtin:teatime", "builtin:teatime?detail=0.25", "builtin:particles", "builtin:cornell",
                               "builtin:cornell?cells=1&light=point", "builtin:hairball?strands=20000", "builtin:hairball?strands=1&thickness=0.25"}) {
        Scene scene = load(source);
        const Triangles t = flatten(scene, Sharing::never);
        EXPECT_TRUE(scene.warnings.empty()) << source << ": " << scene.warnings[0];
        size_t degenerate = 0, unfit = 0, against = 0, out_of_range = 0;
        for (size_t i = 0; i < t.positions.size(); ++i)
            unfit += !(std::abs(glm::length(t.normals[i]) - 1) < 1e-4f) || !std::isfinite(t.positions[i].x + t.positions[i].y + t.positions[i].z);
        for (const auto& c : t.triangles) {
            const vec3 n = glm::cross(t.positions[c.y] - t.positions[c.x], t.positions[c.z] - t.positions[c.x]);
            degenerate += !(glm::length(n) > 1e-10f);
            out_of_range += c.w >= scene.materials.size();
            if (scene.materials[c.w].double_sided) continue;  // a sheet has no front to look away from
            for (int k = 0; k < 3; ++k) against += glm::dot(n, t.normals[c[k]]) < -1e-3f * glm::length(n);
        }
        EXPECT_EQ(degenerate, 0u) << source;
        EXPECT_EQ(unfit, 0u) << source;
        EXPECT_EQ(out_of_range, 0u) << source;
        EXPECT_LE(double(against), 1e-3 * double(t.triangles.size())) << source << ": vertex normals that look away from their face";
    }
}

TEST(Builtin, MaterialsArePhysical) {
    for (const char* source : {"builtin:atrium", "builtin:cathedral?detail=0.25", "builtin:cornell", "builtin:hairball?strands=10", "builtin:teatime?detail=0.25"}) {
        for (const auto& m : load(source).materials) {
            const float most = std::max({m.base_color.x, m.base_color.y, m.base_color.z});
            EXPECT_EQ(m.metallic, 0) << m.name;
            EXPECT_TRUE(m.base_color_texture.texture != none || (most >= 0.2f && most <= 0.8f)) << m.name;
        }
    }
}

TEST(Cornell, OptionsChooseTheLight) {
    const auto emissive = [](const Scene& scene) {
        return std::any_of(scene.materials.begin(), scene.materials.end(), [](const Material& m) { return m.emissive.x > 0; });
    };
    const Scene panel = load("builtin:cornell"), point = load("builtin:cornell?light=point");
    EXPECT_TRUE(panel.lights.empty());
    EXPECT_TRUE(emissive(panel));
    EXPECT_EQ(point.lights.size(), 1u);
    EXPECT_FALSE(emissive(point));
    EXPECT_EQ(panel.cameras.at(0).name, "front");
}

TEST_F(Atrium, IsAsBigAsItSays) {
    EXPECT_GE(triangles->triangles.size(), 100000u);
    EXPECT_LE(triangles->triangles.size(), 400000u);
    ASSERT_EQ(scene->lights.size(), 1u);
    EXPECT_EQ(scene->lights[0].type, Light::Type::directional);
    Scene coarse = load("builtin:atrium?detail=0.5"), fine = load("builtin:atrium?detail=2");
    EXPECT_LT(flatten(coarse, Sharing::never).triangles.size(), triangles->triangles.size() * 3 / 4);
    EXPECT_GT(flatten(fine, Sharing::never).triangles.size(), triangles->triangles.size() * 2);
}

// From every camera: whatever is seen is a surface of the scene, from its front. No void, no inside of a wall.
TEST_F(Atrium, CamerasSeeFrontsOnly) {
    std::set<std::string> names;
    for (const Camera& camera : scene->cameras) {
        names.insert(camera.name);
        const vec3 eye(camera.to_world[3]);
        EXPECT_TRUE(std::abs(eye.x) < 15.2f && std::abs(eye.z) < 7.7f && eye.y > 0 && eye.y < 10);
        const Seen seen = seen_from(*scene, *triangles, camera);
        EXPECT_EQ(seen.nothing, 0u) << camera.name;
        EXPECT_EQ(seen.backs, 0u) << camera.name;
    }
    EXPECT_EQ(names, (std::set<std::string>{"court", "gallery", "corner"}));
}

// From inside the galleries, away from the court and upwards, no ray reaches the sky, the outside, or the back of a face.
TEST_F(Atrium, GalleriesDoNotLeak) {
    const uint32_t sky = material_named(*scene, "sky");
    ASSERT_NE(sky, none);
    size_t escaped = 0, backs = 0;
    for (float sx : {-1.0f, 1.0f})
        for (float sz : {-1.0f, 1.0f})
            for (float y : {1.5f, 7.0f})
                for (const vec3 from : {vec3(sx * 13.9f, y, sz * 6.6f), vec3(sx * 5.3f, y, sz * 7.0f)})
                    for (int i = 0; i < 24; ++i) {
                        const float angle = float(i) * 2.399963f, up = (float(i) + 0.5f) / 24 * 1.6f - 0.6f, r = std::sqrt(1 - up * up);
                        // Folded outward: rays towards the court may leave through an arch.
                        const vec3 way(r * std::cos(angle), up, sz * r * std::abs(std::sin(angle)));
                        if (from.x * from.x > 144 && way.x * sx < 0) continue;
                        const size_t hit = first_hit(*triangles, from, way);
                        escaped += hit == none || triangles->triangles[hit].w == sky;
                        if (hit != none) backs += sees_back(*scene, *triangles, hit, way);
                    }
    EXPECT_EQ(escaped, 0u);
    EXPECT_EQ(backs, 0u);
    // The check can fail: straight up from the court there is no roof.
    const size_t up = first_hit(*triangles, {-4, 1, 2}, {0, 1, 0});
    EXPECT_TRUE(up == none || triangles->triangles[up].w == sky);
}

// The sun reaches part of the court's floor and of one arcade, and no back wall of the upper gallery.
TEST_F(Atrium, SunStrikesPartOfTheCourt) {
    const vec3 to_sun = -scene->lights[0].direction;
    const auto lit = [&](const vec3& at) { return first_hit(*triangles, at, to_sun) == none; };
    int floor_lit = 0, floor_dark = 0;
    for (float x = -11; x <= 11; x += 1.9f)
        for (float z = -3.6f; z <= 3.6f; z += 1.1f) (lit({x, 0.05f, z}) ? floor_lit : floor_dark)++;
    EXPECT_GE(floor_lit, 8);
    EXPECT_GE(floor_dark, 30);
    EXPECT_TRUE(lit({4.5f, 4.75f, -4.2f}));   // the sunny arcade
    EXPECT_FALSE(lit({4.5f, 4.75f, 4.2f}));   // the one opposite
    for (float x = -11; x <= 11; x += 2.3f) EXPECT_FALSE(lit({x, 7.5f, -7.6f})) << x;
}

}  // namespace
}  // namespace myriad::scenes
