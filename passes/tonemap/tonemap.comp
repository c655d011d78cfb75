#version 460
#extension GL_GOOGLE_include_directive : require
#include "engine/kernel.glsl"
#include "passes/tonemap/tonemap_io.h"
layout(push_constant, scalar) uniform Push { TonemapPush push; };

void main() {
    const uint i = thread_index();
    if (i < push.count) push.pixels.at[i] = tonemap(push.radiance.at[i].xyz, push.exposure);
}
