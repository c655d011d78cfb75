#include "compute/opacity/opacity.hpp"

#include <gtest/gtest.h>

#include "compute/opacity/opacity_testing.hpp"

namespace myriad::compute {
namespace {

using Kind = Opacity::Kind;

// Alpha by the definition of glTF, in doubles.
double alpha_by_hand(const OpacityScene& s, uint triangle, double u, double v) {
    const uvec4 t = s.triangles[triangle];
    const OpacityMaterial& m = s.materials[t.w];
    const auto blend = [&](const auto& of) { return (1 - u - v) * glm::dvec2(of[t.x]) + u * glm::dvec2(of[t.y]) + v * glm::dvec2(of[t.z]); };
    double alpha = m.alpha;
    if (!s.colors.empty()) alpha *= (1 - u - v) * s.colors[t.x].a + u * s.colors[t.y].a + v * s.colors[t.z].a;
    if (m.texture.width == 0) return alpha;
    const glm::dvec2 uv = blend(m.texture.use >> 4 ? s.texcoords1 : s.texcoords);
    const glm::dvec2 at = glm::dvec2(m.texture.along_u) * uv.x + glm::dvec2(m.texture.along_v) * uv.y + glm::dvec2(m.texture.origin);
    const glm::dvec2 texel = at * glm::dvec2(m.texture.width, m.texture.height) - 0.5, low = glm::floor(texel);
    const auto wrapped = [](long i, long n, uint mode) {
        const auto modulo = [](long a, long b) { return (a % b + b) % b; };
        if (mode == wrap_clamp) return std::clamp(i, 0l, n - 1);
        if (mode == wrap_mirror) return modulo(i, 2 * n) < n ? modulo(i, 2 * n) : 2 * n - 1 - modulo(i, 2 * n);
        return modulo(i, n);
    };
    double sum = 0;
    for (int dy = 0; dy < 2; ++dy)
        for (int dx = 0; dx < 2; ++dx) {
            const long x = wrapped(long(low.x) + dx, m.texture.width, m.texture.use & 3), y = wrapped(long(low.y) + dy, m.texture.height, m.texture.use >> 2 & 3);
            const double weight = (1 - std::abs(texel.x - (low.x + dx))) * (1 - std::abs(texel.y - (low.y + dy)));
            sum += weight * (s.texels[m.texture.first + uint(y) * m.texture.width + uint(x)] >> 24);
        }
    return alpha * sum / 255;
}

TEST(OpacityTest, alpha_is_what_gltf_says) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(0, 1);
    const OpacityScene s = OpacityScene::soup(400, 1, random);
    const Opacity opacity = s.opacity();
    EXPECT_FALSE(opacity.everywhere());
    for (uint t = 0; t < s.triangles.size(); ++t)
        for (int i = 0; i < 20; ++i) {
            float u = unit(random), v = unit(random);
            if (u + v > 1) u = 1 - u, v = 1 - v;
            const double expected = alpha_by_hand(s, t, u, v), cutoff = s.materials[s.triangles[t].w].cutoff;
            ASSERT_NEAR(opacity.alpha({t}, u, v), expected, 1e-4) << t;
            if (cutoff >= 0 && std::abs(expected - cutoff) > 1e-4) { ASSERT_EQ(opacity.is_there({t}, t, u, v), expected >= cutoff) << t; }
        }
}

TEST(OpacityTest, who_need_not_ask_does_not) {
    std::mt19937 random(3);
    OpacityScene s;
    const uint use = wrap_repeat;
    const std::pair<OpacityMaterial, Kind> cases[] = {
        {Opacity::opaque(), Kind::everywhere},
        {{.alpha = 0.5f, .cutoff = 0.5f}, Kind::everywhere},
        {{.alpha = 0.4f, .cutoff = 0.5f}, Kind::nowhere},
        {{.alpha = 1, .cutoff = opacity_blended}, Kind::everywhere},
        {{.alpha = 0.5f, .cutoff = opacity_blended}, Kind::asks},
        {{.alpha = 0, .cutoff = opacity_blended}, Kind::nowhere},
        {{s.texture(5, 3, random, use, 255), 1, opacity_blended}, Kind::everywhere},  // most of what exporters call blended
        {{s.texture(5, 3, random, use, 0), 1, 0.5f}, Kind::nowhere},
        {{s.texture(5, 3, random, use), 1, 0.5f}, Kind::asks},
        {{s.texture(5, 3, random, use), 1, opacity_blended}, Kind::asks},
        {{s.texture(5, 3, random, use), 1, 0}, Kind::everywhere},  // nothing is below a cutoff of 0
    };
    for (const auto& [m, kind] : cases) s.square(0, s.material(m));
    for (bool colors : {false, true}) {
        if (colors) s.colors.assign(s.positions.size(), vec4(1));
        const Opacity opacity = s.opacity();
        for (uint i = 0; i < std::size(cases); ++i) EXPECT_EQ(opacity.kind(2 * i), cases[i].second) << i << colors;
    }
    s.colors[s.triangles[2].x].a = 0.9f;  // of a corner: masked at the very cutoff
    EXPECT_EQ(s.opacity().kind(2), Kind::asks);
    EXPECT_EQ(s.opacity().kind(6), Kind::everywhere);
    s.colors[s.triangles[6].y].a = 0.9f;
    EXPECT_EQ(s.opacity().kind(6), Kind::asks);
    EXPECT_TRUE(Opacity().everywhere());
    EXPECT_TRUE(Opacity().is_there({7}, 7, 0.3f, 0.3f));
}

// What is everywhere is found everywhere, what is nowhere nowhere: the tree may rely on it.
TEST(OpacityTest, kinds_keep_their_promise) {
    std::mt19937 random(9);
    std::uniform_real_distribution<float> unit(0, 1);
    OpacityScene s = OpacityScene::soup(3000, 1, random);
    for (vec4& c : s.colors) c.a = std::min(1.0f, 2 * c.a);
    for (size_t i = 1; i < s.materials.size(); i += 3) s.materials[i].cutoff = i % 2 ? 0.1f : 0.9f;
    const Opacity opacity = s.opacity();
    uint seen[3] = {};
    for (uint t = 0; t < s.triangles.size(); ++t) {
        const Kind kind = opacity.kind(t);
        ++seen[int(kind)];
        for (int i = 0; i < 10 && kind != Kind::asks; ++i) {
            const float u = i < 3 ? float(i == 1) : 0.5f * unit(random), v = i < 3 ? float(i == 2) : 0.5f * unit(random);
            ASSERT_EQ(opacity.is_there({t}, t, u, v), kind == Kind::everywhere) << t;
        }
    }
    EXPECT_GT(seen[0], 100u);
    EXPECT_GT(seen[1], 10u);
    EXPECT_GT(seen[2], 100u);
}

TEST(OpacityTest, blended_points_are_there_by_their_alpha_and_independently) {
    OpacityScene s;
    for (float alpha : {0.1f, 0.5f, 0.75f}) s.square(0, s.material({.alpha = alpha, .cutoff = opacity_blended}));
    const Opacity opacity = s.opacity();
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0, 0.5f);
    const int n = 100000;
    for (uint t = 0; t < 6; ++t) {
        const double alpha = std::array{0.1, 0.5, 0.75}[t / 2];
        int there = 0, both = 0;
        for (int i = 0; i < n; ++i) {
            const float u = unit(random), v = unit(random);
            const bool is = opacity.is_there({t}, t, u, v);
            EXPECT_EQ(is, opacity.is_there({t}, t, u, v));
            there += is;
            both += is && opacity.is_there({t ^ 1}, t ^ 1, u, v);
        }
        EXPECT_NEAR(there / double(n), alpha, 0.007) << t;  // 4.4 sigma
        EXPECT_NEAR(both / double(n), alpha * alpha, 0.007) << t;
    }
}

