// The formulae of pinhole.h against geometry in doubles, on the host: the kernels compile the same text.
#include "compute/views/pinhole.h"

#include <random>

#include <gtest/gtest.h>

namespace myriad {
namespace {

using glm::dvec2, glm::dvec3;

struct Camera {
    dvec3 eye, right, up, forward;
    double tan_y;
    uint width, height;
    View view(float margin = 0) const { return pinhole_view(vec3(eye), vec3(right), vec3(tan_y * up), vec3(forward), margin); }
    Pinhole pinhole(float margin = 0) const { return pinhole_of(view(margin), pinhole_size(width, height)); }
    double tan_x() const { return tan_y * width / height; }
    // On the image, in pixels from its middle; z > 0.
    dvec2 project(const dvec3& p) const {
        const dvec3 d = p - eye;
        return dvec2(glm::dot(d, right), glm::dot(d, up)) / glm::dot(d, forward) * (height / (2 * tan_y));
    }
};

class PinholeTest : public ::testing::Test {
protected:
    double uniform(double lo = -1, double hi = 1) { return std::uniform_real_distribution<double>(lo, hi)(random); }
    dvec3 point() { return {uniform(), uniform(), uniform()}; }
    dvec3 direction() {
        const dvec3 d = point();
        return glm::dot(d, d) > 1e-3 ? glm::normalize(d) : dvec3(0, 0, 1);
    }
    Camera camera() {
        Camera c;
        c.eye = dvec3(vec3(point()));
        c.forward = random() % 4 ? direction() : dvec3(random() % 2, 0, 0) + dvec3(0, 0, 1e-3 * uniform());  // along the axes, or nearly
        if (glm::dot(c.forward, c.forward) < 0.5) c.forward = dvec3(0, 0, random() % 2 ? 1 : -1);             // turned by half a circle, or not at all
        c.forward = glm::normalize(c.forward);
        c.right = glm::normalize(glm::cross(c.forward, random() % 3 ? dvec3(0, 1, 0) : direction()));
        c.up = glm::cross(c.right, c.forward);
        c.tan_y = std::tan(uniform(0.005, 1.4));
        c.width = 1 + random() % 2000, c.height = 1 + random() % 2000;
        return c;
    }

    std::mt19937 random{7};
};

TEST_F(PinholeTest, a_view_keeps_its_camera) {
    for (int i = 0; i < 20000; ++i) {
        const Camera c = camera();
        const View v = c.view();
        ASSERT_TRUE(is_pinhole(v));
        const Pinhole p = c.pinhole(0.25f);
        ASSERT_LT(glm::length(dvec3(p.right) - c.right) + glm::length(dvec3(p.up) - c.up) + glm::length(dvec3(p.forward) - c.forward), 2e-6);
        ASSERT_NEAR(p.tan_y / c.tan_y, 1, 1e-6);
        ASSERT_NEAR(p.tan_x / c.tan_x(), 1, 1e-6);
        ASSERT_NEAR(p.pixel * c.height / (2 * c.tan_y), 1, 1e-6);
        ASSERT_NEAR(p.margin, 0.25f, 1e-6);
    }
    EXPECT_FALSE(is_pinhole(view_of_nothing()));
    EXPECT_FALSE(is_pinhole({vec3(0), 1, vec3(1, 0, 0), 0})) << "a frustum that is a line";
}

// What is culled has no point in the picture; what is not culled and stands well within the sides' planes has one.
TEST_F(PinholeTest, culling_is_conservative) {
    size_t culled = 0, seen = 0;
    for (int i = 0; i < 20000; ++i) {
        const Camera c = camera();
        const dvec3 center = dvec3(vec3(c.eye + uniform(0, 3) * direction()));
        const double radius = float(std::exp(uniform(-6, 1)));
        const float margin = i % 2 ? 0.0f : 0.1f;
        const bool outside = pinhole_outside(c.pinhole(margin), vec3(center) - vec3(c.eye), float(radius));
        ++(outside ? culled : seen);
        for (int k = 0; k < 50 && outside; ++k) {
            const dvec3 p = center + (radius + margin) * 0.9999 * (k < 25 ? direction() : std::cbrt(uniform(0, 1)) * direction());
            const dvec2 at = c.project(p);
            ASSERT_FALSE(glm::dot(p - c.eye, c.forward) > 1e-6 && std::abs(at.x) < 0.5 * c.width && std::abs(at.y) < 0.5 * c.height);
        }
    }
    EXPECT_TRUE(culled > 5000 && seen > 5000) << culled << " " << seen;
}

// The larger diameter of the outline, against points of the sphere as they are projected.
TEST_F(PinholeTest, diameters_are_exact) {
    int tried = 0;
    for (int i = 0; i < 3000; ++i) {
        const Camera c = camera();
        const dvec3 center = dvec3(vec3(c.eye + uniform(0, 3) * direction()));
        const dvec3 d = center - c.eye;
        const double radius = float(std::exp(uniform(-6, 0))), z = glm::dot(d, c.forward), length2 = glm::dot(d, d);
        const float found = pinhole_diameter(c.pinhole(), vec3(center) - vec3(c.eye), float(radius));
        if (z <= radius * 0.999) { ASSERT_TRUE(std::isinf(found)); }
        if (z <= radius * 1.05) continue;
        ++tried;
        // The outline: a circle of the sphere, seen from the eye.
        const dvec3 axis = d / std::sqrt(length2), across = glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.9 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
        const dvec3 along = glm::cross(axis, across), middle = c.eye + axis * (length2 - radius * radius) / std::sqrt(length2);
        const double ring = radius * std::sqrt(1 - radius * radius / length2);
        std::vector<dvec2> outline;
        for (int k = 0; k < 256; ++k) outline.push_back(c.project(middle + ring * (std::cos(k * 0.02454369) * across + std::sin(k * 0.02454369) * along)));
        double diameter = 0;
        for (const dvec2& a : outline)
            for (const dvec2& b : outline) diameter = std::max(diameter, glm::length(a - b));
        ASSERT_GT(found, diameter * 0.9999);
        ASSERT_LT(found, diameter * 1.02) << "points of the outline are a step apart";
    }
    EXPECT_GT(tried, 800);
}

}  // namespace
}  // namespace myriad
