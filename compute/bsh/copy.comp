#version 460
#extension GL_GOOGLE_include_directive : require
#include "engine/kernel.glsl"
#include "compute/bsh/copy_io.h"
layout(push_constant, scalar) uniform Push { BshCopyPush push; };

void main() {
    const uint i = thread_index();
    if (i < push.count) push.to.at[i] = push.from.at[i];
}
