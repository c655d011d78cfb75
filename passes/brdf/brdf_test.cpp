#include "passes/brdf/brdf.h"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <random>

#include "passes/brdf/brdf_ref.hpp"

namespace myriad::passes {
namespace {

using glm::dvec3;
using std::numbers::pi;

constexpr float roughnesses[] = {0.045f, 0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f, 0.7f, 0.8f, 0.9f, 1};
constexpr double cosines[] = {0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1};

dvec3 seen_at(double cosine) { return {std::sqrt(1 - cosine * cosine), 0, cosine}; }

// The mean of f over half-way vectors by the distribution's own density, which is that of D cos.
double over_lobe(double roughness, double nv, const std::function<double(const dvec3& l, double nh, double vh)>& f, int side = 64) {
    const dvec3 v = seen_at(nv);
    const double a2 = std::pow(roughness, 4);
    double sum = 0;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            const double u = (i + 0.5) / side, phi = 2 * pi * (j + 0.5) / side, nh = std::sqrt((1 - u) / (1 + (a2 - 1) * u));
            const dvec3 h(std::sqrt(1 - nh * nh) * std::cos(phi), std::sqrt(1 - nh * nh) * std::sin(phi), nh);
            const double vh = glm::dot(v, h);
            const dvec3 l = 2 * vh * h - v;
            if (vh > 0 && l.z > 0) sum += f(l, nh, vh);
        }
    return sum / (side * side);
}
// What the glossy lobe reflects of a white furnace: the density over directions of light is D nh / (4 vh).
double glossy_furnace(const GlossRef& gloss, double nv) {
    const double a2 = std::pow(gloss.roughness, 4);
    return over_lobe(gloss.roughness, nv, [&](const dvec3& l, double nh, double vh) {
        const double d = a2 / (pi * std::pow(nh * nh * (a2 - 1) + 1, 2));
        const BrdfRef f = brdf_ref(gloss, {0, 0, 1}, seen_at(nv), l);
        return f.glossy * f.fresnel.x * l.z * 4 * vh / (d * nh);
    });
}
// The mean of f over cosine-weighted directions.
double over_cosine(const std::function<double(const dvec3&)>& f, int side = 64) {
    double sum = 0;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            const double s = std::sqrt((i + 0.5) / side), phi = 2 * pi * (j + 0.5) / side;
            sum += f({s * std::cos(phi), s * std::sin(phi), std::sqrt(1 - s * s)});
        }
    return sum / (side * side);
}
double diffuse_furnace(const GlossRef& gloss, double nv) {
    return over_cosine([&](const dvec3& l) { return pi * brdf_ref(gloss, {0, 0, 1}, seen_at(nv), l).diffuse; });
}

class BrdfTest : public ::testing::Test {
protected:
    float uniform(float lo = -1, float hi = 1) { return std::uniform_real_distribution<float>(lo, hi)(random); }
    vec3 direction() {
        vec3 d(uniform(), uniform(), uniform());
        while (!(dot(d, d) > 0.01f && dot(d, d) < 1)) d = vec3(uniform(), uniform(), uniform());
        return normalize(d);
    }
    // At this cosine from n.
    vec3 at_cosine(const vec3& n, float cosine) {
        const vec3 side = normalize(cross(n, direction()));
        return normalize(cosine * n + std::sqrt(std::max(1 - cosine * cosine, 0.0f)) * side);
    }
    float any_cosine() {
        switch (random() % 5) {
            case 0: return 1;
            case 1: return std::pow(10.0f, uniform(-7, -1));
            default: return uniform(0.01f, 1);
        }
    }
    std::mt19937 random{7};
};

