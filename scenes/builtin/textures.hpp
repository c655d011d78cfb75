// The kit's textures: pictures computed from a formula. Colours are linear going in and sRGB coming out.
#pragma once

#include "scenes/builtin/kit.hpp"

namespace myriad::scenes::kit {

// The colour at the middle of each texel; (u, v) in [0, 1), row 0 at v = 0. `color` is asked from several threads.
Texture picture(const char* name, uint32_t width, uint32_t height, const std::function<glm::vec3(glm::vec2 uv)>& color);

// Smooth noise in [-1, 1] that repeats every `period` cells each way, and octaves of it; the same for equal seeds.
float noise(glm::vec2 p, int period, uint32_t seed);
float fractal_noise(glm::vec2 p, int period, uint32_t seed, int octaves);

// The cell of a jittered grid that p is in: which, as hashed bits, and how far p is from its border, in cells. Repeats every
// `period` cells each way.
struct Cell {
    uint32_t bits;
    float to_border;
};
Cell mosaic(glm::vec2 p, glm::ivec2 period, uint32_t seed);

// A number in [0, 1) from hashed bits; `which` picks independent ones.
float unit(uint32_t bits, uint32_t which = 0);

// Courses of hewn stones, `courses` in the texture, about `aspect` times as long as high, each of its own tint, with weathered joints.
Texture ashlar(const char* name, int courses, float aspect, glm::vec3 stone, float contrast, uint32_t seed);

// Boards along u, `boards` of them, with grain.
Texture planks(const char* name, int boards, glm::vec3 light, glm::vec3 dark, uint32_t seed);

}  // namespace myriad::scenes::kit