TEST(OpacityTest, pixels_share_a_block_s_thresholds) {
    OpacityScene s;
    for (float alpha : {0.25f, 0.5f, 0.25f}) s.square(0, s.material({.alpha = alpha, .cutoff = opacity_blended}));
    const Opacity opacity = s.opacity();
    int both = 0;
    std::array<int, 16> where{};
    for (uint by = 0; by < 100; ++by)
        for (uint bx = 0; bx < 100; ++bx) {
            int quarter = 0, half = 0;
            for (uint i = 0; i < 16; ++i) {
                const uint dice = opacity_pixel(4 * bx + i % 4, 4 * by + i / 4);
                ASSERT_NE(dice, opacity_alone);
                const bool first = opacity.is_there({0}, 0, 0.2f, 0.3f, dice);
                quarter += first, where[i] += first;
                half += opacity.is_there({2}, 2, 0.2f, 0.3f, dice);
                both += first && opacity.is_there({4}, 4, 0.2f, 0.3f, dice);
            }
            ASSERT_EQ(quarter, 4);
            ASSERT_EQ(half, 8);
        }
    EXPECT_NEAR(both / 160000.0, 1.0 / 16, 0.003);             // triangles behind one another are independent
    for (int count : where) EXPECT_NEAR(count, 2500, 250);     // and no pixel of the block is preferred
}

}  // namespace
}  // namespace myriad::compute
