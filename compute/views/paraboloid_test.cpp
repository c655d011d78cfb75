// The formulae of paraboloid.h against geometry in doubles, on the host: the kernels compile the same text.
#include "compute/views/paraboloid.h"

#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace myriad {
namespace {

using glm::dvec2, glm::dvec3;

constexpr double pi = 3.14159265358979323846;
constexpr double ulp = 1.0 / (1 << 23);

class Paraboloid : public ::testing::Test {
protected:
    double uniform(double lo = -1, double hi = 1) { return std::uniform_real_distribution<double>(lo, hi)(random); }
    double log_uniform(double lo, double hi) { return std::exp(uniform(std::log(lo), std::log(hi))); }
    dvec3 direction() {
        for (;;)
            if (const dvec3 d(uniform(), uniform(), uniform()); glm::dot(d, d) > 0.01 && glm::dot(d, d) < 1) return glm::normalize(d);
    }
    // At angle alpha from +x.
    dvec3 at_angle(double alpha) {
        const double turn = uniform(0, 2 * pi);
        return {std::cos(alpha), std::sin(alpha) * std::cos(turn), std::sin(alpha) * std::sin(turn)};
    }
    // Angular places and sizes of spheres: any, and where alpha +- beta meets 0, pi / 2 and pi.
    struct Ball {
        vec3 d;
        float r;
    };
    Ball ball() {
        const double beta = random() % 4 ? uniform(0, pi / 2) : log_uniform(1e-5, 0.1), length = log_uniform(1e-3, 1e3);
        const double alphas[] = {0, beta, pi / 2 - beta, pi / 2, pi / 2 + beta, pi - beta, pi, uniform(0, pi), uniform(0, pi), uniform(0, pi)};
        return {vec3(length * at_angle(alphas[random() % 10])), float(length * std::sin(beta))};
    }
    View view(double phi, const dvec3& axis) { return {vec3(0), phi == pi / 2 ? 0 : float(std::cos(phi)), vec3(axis), phi == pi ? 0 : float(std::sin(phi))}; }

    std::mt19937 random{7};
};

// How far inside (positive) the sphere the line of sight along w passes, as a share of the distance; along rays that point away, how far behind.
double hit_margin(const dvec3& w, const dvec3& d, double r) {
    const double along = glm::dot(w, d), inside = r - glm::length(d);
    if (inside >= 0) return 1;
    return (r - (along > 0 ? glm::length(d - along * w) : glm::length(d))) / glm::length(d);
}

TEST_F(Paraboloid, directions_return) {
    std::vector<dvec3> all = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {-0.0, 1, 0}};
    for (double x : {0.0, 1e-8, -1e-8, 1e-30, -1e-30, 1e-3, -1e-3})
        for (int i = 0; i < 50; ++i) all.push_back(at_angle(pi / 2 - x)), all.back().x = x;
    for (int i = 0; i < 5000; ++i) all.push_back(direction());
    for (const dvec3& w : all)
        for (double length : {1e-18, 1e-6, 1.0, 3.7, 1e6, 1e18}) {
            const vec3 d(length * w);
            const vec2 uv = project(d);
            const vec3 back = unproject(half_of(d), uv);
            ASSERT_LE(glm::length(dvec2(uv)), 1 + 2 * ulp) << w.x << " " << w.y << " " << w.z;
            ASSERT_LE(glm::length(dvec3(back) - glm::normalize(dvec3(d))), 4 * ulp) << w.x << " " << w.y << " " << w.z << " * " << length;
        }
}

TEST_F(Paraboloid, points_return) {
    for (int i = 0; i < 5000; ++i) {
        const double turn = uniform(0, 2 * pi), reach = i % 10 ? std::sqrt(uniform(0, 1)) : 1;
        const vec2 uv(reach * std::cos(turn), reach * std::sin(turn));
        for (uint half : {half_front, half_back}) {
            const vec3 w = unproject(half, uv);
            ASSERT_NEAR(glm::length(dvec3(w)), 1, 4 * ulp);
            ASSERT_LE(glm::length(dvec2(project(w)) - dvec2(uv)), 8 * ulp);
            if (reach < 0.999) { ASSERT_EQ(half_of(w), half); }
        }
    }
}

