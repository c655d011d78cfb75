#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a pixel.
#include "engine/kernel.glsl"
#include "passes/environment/environment_io.h"
layout(push_constant, scalar) uniform Push { BackgroundPush push; };

void main() {
    const uint pixel = thread_index();
    if (pixel >= push.width * push.height || push.positions.at[pixel].w != 0.0f) return;
    const vec3 d = camera_direction(push.camera, pixel % push.width, pixel / push.width, push.width, push.height);
    const EnvironmentQuad q = environment_quad(environment_place(d, push.turn), push.columns, push.rows);
    const vec3 above = mix(push.texels.at[q.index.x], push.texels.at[q.index.y], q.weight.x);
    const vec3 below = mix(push.texels.at[q.index.z], push.texels.at[q.index.w], q.weight.x);
    push.emitted.at[pixel] = vec4(mix(above, below, q.weight.y), 0.0f);
}
