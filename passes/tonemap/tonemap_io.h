// What the tone-map kernel, its host and its twin share.
#ifndef MYRIAD_PASSES_TONEMAP_IO_H
#define MYRIAD_PASSES_TONEMAP_IO_H

#include "engine/shared.h"

MYRIAD_BEGIN
struct TonemapPush {
    Float4s radiance;
    Uints pixels;
    uint count;
    float exposure;   // radiance that maps to 1 before the curve is 1 / exposure
};

// Narkowicz 2015, "ACES filmic tone mapping curve". It meets 1 at 7.25: what is brighter is white, before its square leaves the range of
// floats. What is below 0, or not a number, is black.
MYRIAD_FN float filmic(float radiance) {
    const float x = radiance > 0.0f ? min(radiance, 8.0f) : 0.0f;
    const float y = (x * (2.51f * x + 0.03f)) / (x * (2.43f * x + 0.59f) + 0.14f);
    return clamp(y, 0.0f, 1.0f);
}
MYRIAD_FN float srgb_encode(float x) { return x <= 0.0031308f ? 12.92f * x : 1.055f * pow(x, 1.0f / 2.4f) - 0.055f; }
MYRIAD_FN uint to_byte(float x) { return uint(srgb_encode(x) * 255.0f + 0.5f); }
MYRIAD_FN uint tonemap(vec3 radiance, float exposure) {
    return to_byte(filmic(radiance.x * exposure)) | (to_byte(filmic(radiance.y * exposure)) << 8) |
           (to_byte(filmic(radiance.z * exposure)) << 16) | 0xff000000u;
}
MYRIAD_END

#endif