// A line of sight meets the sphere if and only if its (u, v) lies in the disc.
TEST_F(Paraboloid, footprints_are_exact) {
    size_t tested = 0, whole = 0, absent = 0;
    for (int i = 0; i < 20000; ++i) {
        Ball b = ball();
        if (i % 50 == 0) b.r = float(glm::length(dvec3(b.d)) * uniform(1.0001, 3));  // the view inside
        const dvec3 d(b.d);
        const double length = glm::length(d), tangent = std::sqrt(std::max(length * length - double(b.r) * b.r, 0.0));
        for (uint half : {half_front, half_back}) {
            const Footprint f = footprint(half, b.d, b.r);
            const double axis = half == half_front ? d.x : -d.x;
            if (f.whole) {
                // It covers the direction opposite to the axis, or there is no outside.
                ++whole;
                ASSERT_GE(hit_margin({half == half_front ? -1 : 1, 0, 0}, d, b.r), -1e-5);
            }
            absent += !f.exists;
            // What the disc loses to rounding where squares or sums cancel.
            const double slack = f.whole ? 0 : 4 * ulp * (1 + glm::length(dvec2(f.center)) + f.radius) * (length / tangent) * (length / std::abs(axis + tangent));
            for (int k = 0; k < 20; ++k) {
                const double turn = uniform(0, 2 * pi), off = k % 2 ? 1 + uniform(-0.01, 0.01) : uniform(0, 2);
                dvec2 uv = k < 10 && !f.whole ? dvec2(f.center) + off * f.radius * dvec2(std::cos(turn), std::sin(turn)) : dvec2(uniform(), uniform());
                const double q = glm::dot(uv, uv);
                if (q > 2) continue;  // no texel is there
                const dvec3 w = dvec3((half == half_front ? 1 : -1) * (1 - q), 2.0 * uv.x, 2.0 * uv.y) / (1 + q);
                const double hit = hit_margin(w, d, b.r);
                if (!f.exists && q <= 1) { ASSERT_LE(hit, ulp) << "reaches the half all the same"; }
                if (f.whole || slack > 0.1) continue;
                const double in = f.radius - glm::length(uv - dvec2(f.center));
                if (std::abs(in) <= slack || std::abs(hit) < 1e-14) continue;
                ++tested;
                ASSERT_EQ(in > 0, hit > 0) << "d " << d.x << " " << d.y << " " << d.z << ", r " << b.r << ", half " << half << ": " << in << " " << hit;
            }
        }
    }
    EXPECT_TRUE(tested > 200000 && whole > 1000 && absent > 1000) << tested << " " << whole << " " << absent;
}

TEST_F(Paraboloid, criterion_is_the_diameter_of_the_disc) {
    for (int i = 0; i < 50000; ++i) {
        const Ball b = ball();
        const dvec3 d(b.d);
        const double length = glm::length(d), shallow = 1 - double(b.r) / length;
        if (shallow < 1e-5) continue;  // the next test
        const double alpha = std::atan2(std::hypot(d.y, d.z), std::abs(d.x)), beta = std::asin(double(b.r) / length);
        const double extent = std::tan((alpha + beta) / 2) - std::tan((alpha - beta) / 2);  // u, v: a texel is 2 / size
        ASSERT_NEAR(criterion(b.d, b.r, 64) / (64 * extent / 2), 1, 4 * ulp * (1 + 1 / shallow)) << alpha << " " << beta;
        if (shallow > 0.1) {
            const double c = 64 * extent / 2;
            ASSERT_TRUE(fits(b.d, b.r, 64, float(c * 1.0001)) && !fits(b.d, b.r, 64, float(c * 0.9999))) << "what cuts ask is this diameter";
        }
        const Footprint f = footprint(half_of(b.d), b.d, b.r);
        ASSERT_FALSE(f.whole);
        ASSERT_NEAR(64 * f.radius / criterion(b.d, b.r, 64), 1, 2 * ulp);
    }
}

TEST_F(Paraboloid, criterion_is_infinite_inside_and_on_the_sphere) {
    const float infinity = std::numeric_limits<float>::infinity();
    for (float r : {0.0f, 1e-20f, 1e-6f, 1.0f, 1e6f, 1e20f})
        for (float share : {0.0f, 0.5f, 1.0f}) EXPECT_EQ(criterion(vec3(0, share * r, 0), r, 32), infinity) << r << " " << share;
    EXPECT_EQ(criterion(vec3(0, 0, 1), 0, 32), 0);
}

