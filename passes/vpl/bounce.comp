#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a path: goes on from the VPL in the layer below, if there is one, in a direction by cosine. The path
// is its VPLs: position, normal and flux are all that a diffuse path knows. A dispatch for each bounce instead of a loop
// keeps an invocation to one ray, far from any limit on loops.
#include "engine/kernel.glsl"
#include "passes/vpl/vpl_io.h"
layout(push_constant, scalar) uniform Push { VplBouncePush push; };
#include "passes/vpl/path.glsl"

void main() {
    const uint path = thread_index();
    if (path >= push.on.paths) return;
    const uint below = (push.on.layer - 1u) * push.on.paths + path;
    if (push.on.alive.at[below] == 0u) return;
    const Vpl from = push.on.slots.at[below];
    const uint index = path_index(path, push.on.path_bits);
    const vec2 x = from.bounce == 0u ? path_emission_point(index, push.on.seed).zw
                                     : path_bounce_point(index, from.bounce, push.on.seed);
    follow_ray(path, from.position, cosine_direction(x, unpack_direction(from.normal)), from.flux, from.bounce + 1u);
}
