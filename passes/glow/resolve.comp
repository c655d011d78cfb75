#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a pixel.
#include "engine/kernel.glsl"
#include "passes/glow/glow_io.h"
layout(push_constant, scalar) uniform Push { GlowResolvePush push; };

void main() {
    const uint i = thread_index();
    if (i >= push.pixels) return;
    const vec3 glow = push.unit * vec3(float(push.sums.at[3u * i]), float(push.sums.at[3u * i + 1u]), float(push.sums.at[3u * i + 2u]));
    push.emitted.at[i].xyz += glow;
}