// What makes cuts correct (spec, section 2), with the room that the tree leaves between a sphere and what it holds: a node that is not
// open holds none that is, in floating point, however small, far, or exactly touching.
TEST_F(Paraboloid, what_a_closed_sphere_holds_is_closed) {
    const double slack = 1 + 1.0 / 65536;
    size_t culled = 0, valid = 0, near_miss = 0;
    for (int i = 0; i < 400000; ++i) {
        const vec3 outer_center(direction() * log_uniform(1e-3, 1e3));
        const double share = i % 3 ? uniform(0, 1) : 1 - log_uniform(1e-9, 0.1);
        const double size = glm::length(dvec3(outer_center)) * log_uniform(1e-9, 2);
        const float inner_radius = i % 7 ? float(share * size) : 0;
        const View axis = view(i % 3 ? pi / 2 : uniform(0.01, pi), direction());
        // Anywhere in it, or where it comes nearest to the cone.
        const dvec3 off = i % 2 ? direction() : dvec3(axis.direction);  // towards the inside
        const vec3 inner_center(dvec3(outer_center) + off * (1 - share) * size);
        const double need = (glm::length(dvec3(inner_center) - dvec3(outer_center)) + inner_radius) * slack;
        const float outer_radius = std::nextafter(float(need), 1e30f);
        // Views anywhere, and such that the outer sphere just leaves their frustum, with the margin of its height and without.
        const uint heights[] = {1, 3, 9};
        const uint height = heights[random() % 3];
        View v = axis;
        v.position = vec3(i % 2 ? dvec3(0) : direction() * log_uniform(1e-3, 1e3));
        if (i % 5 == 0) {
            const vec3 d = outer_center - v.position;
            v.position -= vec3(double((i % 2 ? outer_radius : cull_radius(d, outer_radius, height)) - frustum_distance(v, d)) * -dvec3(v.direction) * (1 + uniform(-1, 1) * 1e-6));
        }
        const vec3 outer = outer_center - v.position, inner = inner_center - v.position;

        for (uint size_in_texels : {2u, 32u, 1024u})
            for (float epsilon : {0.5f, 2.0f, 30.0f, 1e3f}) {
                if (!fits(outer, outer_radius, size_in_texels, epsilon)) continue;
                ++valid;
                ASSERT_TRUE(fits(inner, inner_radius, size_in_texels, epsilon)) << i << " size " << size_in_texels << " epsilon " << epsilon;
            }
        near_miss += outside_frustum(v, outer, outer_radius) && !outside_frustum(v, inner, inner_radius);  // lost without the margin
        if (!outside_frustum(v, outer, cull_radius(outer, outer_radius, height))) continue;
        ++culled;
        ASSERT_TRUE(outside_frustum(v, inner, cull_radius(inner, inner_radius, height - 1))) << i << " height " << height;
    }
    EXPECT_TRUE(culled > 50000 && valid > 500000 && near_miss > 0) << culled << " " << valid << " " << near_miss;
}

// Signed distance of a point from a cone with its apex at the origin, by its definition: nearest points found by search.
double cone_distance(const dvec3& p, const dvec3& axis, double phi) {
    const double a = glm::dot(p, axis), b = glm::length(p - a * axis), theta = std::atan2(b, a);
    if (theta <= phi) return 0;
    // The side is a half-line in the plane of p and the axis.
    const double along = std::max(glm::length(p) * std::cos(theta - phi), 0.0);
    return std::hypot(a - along * std::cos(phi), b - along * std::sin(phi));
}

