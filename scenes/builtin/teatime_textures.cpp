// What is painted, printed, woven and baked.
#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/builtin/teatime_parts.hpp"

namespace myriad::scenes::teatime {
namespace {

using glm::ivec2;
using glm::vec2;
using glm::vec3;
using kit::pi;

float mask(float inside, float soft) { return glm::smoothstep(-soft, soft, inside); }

// A flower of `petals` around the origin, in [0, 1]: 1 on it.
float flower(vec2 p, float size, int petals, float soft) {
    if (glm::dot(p, p) > 1.6f * size * size) return 0;
    const float r = glm::length(p) / size, angle = std::atan2(p.y, p.x);
    return mask(0.62f + 0.38f * std::abs(std::cos(0.5f * float(petals) * angle)) - r, soft);
}

float leaf_shape(vec2 p, vec2 at, float angle, float length, float soft) {
    const vec2 d = p - at;
    if (glm::dot(d, d) > length * length) return 0;
    const vec2 way(std::cos(angle), std::sin(angle));
    const float along = glm::dot(d, way) / length, across = std::abs(-d.x * way.y + d.y * way.x) / length;
    return along > 0 && along < 1 ? mask(0.22f * std::sin(pi * along) - across, soft) : 0;
}

}  // namespace

Texture ornament(const char* name, uint32_t repeats, vec3 ink, uint32_t seed) {
    constexpr vec3 white{0.80f, 0.79f, 0.765f}, rose{0.66f, 0.16f, 0.22f}, gold{0.70f, 0.48f, 0.16f}, green{0.16f, 0.38f, 0.20f};
    return kit::picture(name, 768, 192, [&](vec2 uv) {
        // In one repeat: x from 0 to 1, y as high as the piece; a vine that waves, with leaves and a flower in each bend.
        const float x = uv.x * float(repeats) - std::floor(uv.x * float(repeats)), y = 1.0f * uv.y;
        vec3 color = white * (1 + 0.012f * kit::noise(uv * vec2(32, 8), 32, seed));
        const auto paint = [&](vec3 with, float amount) { color = glm::mix(color, with, amount); };
        const float vine = 0.52f + 0.13f * std::sin(2 * pi * x);
        paint(ink, mask(0.012f - std::abs(y - vine), 0.006f));
        const float d = 0.22f;
        for (float shift : {-1.0f, 0.0f, 1.0f}) {
            for (auto [lx, angle] : {std::pair(0.04f, 0.9f), {0.17f, 2.3f}, {0.36f, -0.9f}, {0.50f, -2.4f}, {0.55f, -0.7f}, {0.69f, 0.8f}, {0.83f, 2.2f}, {0.95f, 2.6f}})
                paint(green, leaf_shape({x, y}, {lx + shift, 0.52f + 0.13f * std::sin(2 * pi * lx)}, angle, 0.5f * d, 0.02f));
            for (auto [fx, fy] : {std::pair(0.25f, 0.42f), {0.75f, 0.62f}}) {
                const vec2 p = vec2(x - fx - shift, y - fy);
                paint(fx < 0.5f ? rose : ink, flower(p, 0.085f, 5, 0.08f));
                paint(gold, mask(0.024f - glm::length(p), 0.01f));
            }
            for (float fx : {0.0f, 0.5f}) paint(rose, mask(0.022f - glm::length(vec2(x - fx - shift, y - (fx == 0 ? 0.34f : 0.72f))), 0.01f));
        }
        // Bands above and below.
        for (auto [at, width, band] : {std::tuple(0.965f, 0.035f, gold), {0.90f, 0.012f, ink}, {0.07f, 0.016f, ink}}) paint(band, mask(width - std::abs(y - at), 0.006f));
        return color;
    });
}

Texture tablecloth_linen(uint32_t seed) {
    constexpr vec3 linen{0.78f, 0.765f, 0.725f}, blue{0.20f, 0.32f, 0.56f};
    return kit::picture("linen", 768, 768, [&](vec2 uv) {
        const vec2 p = 2.0f * uv - 1.0f, q = glm::abs(p);
        const float edge = 1 - std::max(q.x, q.y), along = q.x > q.y ? p.y : p.x;
        vec3 color = linen * (1 + 0.02f * kit::noise(uv * 64.0f, 64, seed) + 0.015f * std::sin(uv.x * 1200) * std::sin(uv.y * 1200));
        float thread = 0;
        // Two woven stripes with a running wave between them, and sprigs over the field.
        for (auto [at, width] : {std::pair(0.055f, 0.016f), {0.215f, 0.009f}, {0.245f, 0.004f}}) thread = std::max(thread, mask(width - std::abs(edge - at), 0.003f));
        const float wave = 0.135f + 0.030f * std::sin(2 * pi * 9 * along);
        thread = std::max(thread, mask(0.006f - std::abs(edge - wave), 0.003f));
        const float bend = 9 * along * 2 - 0.5f, fx = (bend - std::floor(bend) - 0.5f) / 18;
        const float side = int(std::floor(bend)) % 2 ? -1.0f : 1.0f;
        thread = std::max(thread, flower(vec2(fx, edge - 0.135f - 0.018f * side), 0.022f, 5, 0.1f));
        if (edge > 0.30f) {
            const vec2 grid = p * 5.5f + 0.5f, in = (grid - glm::floor(grid) - 0.5f) / 5.5f;
            thread = std::max(thread, 0.6f * flower(in, 0.013f, 4, 0.12f));
        }
        return glm::mix(color, blue, thread * 0.9f);
    });
}

Texture wallpaper(uint32_t seed) {
    constexpr vec3 ground{0.50f, 0.60f, 0.545f}, stripe{0.57f, 0.655f, 0.60f}, light{0.72f, 0.73f, 0.64f}, petal{0.70f, 0.50f, 0.44f};
    return kit::picture("wallpaper", 512, 512, [&](vec2 uv) {
        // Two stripes a repeat; on the broad one sprays that climb, half a drop apart.
        const float x = 2 * uv.x, in = x - std::floor(x), drop = uv.y * 2 + (x >= 1 ? 0.5f : 0), y = drop - std::floor(drop);
        vec3 color = glm::mix(ground, stripe, mask(0.32f - std::abs(in - 0.5f), 0.006f));
        color = glm::mix(color, light, 0.7f * mask(0.008f - std::abs(std::abs(in - 0.5f) - 0.36f), 0.003f));
        const float stem = 0.5f + 0.07f * std::sin(2 * pi * y);
        float spray = mask(0.009f - std::abs(in - stem), 0.004f);
        for (auto [at, angle, length] : {std::tuple(0.10f, 0.7f, 0.16f), {0.22f, 2.5f, 0.17f}, {0.45f, 0.6f, 0.15f}, {0.60f, 2.4f, 0.16f}, {0.80f, 0.8f, 0.15f}, {0.90f, 2.5f, 0.15f}})
            spray = std::max(spray, leaf_shape({in, y}, {0.5f + 0.07f * std::sin(2 * pi * at), at}, angle, length, 0.02f));
        color = glm::mix(color, light, 0.75f * spray);
        const vec2 bloom(in - 0.5f - 0.07f * std::sin(2 * pi * 0.33f), y - 0.36f), bloom2(in - 0.5f + 0.07f, y - 0.74f);
        color = glm::mix(color, petal, std::max(flower(bloom, 0.085f, 6, 0.06f), flower(bloom2, 0.07f, 5, 0.06f)));
        color = glm::mix(color, light, std::max(mask(0.022f - glm::length(bloom), 0.008f), mask(0.018f - glm::length(bloom2), 0.008f)));
        return color * (1 + 0.02f * kit::noise(uv * 64.0f, 64, seed));
    });
}

Texture carpet(uint32_t seed) {
    constexpr vec3 red{0.50f, 0.10f, 0.09f}, dark{0.10f, 0.13f, 0.26f}, sand{0.70f, 0.58f, 0.40f}, green{0.18f, 0.28f, 0.18f};
    return kit::picture("carpet", 512, 512, [&](vec2 uv) {
        const vec2 p = 2.0f * uv - 1.0f;
        const float r = glm::length(p), turns = std::atan2(p.y, p.x) / (2 * pi) + 0.5f;
        const auto cycle = [&](float n) { return turns * n - std::floor(turns * n) - 0.5f; };
        vec3 color = red;
        if (r > 0.93f) color = dark;
        else if (r > 0.90f) color = sand;
        else if (r > 0.72f) {
            color = dark;
            const vec2 q(cycle(30) * 0.17f, r - 0.81f);
            color = glm::mix(color, sand, flower(q, 0.062f, 6, 0.08f));
            color = glm::mix(color, red, flower(q, 0.034f, 4, 0.1f));
        } else if (r > 0.69f) color = sand;
        else {
            const float star = 0.46f + 0.07f * std::abs(cycle(16)) * 2;
            if (r < star) color = dark;
            const vec2 q(cycle(16) * r * 0.39f, r - 0.60f);
            color = glm::mix(color, green, flower(q, 0.055f, 4, 0.1f));
            if (r < 0.42f) {
                color = glm::mix(color, sand, mask(0.02f - std::abs(r - 0.38f), 0.006f));
                color = glm::mix(color, red, flower(p, 0.33f, 16, 0.02f));
                color = glm::mix(color, sand, flower(p, 0.17f, 8, 0.03f));
                color = glm::mix(color, dark, flower(p, 0.09f, 8, 0.04f));
            }
        }
        return glm::max(color * (0.9f + 0.12f * kit::noise(uv * 128.0f, 128, seed) + 0.06f * kit::noise(uv * 16.0f, 16, seed + 1)), vec3(0));
    });
}

Texture landscape(uint32_t seed) {
    return kit::picture("landscape", 192, 144, [&](vec2 uv) {
        const float x = uv.x, y = uv.y;
        // A sky of thick paint, and five ranges of hills, nearer and darker.
        const float stroke = 0.05f * kit::fractal_noise(vec2(x * 20 + 3 * y, y * 50), 64, seed, 3);
        vec3 color = glm::mix(vec3(0.78f, 0.66f, 0.48f), vec3(0.34f, 0.48f, 0.66f), glm::smoothstep(0.45f, 1.0f, y)) * (1 + 2 * stroke);
        color = glm::mix(color, vec3(0.82f, 0.76f, 0.68f), 0.7f * glm::smoothstep(0.1f, 0.5f, kit::fractal_noise(vec2(x * 5, y * 12), 64, seed + 4, 4)) * glm::smoothstep(0.55f, 0.7f, y));
        for (int i = 0; i < 5; ++i) {
            const float far = 1 - float(i) / 4, top = 0.17f + 0.33f * far + 0.10f * kit::fractal_noise(vec2(x * (2 + 1.5f * float(i)), float(i) * 3.7f), 64, seed + 7, 4);
            const vec3 hill = glm::mix(vec3(0.16f, 0.20f, 0.08f), vec3(0.42f, 0.48f, 0.50f), far);
            color = glm::mix(color, hill * (1 + 5 * stroke + 0.3f * kit::noise(vec2(x * 40, y * 60), 64, seed + uint32_t(i))), mask(top - y, 0.006f));
        }
        return glm::max(color, vec3(0.01f));
    });
}

Texture garden(uint32_t seed) {
    return kit::picture("garden", 96, 96, [&](vec2 uv) {
        // Out of focus: only what shows in big soft shapes. Row 0 is at the bottom.
        const float tree = kit::fractal_noise(uv * vec2(5, 6), 64, seed, 3), hedge = 0.33f + 0.10f * kit::noise(vec2(uv.x * 6, 0.5f), 64, seed + 3);
        vec3 color = glm::mix(vec3(0.84f, 0.88f, 0.95f), vec3(0.62f, 0.76f, 0.96f), uv.y);
        const vec3 leaves = glm::mix(vec3(0.12f, 0.19f, 0.06f), vec3(0.42f, 0.50f, 0.20f), glm::clamp(0.5f + tree, 0.0f, 1.0f));
        color = glm::mix(color, leaves, glm::smoothstep(-0.1f, 0.15f, tree + 1.5f * (0.58f - uv.y)));
        color = glm::mix(color, leaves * vec3(0.6f, 0.75f, 0.6f), glm::smoothstep(-0.03f, 0.03f, hedge - uv.y));
        return glm::mix(color, vec3(0.36f, 0.50f, 0.16f), glm::smoothstep(0.02f, -0.02f, uv.y - 0.12f));
    });
}

Texture cut_cake(uint32_t seed) {
    constexpr vec3 sponge{0.78f, 0.60f, 0.32f}, cream{0.80f, 0.76f, 0.68f}, jam{0.52f, 0.05f, 0.07f}, crust{0.52f, 0.32f, 0.14f};
    return kit::picture("cut cake", 256, 256, [&](vec2 uv) {
        const float wobble = 0.010f * kit::fractal_noise(uv * 8.0f, 64, seed, 3), y = uv.y + wobble;
        const float crumb = kit::fractal_noise(uv * vec2(40, 30), 256, seed + 1, 3);
        vec3 color = sponge * (0.92f + 0.24f * crumb);
        for (float at : {0.30f, 0.63f}) {  // jam under cream
            color = glm::mix(color, crust, 0.6f * mask(0.055f - std::abs(y - at - 0.005f), 0.01f));
            color = glm::mix(color, cream, mask(0.030f - std::abs(y - at - 0.018f), 0.005f));
            color = glm::mix(color, jam, mask(0.018f - std::abs(y - at + 0.022f), 0.006f));
        }
        color = glm::mix(color, crust, mask(0.02f - y, 0.01f));
        return glm::mix(color, cream, mask(std::max(y - 0.93f, uv.x - 0.955f + 0.5f * wobble), 0.006f));
    });
}

Texture clock_face() {
    return kit::picture("clock face", 256, 256, [](vec2 uv) {
        const vec2 p = 2.0f * uv - 1.0f;
        const float r = glm::length(p), turns = std::atan2(p.y, p.x) / (2 * pi) + 1;
        const auto tick = [&](float n, float width) { return mask(width - std::abs(turns * n - std::floor(turns * n + 0.5f)) * 2 * pi * r / n, 0.008f); };
        float ink = r > 0.70f && r < 0.86f ? tick(12, 0.022f) : 0;
        ink = std::max(ink, r > 0.89f && r < 0.93f ? tick(60, 0.008f) : 0);
        ink = std::max({ink, mask(0.006f - std::abs(r - 0.94f), 0.006f), mask(0.006f - std::abs(r - 0.66f), 0.006f)});
        return glm::mix(vec3(0.78f, 0.75f, 0.66f), vec3(0.05f, 0.05f, 0.06f), ink);
    });
}

}  // namespace myriad::scenes::teatime
