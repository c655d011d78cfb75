#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a texel of the coarser level: the mean of the nearest surface among four finer ones.
#include "engine/kernel.glsl"
#include "passes/ism/ism_io.h"
layout(push_constant, scalar) uniform Push { IsmLevelPush push; };

float fine_at(uint half_map, uint x, uint y) {
    if (x >= push.fine_size || y >= push.fine_size) return ism_nothing();
    return uintBitsToFloat(push.fine.at[(half_map * push.fine_size + y) * push.fine_size + x]);
}

void main() {
    const uint texels = push.coarse_size * push.coarse_size;
    const uint half_map = thread_index() / texels, at = thread_index() % texels;
    if (half_map >= push.halves) return;
    const uint x = 2u * (at % push.coarse_size), y = 2u * (at / push.coarse_size);
    const vec4 depth = vec4(fine_at(half_map, x, y), fine_at(half_map, x + 1u, y), fine_at(half_map, x, y + 1u), fine_at(half_map, x + 1u, y + 1u));
    push.coarse.at[thread_index()] = floatBitsToUint(ism_mean(depth, vec4(1.0), push.threshold));
}
