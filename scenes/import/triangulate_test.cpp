// Every polygon becomes count - 2 triangles; a simple one keeps its area, and no triangle is turned over.
#include "scenes/import/triangulate.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "scenes/builtin/kit.hpp"

namespace myriad::scenes::importing {
namespace {

using glm::dvec3;
using glm::vec3;

struct Cut {
    size_t triangles = 0, turned = 0;
    double area = 0;  // sum of the sizes, which overlaps make larger than the polygon
};

Cut cut(const std::vector<vec3>& corners) {
    std::vector<uint32_t> indices;
    triangulate(corners, indices);
    Cut out{indices.size() / 3};
    dvec3 normal(0);
    for (size_t i = 0; i < corners.size(); ++i)
        normal += glm::cross(dvec3(corners[i]) - dvec3(corners[0]), dvec3(corners[(i + 1) % corners.size()]) - dvec3(corners[0]));
    for (size_t t = 0; t < indices.size(); t += 3) {
        const dvec3 a(corners.at(indices[t])), b(corners.at(indices[t + 1])), c(corners.at(indices[t + 2]));
        const dvec3 n = glm::cross(b - a, c - a);
        out.area += glm::length(n) / 2;
        out.turned += glm::dot(n, normal) < -1e-9 * glm::length(n) * glm::length(normal);
    }
    return out;
}

// A star around the origin: simple, concave at every second corner or anywhere; in a plane that stands oblique, turned over
// where `over` says so.
std::vector<vec3> star(kit::Random& random, size_t count, bool over, double& area) {
    std::vector<glm::dvec2> flat;
    area = 0;
    for (size_t i = 0; i < count; ++i) {
        const double angle = 6.283185307 * double(i) / double(count), radius = random.real(0.2f, 1);
        flat.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    for (size_t i = 0; i < count; ++i) {
        const glm::dvec2 &a = flat[i], &b = flat[(i + 1) % count];
        area += (a.x * b.y - a.y * b.x) / 2;
    }
    if (over) std::ranges::reverse(flat);
    const dvec3 u = glm::normalize(dvec3(random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)));
    const dvec3 v = glm::normalize(glm::cross(u, dvec3(0.3, 1, 0.2)));
    std::vector<vec3> out;
    for (const auto& p : flat) out.emplace_back(u * p.x + v * p.y + dvec3(5, 6, 7));
    return out;
}

TEST(Triangulate, Stars) {
    kit::Random random(11);
    for (int i = 0; i < 300; ++i) {
        double area = 0;
        const size_t count = 3 + random.below(40);
        const std::vector<vec3> corners = star(random, count, i % 2, area);
        const Cut out = cut(corners);
        EXPECT_EQ(out.triangles, count - 2);
        EXPECT_NEAR(out.area, area, 1e-5) << i << " of " << count;
        EXPECT_EQ(out.turned, 0u) << i;
    }
}

TEST(Triangulate, KnownShapes) {
    const std::vector<vec3> l = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
    EXPECT_EQ(cut(l).area, 3);
    const std::vector<vec3> arrow = {{0, 0, 0}, {2, 0, 2}, {1, 0, 0.5f}, {2, 0, -2}};  // a concave quadrilateral
    EXPECT_EQ(cut(arrow).turned, 0u);
    const std::vector<vec3> bridge = {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}, {0, 0, 0}, {1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}, {1, 1, 0}};
    EXPECT_NEAR(cut(bridge).area, 8, 1e-9);  // a square with a hole, joined by an edge that is gone along twice
    EXPECT_EQ(cut({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}}).area, 4);  // corners on straight edges
}

TEST(Triangulate, WhatIsNoPolygonEnds) {
    EXPECT_EQ(cut({}).triangles, 0u);
    EXPECT_EQ(cut({{0, 0, 0}, {1, 0, 0}}).triangles, 0u);
    EXPECT_EQ(cut(std::vector<vec3>(20, vec3(1))).triangles, 18u);                                                 // a point
    EXPECT_EQ(cut({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}).triangles, 2u);                                    // a line
    EXPECT_EQ(cut({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).triangles, 2u);                                    // a bow
    EXPECT_EQ(cut({{0, 0, 0}, {NAN, 1, 0}, {1, 0, 0}, {0, 1, 0}, {INFINITY, 1, 1}}).triangles, 3u);
    kit::Random random(2);
    std::vector<vec3> scribble;
    for (int i = 0; i < 2000; ++i) scribble.emplace_back(random.real(), random.real(), random.real());
    EXPECT_EQ(cut(scribble).triangles, 1998u);
    double area = 0;
    EXPECT_EQ(cut(star(random, 30000, false, area)).triangles, 29998u);  // not in quadratic time
}

}  // namespace
}  // namespace myriad::scenes::importing
