// The cathedral: big enough, light-tight, and sunlit where it should be.
#include <set>

#include <gtest/gtest.h>

#include "engine/error.hpp"
#include "scenes/builtin/cathedral_parts.hpp"
#include "scenes/builtin_kit.hpp"

namespace myriad::scenes {
namespace {

using glm::vec3;

struct Cathedral : BuiltinTest<Cathedral> {
    static constexpr const char* source = "builtin:cathedral?detail=0.5";
    static bool emits(size_t triangle) { return scene->materials[triangles->triangles[triangle].w].emissive != vec3(0); }
};

TEST_F(Cathedral, DetailScalesIt) {
    Scene whole = load("builtin:cathedral"), coarse = load("builtin:cathedral?detail=0.25");
    const size_t count = flatten(whole, Sharing::never).triangles.size();
    EXPECT_GE(count, 500000u);
    EXPECT_LE(count, 1000000u);
    EXPECT_LT(triangles->triangles.size(), count * 3 / 5);
    EXPECT_LT(flatten(coarse, Sharing::never).triangles.size(), triangles->triangles.size());
    for (const char* source : {"builtin:cathedral?detail=0.2", "builtin:cathedral?detail=5", "builtin:cathedral?detail=", "builtin:cathedral?fine=1"})
        EXPECT_THROW(load(source), InputError) << source;
}

TEST_F(Cathedral, CamerasSeeFrontsOnly) {
    std::set<std::string> names;
    for (const Camera& camera : scene->cameras) {
        names.insert(camera.name);
        const Seen seen = seen_from(*scene, *triangles, camera);
        EXPECT_LE(seen.nothing, 1u) << camera.name;  // the sky, between louvres
        EXPECT_EQ(seen.backs, 0u) << camera.name;
    }
    EXPECT_EQ(names, (std::set<std::string>{"nave", "rose", "aisle", "vault"}));
}

// From anywhere inside no ray gets out, except through the windows of the south.
TEST_F(Cathedral, DoesNotLeak) {
    size_t out = 0, backs = 0;
    const std::vector<vec3> places = {{2.6f, 3, 0.3f}, {13.1f, 14, -1}, {27, 9, 1.2f}, {31.5f, 12, 0.2f}, {7.3f, 3, -7.4f}, {22.2f, 6, -7.2f}, {17.4f, 4, 7.3f}, {12.4f, 10, -4.7f}};
    for (const vec3& from : places)
        for (int i = 0; i < 60; ++i) {
            const float y = 1 - (2 * float(i) + 1) / 60, r = std::sqrt(1 - y * y), angle = 2.399963f * float(i);
            const vec3 way(r * std::cos(angle), y, -r * std::abs(std::sin(angle)));  // not to the south
            const size_t hit = first_hit(*triangles, from, way);
            out += hit == none;
            if (hit != none) backs += sees_back(*scene, *triangles, hit, way);
        }
    EXPECT_EQ(out, 0u);
    EXPECT_EQ(backs, 0u);
    EXPECT_EQ(first_hit(*triangles, {2, 25, 0}, {0, 1, 0}), size_t(none));  // the check can fail
}

// Each sun shines through its window in full: louvres are in nobody's way, tracery only in part, and it lights stone inside.
TEST_F(Cathedral, SunGetsThroughTheLouvres) {
    ASSERT_EQ(scene->lights.size(), 2u * cathedral::bays);
    for (const Light& sun : scene->lights) {
        EXPECT_EQ(sun.type, Light::Type::spot);
        const vec3 right = glm::normalize(glm::cross(sun.direction, vec3(0, 1, 0))), up = glm::cross(right, sun.direction);
        int through = 0, glass = 0;
        for (int j = -4; j <= 4; ++j)
            for (int i = -2; i <= 2; ++i) {
                const vec3 way = glm::normalize(sun.direction * 30.0f + right * (0.4f * float(i) + 0.13f) + up * (0.35f * float(j) + 0.03f));
                const size_t hit = first_hit(*triangles, sun.position, way);
                ASSERT_NE(hit, size_t(none));
                glass += emits(hit);
                through += triangles->positions[triangles->triangles[hit].x].z < (sun.position.y > 30 ? 4.2f : 9.2f);
            }
        EXPECT_EQ(glass, 0);
        EXPECT_GE(through, 18) << sun.position.x << " " << sun.position.y;
    }
}

// Seen from the floor of the church, the same louvres are closed.
TEST_F(Cathedral, LouvresLookLikeGlass) {
    int glass = 0, sky = 0;
    for (float x : {7.5f, 12.5f, 17.5f})
        for (float y : {3.1f, 3.9f, 4.7f, 5.1f})
            for (float side : {-0.45f, 0.5f}) {
                const vec3 eye(x - 1.5f, 1.7f, 6.0f);
                const size_t hit = first_hit(*triangles, eye, glm::normalize(vec3(x + side, y, cathedral::outer) - eye));
                if (hit == none) ++sky;
                else glass += emits(hit);
            }
    EXPECT_EQ(sky, 0);
    EXPECT_GE(glass, 16);
}

TEST(CathedralParts, TraceryTouchesItsArches) {
    using namespace cathedral;
    for (const Opening& o : {clerestory_window, aisle_window, apse_window}) {
        const Tracery t = tracery_of(o);
        const float y = t.centre.y - o.spring;
        EXPECT_NEAR(std::hypot(o.arch.centre(), y) + t.radius, o.arch.radius(), 1e-3);                                    // inside the window's arch
        EXPECT_NEAR(std::hypot(t.light_x + t.light.centre(), y), t.light.radius() + t.radius, 1e-3);                     // outside the lights' arches
        EXPECT_GT(t.radius, 0.2f * o.arch.half);
    }
}

}  // namespace
}  // namespace myriad::scenes
