#version 460
#extension GL_GOOGLE_include_directive : require
#include "engine/kernel.glsl"
#include "passes/compose/compose_io.h"
layout(push_constant, scalar) uniform Push { ComposePush push; };

void main() {
    const uint i = thread_index();
    if (i >= push.count) return;
    vec3 indirect = vec3(0.0f);
    if (push.has_irradiance != 0u) indirect = push.albedo.at[i].xyz * push.irradiance.at[i].xyz * (1.0f / 3.14159265f);
    if (push.has_mirrored != 0u) indirect += push.irradiance.at[push.count + i].xyz;
    vec3 beauty = push.emitted.at[i].xyz + indirect;
    if (push.has_direct != 0u) beauty += push.direct.at[i].xyz;
    push.indirect.at[i] = vec4(indirect, 0.0f);
    push.beauty.at[i] = vec4(beauty, 1.0f);
}