TEST_F(BrdfTest, equals_its_twin_in_hard_places) {
    for (int i = 0; i < 300000; ++i) {
        const float roughness = random() % 3 ? uniform(brdf_least_roughness, 1) : roughnesses[random() % 11];
        const vec3 n = direction(), f0(uniform(0, 1), 0.04f, float(random() % 2));
        const vec3 view = at_cosine(n, any_cosine());
        vec3 l = at_cosine(n, any_cosine());
        switch (random() % 4) {
            case 0: l = normalize(2 * dot(n, view) * n - view + roughness * roughness * uniform() * direction()); break;  // about the mirror's
            case 1: l = normalize(2 * dot(n, view) * n - view); break;
            case 2: l = random() % 2 ? view : n; break;
            default:;
        }
        if (!(dot(n, l) > 0) || length(l + view) < 1e-3f) continue;  // opposite ways have no half-way vector to speak of
        const float widen = random() % 2 ? 0 : std::pow(10.0f, uniform(-8, 2));
        // Cosines are as good as 1e-7 of the vectors' length.
        const double tolerance = 1e-3 + 4e-6 / std::min(dot(n, l), std::max(dot(n, view), 1e-4f));
        const auto near = [&](double of, float value) { return std::abs(of - double(value)) <= tolerance * std::abs(of) + 1e-7; };
        const Reflectance got = reflectance_of(lobe_of(f0, roughness, view, n), n, l, widen);
        const BrdfRef e = brdf_ref({dvec3(f0), roughness}, normalize(dvec3(n)), normalize(dvec3(view)), normalize(dvec3(l)), widen);
        const vec3 glossy = brdf_fresnel(f0, got.power) * got.glossy;
        ASSERT_TRUE(near(e.diffuse * pi, got.diffuse)) << roughness << ": " << e.diffuse * pi << " " << got.diffuse;
        for (int c = 0; c < 3; ++c)
            ASSERT_TRUE(near(e.glossy * e.fresnel[c], glossy[c])) << roughness << " + " << widen << ", n.v " << dot(n, view) << ", n.l " << dot(n, l) << ": "
                                                      << e.glossy * e.fresnel[c] << " expected, " << glossy[c] << " found";
    }
}

TEST_F(BrdfTest, light_may_go_either_way) {
    for (int i = 0; i < 100000; ++i) {
        const float roughness = uniform(brdf_least_roughness, 1), widen = random() % 2 ? 0 : uniform(0, 0.3f);
        const vec3 n = direction(), f0(uniform(0, 1)), a = at_cosine(n, any_cosine()), b = at_cosine(n, any_cosine());
        const Reflectance there = reflectance_of(lobe_of(f0, roughness, a, n), n, b, widen), back = reflectance_of(lobe_of(f0, roughness, b, n), n, a, widen);
        ASSERT_NEAR(there.diffuse, back.diffuse, 1e-5f * there.diffuse);
        ASSERT_NEAR(there.glossy, back.glossy, 1e-4f * there.glossy);
        ASSERT_NEAR(there.power, back.power, 1e-6f);
    }
}

// The lobe of glTF by itself, and the diffuse part under it.
TEST_F(BrdfTest, reflects_no_more_than_there_is) {
    for (const float roughness : roughnesses)
        for (const double nv : cosines) {
            const double white = glossy_furnace({dvec3(1), roughness}, nv), dielectric = glossy_furnace({dvec3(0.04), roughness}, nv);
            EXPECT_LE(white, 1.0005) << roughness << " " << nv;
            EXPECT_GE(white, 0.3) << roughness << " " << nv;  // what a single reflection between facets loses
            const double diffuse = diffuse_furnace({dvec3(0.04), roughness}, nv);
            EXPECT_NEAR(diffuse, 1 - brdf_fitted_ref(roughness, nv), 1e-3) << roughness << " " << nv;
            EXPECT_LE(diffuse + dielectric, 1.015) << roughness << " " << nv;
            EXPECT_GE(diffuse + dielectric, 0.85) << roughness << " " << nv;
        }
}

// Why the diffuse part is not the 1 - F(v . h) of the appendix: white china would shine by more than it gets.
TEST_F(BrdfTest, the_appendix_reflects_more_than_there_is) {
    double most = 0;
    for (const float roughness : roughnesses)
        for (const double nv : cosines) {
            const double diffuse = over_cosine([&](const dvec3& l) { return 0.96 * (1 - std::pow(1 - glm::dot(seen_at(nv), normalize(l + seen_at(nv))), 5)); });
            most = std::max(most, diffuse + glossy_furnace({dvec3(0.04), roughness}, nv));
        }
    std::printf("a white surface reflects up to %.3f\n", most);
    EXPECT_GT(most, 1.3);
}

