#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tools/reference/brdf.hpp"
#include "tools/reference/sampler.hpp"

namespace myriad::reference {
namespace {

Surface surface(const vec3& base, float metallic, float roughness) {
    Surface s;
    s.geometric = s.shading = glm::normalize(vec3(0.3f, 0.8f, -0.2f));
    s.base = base, s.metallic = metallic, s.roughness = roughness;
    return s;
}

vec3 view_of(const Surface& s, float cosine) {
    vec3 x, y;
    complete_frame(s.shading, x, y);
    return glm::normalize(cosine * s.shading + std::sqrt(1 - cosine * cosine) * (0.6f * x + 0.8f * y));
}

// What is reflected of even light: over a grid in the hemisphere, finer towards the mirrored direction than any lobe here is narrow.
double reflected(const Surface& s, const Brdf& brdf, bool density = false) {
    constexpr int rings = 400, turns = 400;
    vec3 x, y;
    complete_frame(s.shading, x, y);
    double sum = 0;
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < turns; ++j) {
            const float z = (float(i) + 0.5f) / rings, turn = 2 * std::numbers::pi_v<float> * (float(j) + 0.5f) / turns, r = std::sqrt(1 - z * z);
            const vec3 l = r * std::cos(turn) * x + r * std::sin(turn) * y + z * s.shading;
            sum += density ? double(brdf.density(l)) : double(brdf.times_cosine(l).y);
        }
    return sum * 2 * std::numbers::pi / (rings * turns);
}

TEST(ReferenceBrdf, sampled_as_by_quadrature) {
    for (const auto& [base, metallic, roughness] : {std::tuple(0.5f, 0.0f, 0.3f), {1.0f, 1.0f, 0.5f}, {0.9f, 0.5f, 0.8f}, {1.0f, 0.0f, 1.0f}, {0.2f, 1.0f, 0.25f}})
        for (const float cosine : {1.0f, 0.6f, 0.2f}) {
            const Surface s = surface(vec3(base), metallic, roughness);
            const Brdf brdf(s, view_of(s, cosine), Model::gltf);
            double sum = 0;
            constexpr uint32_t count = 1 << 14;
            for (uint32_t i = 0; i < count; ++i) {
                Sampler sampler(1, 5, i);
                const float choice = sampler.one();
                sum += double(brdf.sample(choice, sampler.pair()).weight.y);
            }
            EXPECT_NEAR(sum / count, reflected(s, brdf), 0.005) << base << " " << metallic << " " << roughness << " " << cosine;
            EXPECT_LE(reflected(s, brdf, true), 1.005);  // what goes below the surface is the rest
        }
}

TEST(ReferenceBrdf, what_comes_in_comes_out_and_no_more) {
    for (const float roughness : {0.3f, 0.5f, 0.7f, 0.89f, 0.9f})
        for (const float cosine : {1.0f, 0.7f, 0.4f, 0.15f}) {
            const Surface china = surface(vec3(1), 0, roughness);
            const Brdf brdf(china, view_of(china, cosine), Model::gltf);
            EXPECT_NEAR(reflected(china, brdf), 1, 0.01) << roughness << " " << cosine;
            const Surface metal = surface(vec3(1), 1, roughness);
            EXPECT_LE(reflected(metal, Brdf(metal, view_of(metal, cosine), Model::gltf)), 1.005) << roughness << " " << cosine;
        }
    const Surface rough = surface(vec3(1), 1, 1);
    double mean = 0;
    for (int i = 0; i < 16; ++i) {
        const float cosine = (float(i) + 0.5f) / 16;
        mean += 2 * double(cosine) / 16 * reflected(rough, Brdf(rough, view_of(rough, cosine), Model::gltf));
    }
    EXPECT_LT(mean, 0.6);  // one reflection between facets alone
}

TEST(ReferenceBrdf, the_same_both_ways) {
    for (uint32_t i = 0; i < 200; ++i) {
        Sampler sampler(7, 1, i);
        const Surface s = surface(vec3(0.7f, 0.4f, 0.1f), sampler.one(), sampler.one());
        const vec2 a = sampler.pair(), b = sampler.pair();
        vec3 x, y;
        complete_frame(s.shading, x, y);
        const auto world = [&](const vec3& v) { return v.x * x + v.y * y + v.z * s.shading; };
        const vec3 in = world(cosine_direction(a)), out = world(cosine_direction(b));
        const vec3 one = Brdf(s, in, Model::gltf).times_cosine(out) / glm::dot(out, s.shading), other = Brdf(s, out, Model::gltf).times_cosine(in) / glm::dot(in, s.shading);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(one[c], other[c], 2e-3f * (1 + one[c])) << i;
    }
}

TEST(ReferenceBrdf, nothing_below_the_surface) {
    Surface s = surface(vec3(1), 0.5f, 0.3f);
    vec3 x, y;
    complete_frame(s.shading, x, y);
    s.geometric = glm::normalize(s.shading + 0.5f * x);
    const Brdf brdf(s, view_of(s, 0.5f), Model::gltf);
    EXPECT_EQ(brdf.times_cosine(-s.shading), vec3(0));
    EXPECT_EQ(brdf.times_cosine(glm::normalize(0.2f * s.shading - x)), vec3(0));  // above by the one normal, below by the other
    EXPECT_NE(brdf.times_cosine(glm::normalize(0.2f * s.shading + x)), vec3(0));
}

TEST(ReferenceBrdf, finite_at_the_edges) {
    for (const float roughness : {0.0f, 0.045f, 1.0f})
        for (const float metallic : {0.0f, 1.0f})
            for (const float cosine : {0.0f, 1e-6f, 1.0f})
                for (uint32_t i = 0; i < 64; ++i) {
                    const Surface s = surface(vec3(1), metallic, roughness);
                    Sampler sampler(1, 2, i);
                    const float choice = sampler.one();
                    const Brdf brdf(s, view_of(s, cosine), Model::gltf);
                    const Brdf::Sample next = brdf.sample(choice, sampler.pair());
                    EXPECT_TRUE(std::isfinite(next.weight.x) && std::isfinite(next.density)) << roughness << " " << cosine;
                    EXPECT_LE(next.weight.x, 12) << roughness << " " << metallic << " " << cosine;
                }
}

}  // namespace
}  // namespace myriad::reference
