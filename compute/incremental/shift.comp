#version 460
#extension GL_GOOGLE_include_directive : require
// How far the nodes of each block have come since the last frame (slack.h), as kernels see them: decoded, with what rounding to codes does.
#include "engine/kernel.glsl"
#include "compute/incremental/incremental_io.h"
layout(push_constant, scalar) uniform Push { ShiftPush push; };

void main() {
    uint block = thread_index();
    if (block >= push.count) return;
    if (push.all == 0u) block = push.listed.at[block];
    const vec4 frame = push.frames.at[block];
    const vec4 frame_before = push.frames_before.at[block];
    const bool stays = push.first == 0u && frame == frame_before;
    if (!stays) push.frames_before.at[block] = frame;
    float centers = 0.0f;
    float radii = 0.0f;
    for (uint i = 0u; i < bsh_arity; ++i) {
        const uint slot = bsh_arity * block + i;
        const uvec2 code = push.spheres.at[slot];
        const uvec2 code_before = push.spheres_before.at[slot];
        if (stays && code == code_before) continue;
        push.spheres_before.at[slot] = code;
        if (push.first != 0u || bsh_is_absent(code)) continue;
        const Sphere now = bsh_decode(frame, code);
        const Sphere before = bsh_decode(frame_before, code_before);
        const vec3 d = now.center - before.center;
        centers = max(centers, sqrt(dot(d, d)));
        radii = max(radii, abs(now.radius - before.radius));
    }
    Way way = Way(0.0f, 0.0f, 0u);
    if (push.first == 0u) way = way_on(push.ways.at[block], centers, radii);
    way.version = push.version;  // also where spheres rest: cones and boxes may not
    push.ways.at[block] = way;
}
