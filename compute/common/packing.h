// Packing that both languages share.
#ifndef MYRIAD_COMPUTE_PACKING_H
#define MYRIAD_COMPUTE_PACKING_H

#include "engine/shared.h"

MYRIAD_BEGIN
MYRIAD_FN float sign_not_zero(float v) { return v < 0.0f ? -1.0f : 1.0f; }

// Octahedral map of unit vectors to the square [-1, 1]^2 (Cigolle et al. 2014), 16 bits a coordinate. The largest error
// is about 4e-5 rad. A vector of zero length maps to +z.
MYRIAD_FN uint pack_direction(vec3 d) {
    const float sum = abs(d.x) + abs(d.y) + abs(d.z);
    if (!(sum > 0.0f)) return 0x80008000u;
    float u = d.x / sum;
    float v = d.y / sum;
    if (d.z < 0.0f) {
        const float folded = (1.0f - abs(v)) * sign_not_zero(u);
        v = (1.0f - abs(u)) * sign_not_zero(v);
        u = folded;
    }
    // 32767 steps each side of 0x8000, so that the axes are exact.
    const uint x = uint(int(floor(u * 32767.0f + 0.5f)) + 0x8000);
    const uint y = uint(int(floor(v * 32767.0f + 0.5f)) + 0x8000);
    return x | (y << 16);
}

MYRIAD_FN vec3 unpack_direction(uint packed) {
    const float u = float(int(packed & 0xffffu) - 0x8000) / 32767.0f;
    const float v = float(int(packed >> 16) - 0x8000) / 32767.0f;
    const float z = 1.0f - abs(u) - abs(v);
    float x = u;
    float y = v;
    if (z < 0.0f) {
        x = (1.0f - abs(v)) * sign_not_zero(u);
        y = (1.0f - abs(u)) * sign_not_zero(v);
    }
    return vec3(x, y, z) / sqrt(x * x + y * y + z * z);
}
MYRIAD_END

#endif
