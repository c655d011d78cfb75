#version 460
#extension GL_GOOGLE_include_directive : require
#include "engine/kernel.glsl"
#include "passes/compose/compose_io.h"
layout(push_constant, scalar) uniform Push { ComposePush push; };

void main() {
    const uint i = thread_index();
    if (i >= push.count) return;
    vec3 irradiance = vec3(0.0f);
    vec3 mirrored = vec3(0.0f);
    if (push.has_irradiance != 0u) irradiance = push.irradiance.at[i].xyz;
    if (push.has_natural != 0u) irradiance += push.natural.at[i].xyz;
    if (push.has_beyond != 0u) irradiance += push.beyond.at[i].xyz;
    if (push.has_mirrored != 0u && push.has_irradiance != 0u) mirrored = push.irradiance.at[push.count + i].xyz;
    if (push.has_mirrored != 0u && push.has_natural != 0u) mirrored += push.natural.at[push.count + i].xyz;
    const vec3 indirect = push.albedo.at[i].xyz * irradiance * (1.0f / 3.14159265f) + mirrored;
    vec3 direct = vec3(0.0f);
    if (push.has_direct != 0u) direct = push.direct.at[i].xyz;
    if (push.has_lamps != 0u) {
        direct += push.albedo.at[i].xyz * push.lamps.at[i].xyz * (1.0f / 3.14159265f);
        if (push.has_mirrored != 0u) direct += push.lamps.at[push.count + i].xyz;
        push.all_direct.at[i] = vec4(direct, 0.0f);
    }
    vec3 beauty = push.emitted.at[i].xyz + indirect;
    if (push.has_direct != 0u || push.has_lamps != 0u) beauty += direct;
    push.indirect.at[i] = vec4(indirect, 0.0f);
    push.beauty.at[i] = vec4(beauty, 1.0f);
}
