#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a texel of the finer level: a hole gets what the four coarser texels around it say, of the nearest surface among them.
#include "engine/kernel.glsl"
#include "passes/ism/ism_io.h"
layout(push_constant, scalar) uniform Push { IsmLevelPush push; };

void main() {
    const uint texels = push.fine_size * push.fine_size;
    const uint half_map = thread_index() / texels, at = thread_index() % texels;
    if (half_map >= push.halves || push.fine.at[thread_index()] != atlas_nothing) return;
    const uvec4 from = half_map * push.coarse_size * push.coarse_size + ism_around(at % push.fine_size, at / push.fine_size, push.coarse_size);
    const vec4 depth = vec4(uintBitsToFloat(push.coarse.at[from.x]), uintBitsToFloat(push.coarse.at[from.y]), uintBitsToFloat(push.coarse.at[from.z]),
                            uintBitsToFloat(push.coarse.at[from.w]));
    push.fine.at[thread_index()] = floatBitsToUint(ism_mean(depth, ism_weights, push.threshold));
}