TEST_F(Paraboloid, culled_spheres_are_outside_the_cone) {
    size_t culled = 0, points = 0;
    for (int i = 0; i < 50000; ++i) {
        const double phi = i % 4 == 0 ? pi / 2 : i % 4 == 1 ? uniform(0, pi) : i % 4 == 2 ? log_uniform(1e-4, 1) : pi - log_uniform(1e-4, 1);
        const View v = view(phi, direction());
        const dvec3 axis = glm::normalize(dvec3(v.direction));
        const double length = log_uniform(1e-3, 1e3);
        // Anywhere, or near the axis before and behind, where squares cancel.
        const dvec3 d = (random() % 3 ? direction() : glm::normalize((random() % 2 ? 1.0 : -1.0) * axis + log_uniform(1e-6, 1) * direction())) * length;
        const vec3 df(d);
        const double exact = cone_distance(dvec3(df), axis, phi);
        const float r = random() % 3 == 0 ? float(exact * (1 + uniform(-1, 1) * log_uniform(1e-7, 0.1))) : float(length * log_uniform(1e-4, 3));
        if (r < 0) continue;
        const bool outside = outside_frustum(v, df, r);
        ASSERT_LE(outside ? r - exact : 0, 8 * ulp * length) << "phi " << phi << ", d/|d| . axis " << glm::dot(d, axis) / length << ", r " << r;
        ASSERT_LE(outside ? 0 : exact - r, 8 * ulp * length) << "kept for nothing: phi " << phi;  // the test is exact
        if (!outside || r > exact) continue;
        ++culled;
        for (int k = 0; k < 8; ++k, ++points) {
            const dvec3 p = dvec3(df) + direction() * double(r) * (k % 2 ? 1 : std::cbrt(uniform(0, 1)));
            ASSERT_GT(glm::length(p - glm::dot(p, axis) * axis) * std::cos(phi) - glm::dot(p, axis) * std::sin(phi), -8 * ulp * length);
        }
    }
    EXPECT_TRUE(culled > 5000 && points > 40000) << culled;
    for (int i = 0; i < 1000; ++i) {
        EXPECT_FALSE(outside_frustum(view(pi, direction()), vec3(direction()), 0)) << "omnidirectional views see everything";
        EXPECT_FALSE(outside_frustum(view(uniform(0, pi), direction()), vec3(direction()), 1.001f)) << "a view inside";
    }
}

TEST_F(Paraboloid, texels_are_in_range) {
    const float above = std::nextafter(1.0f, 2.0f), nan = std::numeric_limits<float>::quiet_NaN();
    for (uint size : {1u, 2u, 3u, 16u, 31u, 64u, 1023u, 1024u}) {
        for (float u : {-1.0f, 1.0f, -above, above, 0.0f, -0.0f, std::nextafter(1.0f, 0.0f), 1e-30f, -1e-30f, 2.0f, -2.0f, nan})
            EXPECT_LT(texel_coordinate(u, size), size) << u;
        for (uint x = 0; x < size; ++x) {
            const vec2 middle = texel_middle(x, size - 1 - x, size);
            ASSERT_EQ(texel_coordinate(middle.x, size), x);
            ASSERT_EQ(texel_coordinate(middle.y, size), size - 1 - x);
        }
        for (int i = 0; i < 1000; ++i) {
            vec3 d(direction() * log_uniform(1e-18, 1e18));
            if (i % 10 == 0) d[int(random() % 3)] = 0;
            const uint texel = texel_towards(d, size);
            ASSERT_LT(texel, map_texels(size));
            const vec2 middle = texel_middle(texel % size, texel / size % size, size), off = project(d) - middle;
            ASSERT_LE(std::max(std::abs(off.x), std::abs(off.y)), 1.0 / size + 2 * ulp);
            ASSERT_EQ(texel / (size * size), half_of(d));
        }
        EXPECT_LT(texel_towards(vec3(0), size), map_texels(size));
    }
}

// The angle from a texel's middle to its corner. As the size grows the formula becomes exact.
TEST_F(Paraboloid, texel_angle_is_half_the_diagonal) {
    for (int i = 0; i < 1000; ++i) {
        const uint size = 256, x = random() % size, y = random() % size;
        const vec2 uv = texel_middle(x, y, size);
        const dvec3 a(unproject(half_front, uv)), b(unproject(half_front, uv + vec2(1.0f / size)));
        ASSERT_NEAR(2 * std::asin(glm::length(b - a) / 2) / texel_angle(uv, size), 1, 0.01);
    }
}

TEST_F(Paraboloid, extremes_give_numbers) {
    for (float length : {0.0f, 1e-38f, 1e-20f, 1e-10f, 1e10f, 1e20f, 3e38f})
        for (float r : {0.0f, 1e-38f, 1e-20f, 1.0f, 1e20f, 3e38f})
            for (const dvec3& w : {dvec3(1, 0, 0), dvec3(-1, 0, 0), dvec3(0, 1, 0), direction()}) {
                const vec3 d(double(length) * w);
                EXPECT_FALSE(std::isnan(criterion(d, r, 64))) << length << " " << r;
                for (uint half : {half_front, half_back}) {
                    const Footprint f = footprint(half, d, r);
                    EXPECT_FALSE(std::isnan(f.center.x + f.center.y + f.radius)) << length << " " << r;
                }
                outside_frustum(view(1, direction()), d, r);
            }
}

}  // namespace
}  // namespace myriad
