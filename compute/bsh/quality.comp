#version 460
#extension GL_GOOGLE_include_directive : require
// How tightly a tree holds its leaves. An invocation sums every bsh_quality_sums-th block in order, and the host the sums: the same bits
// every time.
#include "engine/kernel.glsl"
#include "compute/bsh/bsh_build.h"
layout(push_constant, scalar) uniform Push { BshQualityPush push; };

void main() {
    if (thread_index() >= bsh_quality_sums) return;
    vec2 sum = vec2(0.0);
    for (uint block = thread_index(); block < push.blocks; block += bsh_quality_sums) {
        const float own = push.merged.at[block].w;
        float children = 0.0;
        for (uint i = 0u; i < bsh_arity; ++i) {
            const uvec2 code = push.spheres.at[bsh_arity * block + i];
            const float share = own > 0.0 && !bsh_is_absent(code) ? uintBitsToFloat((code.y >> 16) << 15) / own : 0.0;
            children += share * share * share;
        }
        sum += vec2(children, own * own);
    }
    push.sums.at[thread_index()] = sum;
}