// What it costs to take rough dielectrics for Lambertians.
TEST_F(BrdfTest, rough_dielectrics_are_nearly_matte) {
    for (const double roughness : {0.9, 1.0}) {
        double worst = 0, grazing = 0;
        for (const double nv : {0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0})
            for (const double albedo : {0.0, 0.2, 0.5, 0.8, 1.0}) {
                const GlossRef gloss{dvec3(0.04), roughness};
                const double off = std::abs(albedo * diffuse_furnace(gloss, nv) + glossy_furnace(gloss, nv) - albedo);
                (nv < 0.3 ? grazing : worst) = std::max(nv < 0.3 ? grazing : worst, off);
            }
        std::printf("roughness %.1f: reflectance off by %.3f, below a cosine of 0.3 by %.3f\n", roughness, worst, grazing);
        EXPECT_LT(worst, 0.045);
        EXPECT_LT(grazing, 0.1);
    }
    EXPECT_EQ(brdf_roughness(0, 0.9f), 0.0f);
    EXPECT_EQ(brdf_roughness(0, 1), 0.0f);
    EXPECT_EQ(brdf_roughness(0.01f, 1), 1.0f);
    EXPECT_EQ(brdf_roughness(0, 0.89f), 0.89f);
    EXPECT_EQ(brdf_roughness(1, 0), brdf_least_roughness);
}

TEST_F(BrdfTest, a_widened_lobe_is_that_of_a_rougher_surface) {
    const vec3 n(0, 0, 1);
    for (int i = 0; i < 1000; ++i) {
        const vec3 v = at_cosine(n, uniform(0.05f, 1)), l = at_cosine(n, uniform(0.05f, 1));
        const float a = uniform(0.1f, 0.6f), b = uniform(a, 1), widen = b * b * b * b - a * a * a * a;
        const float expected = reflectance_of(lobe_of(vec3(1), b, v, n), n, l, 0).glossy;
        EXPECT_NEAR(reflectance_of(lobe_of(vec3(1), a, v, n), n, l, widen).glossy, expected, 1e-4f * expected);
        EXPECT_EQ(reflectance_of(lobe_of(vec3(1), a, v, n), n, l, INFINITY).glossy, reflectance_of(lobe_of(vec3(1), a, v, n), n, l, 1e9f).glossy);
    }
}

TEST_F(BrdfTest, finite_and_not_negative_where_nothing_is_seen_well) {
    const vec3 n(0, 0, 1), places[] = {n, -n, {1, 0, 0}, {-1, 0, 0}, normalize(vec3(1, 0, -1e-3f)), normalize(vec3(1, 0, 1e-20f)), vec3(0)};
    for (const vec3& v : places)
        for (const vec3& l : places)
            for (const float roughness : roughnesses)
                for (const float widen : {0.0f, 1e-30f, 1.0f, INFINITY}) {
                    const Reflectance r = reflectance_of(lobe_of(vec3(0.5f), roughness, v, n), n, l, widen);
                    for (const float value : {r.diffuse, r.glossy, r.power}) ASSERT_TRUE(value >= 0 && value < 1e12f) << value;
                }
    const Reflectance matte = reflectance_of(matte_lobe(), n, n, 0);
    EXPECT_TRUE(matte.diffuse == 1 && matte.glossy == 0);
}

TEST_F(BrdfTest, gloss_survives_packing) {
    for (int i = 0; i < 10000; ++i) {
        const vec3 n = direction(), view = direction(), f0(uniform(0, 1), uniform(0, 1), uniform(0, 1));
        const float roughness = uniform(brdf_least_roughness, 1);
        const Lobe kept = lobe_of(pack_gloss(f0, roughness, view), n), lobe = lobe_of(f0, roughness, view, n);
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(kept.f0[c], f0[c], 8e-6f);
        ASSERT_NEAR(kept.alpha2, lobe.alpha2, 1e-3f * lobe.alpha2);
        ASSERT_NEAR(length(kept.view - view), 0, 1e-4f);
        ASSERT_FALSE(is_matte(pack_gloss(f0, roughness, view)));
    }
    EXPECT_TRUE(is_matte(pack_gloss(vec3(0.04f), 0, vec3(0, 0, 1))));
    EXPECT_TRUE(is_matte(Gloss{}));
    EXPECT_EQ(lobe_of(Gloss{}, vec3(0, 0, 1)).alpha2, 0.0f);
}

}  // namespace
}  // namespace myriad::passes
