// Packing that both languages share.
#ifndef MYRIAD_COMPUTE_PACKING_H
#define MYRIAD_COMPUTE_PACKING_H

#include "engine/shared.h"

MYRIAD_BEGIN
MYRIAD_FN float sign_not_zero(float v) { return v < 0.0f ? -1.0f : 1.0f; }

// Octahedral map of directions to the square [-1, 1]^2 (Cigolle et al. 2014), and back to unit vectors. The vector must not be zero.
MYRIAD_FN vec2 oct_fold(vec3 d) {
    const float sum = abs(d.x) + abs(d.y) + abs(d.z);
    const float u = d.x / sum;
    const float v = d.y / sum;
    if (d.z >= 0.0f) return vec2(u, v);
    return vec2((1.0f - abs(v)) * sign_not_zero(u), (1.0f - abs(u)) * sign_not_zero(v));
}
MYRIAD_FN vec3 oct_unfold(float u, float v) {
    const float z = 1.0f - abs(u) - abs(v);
    float x = u;
    float y = v;
    if (z < 0.0f) {
        x = (1.0f - abs(v)) * sign_not_zero(u);
        y = (1.0f - abs(u)) * sign_not_zero(v);
    }
    return vec3(x, y, z) / sqrt(x * x + y * y + z * z);
}

// A direction in 16 + 16 bits, 32767 steps each side of 0x8000, so that the axes are exact; the largest error is about 4e-5 rad.
// A vector of zero length maps to +z.
MYRIAD_FN uint pack_direction(vec3 d) {
    if (!(abs(d.x) + abs(d.y) + abs(d.z) > 0.0f)) return 0x80008000u;
    const vec2 p = oct_fold(d);
    return uint(int(floor(p.x * 32767.0f + 0.5f)) + 0x8000) | (uint(int(floor(p.y * 32767.0f + 0.5f)) + 0x8000) << 16);
}
MYRIAD_FN vec3 unpack_direction(uint packed) {
    return oct_unfold(float(int(packed & 0xffffu) - 0x8000) / 32767.0f, float(int(packed >> 16) - 0x8000) / 32767.0f);
}
MYRIAD_END

#endif
