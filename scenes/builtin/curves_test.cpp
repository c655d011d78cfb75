// The kit's curves: what they touch, and that what follows them is closed and faces the right way.
#include "scenes/builtin/curves.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/builtin_kit.hpp"

namespace myriad::scenes {
namespace {

using glm::vec2;
using glm::vec3;
using kit::pi;

// How far vertex normals are from being unit, and triangles whose vertex normals look to their back.
void expect_clean(const Primitive& p, const char* what) {
    ASSERT_EQ(p.positions.size(), p.normals.size()) << what;
    ASSERT_EQ(p.positions.size(), p.texcoords.size()) << what;
    for (const vec3& n : p.normals) ASSERT_NEAR(glm::length(n), 1, 1e-4) << what;
    size_t against = 0;
    for (size_t i = 0; i < p.indices.size(); i += 3) {
        const auto at = [&](size_t k) { return p.positions[p.indices[i + k]]; };
        const vec3 n = glm::cross(at(1) - at(0), at(2) - at(0));
        for (size_t k = 0; k < 3; ++k) against += glm::dot(n, p.normals[p.indices[i + k]]) < -1e-3f * glm::length(n);
    }
    EXPECT_EQ(against, 0u) << what << ": vertex normals that look away from their face";
}

TEST(Curves, SplinePassesThroughItsPointsAndTurnsAtDoubledOnes) {
    const std::vector<vec2> points = {{0, 0}, {1, 2}, {3, 3}, {3, 3}, {4, 0}};
    const auto curve = kit::spline(points, 5);
    for (const vec2& p : points) EXPECT_TRUE(std::any_of(curve.begin(), curve.end(), [&](vec2 q) { return q == p; }));
    for (size_t i = 1; i < curve.size(); ++i) EXPECT_GT(glm::length(curve[i] - curve[i - 1]), 0);  // no point twice
    EXPECT_EQ(curve.size(), 1u + 5 + 5 + 1);  // two spans of a curve, one straight
    EXPECT_EQ(curve.back(), points.back());
    // Straight points stay straight.
    for (const vec3& p : kit::spline<vec3>({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, 4)) EXPECT_NEAR(p.x, p.z, 1e-6);
}

TEST(Curves, BezierEndsAtItsEnds) {
    const std::array<vec2, 4> p = {vec2(0, 0), vec2(0, 1), vec2(1, 1), vec2(1, 0)};
    EXPECT_EQ(kit::bezier(p, 0), p[0]);
    EXPECT_EQ(kit::bezier(p, 1), p[3]);
    EXPECT_NEAR(kit::bezier(p, 0.5f).y, 0.75f, 1e-6);
}

TEST(Curves, TubesAreClosedWhateverTheirEnds) {
    std::vector<vec3> helix;
    for (int i = 0; i <= 40; ++i) helix.push_back({std::cos(0.3f * float(i)), 0.05f * float(i), std::sin(0.3f * float(i))});
    for (bool pointed : {false, true}) {
        std::vector<float> radii(helix.size(), 0.1f);
        if (pointed) radii.front() = radii.back() = 0;
        Primitive tube;
        kit::tube(tube, helix, radii, 32);
        EXPECT_EQ(open_edges(tube), 0u);
        const double length = 40 * glm::length(helix[1] - helix[0]);
        EXPECT_NEAR(signed_volume(tube), pi * 0.01 * (length - (pointed ? 4 * length / 120 : 0)), 0.02 * pi * 0.01 * length);
        expect_clean(tube, "tube");
        tube.indices.resize(tube.indices.size() - 3);
        EXPECT_GT(open_edges(tube), 0u);  // the check can fail
    }
}

TEST(Curves, FramesDoNotTwist) {
    std::vector<vec3> circle;
    for (int i = 0; i <= 64; ++i) circle.push_back({std::cos(pi * float(i) / 32), std::sin(pi * float(i) / 32), 0});
    for (const kit::Frame& f : kit::frames_along(circle, {0, 0, 1})) {
        EXPECT_NEAR(f.up.z, 1, 1e-4);  // in a plane, what stands on it keeps standing
        EXPECT_NEAR(glm::dot(f.across, f.up), 0, 1e-5);
    }
}

TEST(Curves, LoftsAreClosedSolids) {
    std::vector<vec3> line = {{0, 0, 0}, {0, 1, 0}, {0, 2, 0}};
    Primitive block, lens;
    const kit::Profile square = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
    kit::loft(block, square, kit::frames_along(line, {0, 0, 1}), {vec2(1), vec2(1), vec2(1)}, true);
    EXPECT_EQ(open_edges(block), 0u);
    EXPECT_NEAR(signed_volume(block), 8, 1e-4);
    expect_clean(block, "block");
    kit::loft(lens, kit::ellipse(1, 0.5f, 24), kit::frames_along(line, {0, 0, 1}), {vec2(0), vec2(1), vec2(0)}, false);  // two elliptic cones
    EXPECT_EQ(open_edges(lens), 0u);
    EXPECT_NEAR(signed_volume(lens), 2 * pi * 0.5 / 3, 0.03);
    expect_clean(lens, "lens");
}

TEST(Curves, PointedArchIsTwoArcs) {
    for (const kit::Arch arch : {kit::Arch{2, 2}, kit::Arch{2, 3}, kit::Arch{1, 4}}) {
        EXPECT_EQ(arch.at(0), vec2(-arch.half, 0));
        EXPECT_EQ(arch.at(0.5f), vec2(0, arch.rise));
        EXPECT_EQ(arch.at(1), vec2(arch.half, 0));
        for (int i = 0; i <= 20; ++i) {
            const vec2 p = arch.at(float(i) / 20);
            const vec2 centre(p.x <= 0 ? arch.centre() : -arch.centre(), 0);
            EXPECT_NEAR(glm::length(p - centre), arch.radius(), 1e-4);
            EXPECT_NEAR(arch.height(p.x), p.y, 1e-2);
        }
    }
}

TEST(Curves, ArchMouldingIsMitredAndFacesOut) {
    // A round bar over an arch and down its jambs: closed but for its two feet.
    Primitive bar;
    kit::arch_moulding(bar, kit::ellipse(0.1f, 0.1f, 12), {1, 1.6f}, 2, 40);
    EXPECT_EQ(open_edges(bar), 2u * 12);
    EXPECT_GT(signed_volume(bar), 0);
    expect_clean(bar, "bar");
    for (size_t i = 0; i < bar.positions.size(); ++i) EXPECT_LT(bar.positions[i].y, 1.6f + 0.2f);
}

TEST(Curves, OpeningPanelIsOpenWhereItSays) {
    const kit::Opening window{{0.6f, 1.0f}, 0.5f, 1.5f};
    Primitive panel;
    kit::opening_panel(panel, 3, 4, window, 0.4f, 16);
    expect_clean(panel, "panel");
    const auto blocked = [&](float x, float y) {
        Scene scene;
        scene.meshes.push_back({"panel", {panel}});
        scene.instances.push_back({0, glm::mat4(1)});
        scene.materials.resize(1);
        return first_hit(flatten(scene, Sharing::never), {x, y, 5}, {0, 0, -1}) != none;
    };
    EXPECT_FALSE(blocked(0.01f, 1.0f));
    EXPECT_FALSE(blocked(0.01f, 2.4f));   // below the apex
    EXPECT_TRUE(blocked(0.01f, 2.55f));   // above it
    EXPECT_TRUE(blocked(0.55f, 2.2f));    // beside the arch
    EXPECT_TRUE(blocked(0.01f, 0.45f));   // below the sill
    EXPECT_TRUE(blocked(1.0f, 1.0f));
}

TEST(Curves, VaultsAreSeenFromBelow) {
    Primitive rectangle, side;
    const kit::Arch arch{3, 4};
    kit::ribbed_vault(rectangle, {2, 3}, arch, 12);
    kit::polygon_vault(side, {-1, 0, -2}, {1, 0, -2}, {0, 0, 1}, arch, 12);
    float highest = 0;
    for (const vec3& p : rectangle.positions) {
        EXPECT_TRUE(std::abs(p.x) < 2.0001f && std::abs(p.z) < 3.0001f && p.y > -1e-3f);
        highest = std::max(highest, p.y);
        if (std::abs(std::abs(p.z) - 3) < 1e-5f) {
            EXPECT_NEAR(p.y, arch.height(1.5f * p.x), 1e-2);  // the wall arch, stretched
        }
        if (std::abs(std::abs(p.x) - 2) < 1e-5f) {
            EXPECT_NEAR(p.y, arch.height(p.z), 1e-2);
        }
    }
    EXPECT_NEAR(highest, 4, 1e-5);
    for (const Primitive* web : {&rectangle, &side}) {
        expect_clean(*web, "web");
        for (const vec3& n : web->normals) EXPECT_LE(n.y, 1e-3f);
    }
    const auto rib = kit::rib_curve({2, 0, 3}, {0, 0, 0}, arch, 9);
    EXPECT_EQ(rib.front(), vec3(2, 0, 3));
    EXPECT_NEAR(glm::length(rib.back() - vec3(0, 4, 0)), 0, 1e-5);
}

}  // namespace
}  // namespace myriad::scenes
