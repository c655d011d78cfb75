#include "scenes/builtin/textures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <thread>

namespace myriad::scenes::kit {
namespace {

using glm::ivec2;
using glm::vec2;
using glm::vec3;

uint32_t hashed(uint32_t x) {
    x ^= x >> 16, x *= 0x7feb352du;
    x ^= x >> 15, x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

uint32_t hashed(ivec2 cell, uint32_t seed) { return hashed(hashed(hashed(seed) + uint32_t(cell.x)) + uint32_t(cell.y)); }

int wrapped(int i, int period) { return ((i % period) + period) % period; }

}  // namespace

Texture picture(const char* name, uint32_t width, uint32_t height, const std::function<vec3(vec2 uv)>& color) {
    Texture texture{.name = name, .width = width, .height = height, .rgba = std::vector<uint8_t>(size_t(width) * height * 4, 255)};
    const auto rows = [&](uint32_t first, uint32_t last) {
        for (uint32_t y = first; y < last; ++y)
            for (uint32_t x = 0; x < width; ++x) {
                const vec3 c = color(vec2((float(x) + 0.5f) / float(width), (float(y) + 0.5f) / float(height)));
                for (int k = 0; k < 3; ++k) texture.rgba[(size_t(y) * width + x) * 4 + size_t(k)] = srgb8(c[k]);
            }
    };
    // Pictures are most of the time that a scene takes: each thread has a band of rows, and texels know nothing of each other.
    const uint32_t bands = std::clamp(std::thread::hardware_concurrency(), 1u, 8u);
    std::vector<std::thread> threads;
    for (uint32_t i = 1; i < bands; ++i) threads.emplace_back(rows, height * i / bands, height * (i + 1) / bands);
    rows(0, height / bands);
    for (std::thread& thread : threads) thread.join();
    return texture;
}

float unit(uint32_t bits, uint32_t which) { return float(hashed(bits + 0x9e3779b9u * (which + 1)) >> 8) * 0x1p-24f; }

float noise(vec2 p, int period, uint32_t seed) {
    // Gradients of unit length, of which each corner has one.
    static const std::array<vec2, 32> gradients = [] {
        std::array<vec2, 32> g;
        for (size_t i = 0; i < g.size(); ++i) g[i] = {std::cos(2 * pi * float(i) / 32), std::sin(2 * pi * float(i) / 32)};
        return g;
    }();
    const vec2 cell = glm::floor(p), f = p - cell, s = f * f * f * (f * (f * 6.0f - 15.0f) + 10.0f);
    const auto corner = [&](int dx, int dy) {
        const ivec2 at(wrapped(int(cell.x) + dx, period), wrapped(int(cell.y) + dy, period));
        return glm::dot(gradients[hashed(at, seed) >> 27], f - vec2(dx, dy));
    };
    return 1.4f * glm::mix(glm::mix(corner(0, 0), corner(1, 0), s.x), glm::mix(corner(0, 1), corner(1, 1), s.x), s.y);
}

float fractal_noise(vec2 p, int period, uint32_t seed, int octaves) {
    float sum = 0, weight = 0.5f;
    for (int i = 0; i < octaves; ++i, weight /= 2, p *= 2.0f, period *= 2) sum += weight * noise(p, period, seed + uint32_t(i));
    return sum / (1 - weight);
}

Cell mosaic(vec2 p, ivec2 period, uint32_t seed) {
    const ivec2 cell(glm::floor(p));
    // The nearest and the second nearest of the jittered centres around.
    float near = 1e9f, second = 1e9f;
    uint32_t bits = 0;
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            const ivec2 other = cell + ivec2(dx, dy);
            const uint32_t h = hashed(ivec2(wrapped(other.x, period.x), wrapped(other.y, period.y)), seed);
            const float d = glm::length(vec2(other) + 0.12f + 0.76f * vec2(unit(h, 1), unit(h, 2)) - p);
            if (d < near) second = near, near = d, bits = h;
            else second = std::min(second, d);
        }
    return {bits, 0.5f * (second - near)};
}

Texture ashlar(const char* name, int courses, float aspect, vec3 stone, float contrast, uint32_t seed) {
    const int stones = std::max(1, int(std::lround(float(courses) / aspect)));
    return picture(name, 512, 512, [&](vec2 uv) {
        const float y = uv.y * float(courses);
        const int course = int(y);
        const uint32_t row = hashed(ivec2(course, 77), seed);
        // Every course is shifted, and its joints are not quite even.
        float x = uv.x * float(stones) + unit(row);
        x += 0.16f * std::sin(2 * pi * (x + unit(row, 1))) / (2 * pi);
        const int i = wrapped(int(std::floor(x)), stones);
        const uint32_t own = hashed(ivec2(i, course), seed + 1);
        const float fx = x - std::floor(x), fy = y - float(course);
        const float edge = std::min(std::min(fx, 1 - fx) * aspect, std::min(fy, 1 - fy));  // in courses
        const float joint = glm::smoothstep(0.012f, 0.05f, edge);
        const float tint = 1 + contrast * (unit(own, 2) - 0.5f) + 0.10f * contrast * fractal_noise(uv * 24.0f, 24, seed, 3);
        const vec3 warmth = glm::mix(vec3(0.98f, 1, 1.04f), vec3(1.03f, 1, 0.94f), unit(own, 3));
        return stone * warmth * tint * (0.80f + 0.20f * joint);
    });
}

Texture planks(const char* name, int boards, vec3 light, vec3 dark, uint32_t seed) {
    return picture(name, 512, 512, [&](vec2 uv) {
        const float y = uv.y * float(boards);
        const int board = int(y);
        const uint32_t own = hashed(ivec2(board, 5), seed);
        const float x = uv.x + unit(own), fy = y - float(board);
        // One end joint a board, and grain that runs along it, wavy where branches were.
        const float joint = std::abs(x - std::floor(x) - 0.5f) * float(boards);
        const float wave = fractal_noise(vec2(4 * x, 2 * uv.y * float(boards)), 4 * boards, seed + uint32_t(board), 2);
        const float grain = 0.5f + 0.5f * std::sin(2 * pi * (3 * fy + 1.5f * wave + 7 * unit(own, 1)));
        const float fine = noise(vec2(uv.x * 32, uv.y * 256), 256, seed + 9);
        const float gap = glm::smoothstep(0.0f, 0.03f, std::min({fy, 1 - fy, joint}));
        return glm::mix(dark, light, std::clamp(0.35f + 0.4f * unit(own, 2) + 0.22f * (grain - 0.5f) + 0.18f * fine, 0.0f, 1.0f)) * (0.45f + 0.55f * gap);
    });
}

}  // namespace myriad::scenes::kit
