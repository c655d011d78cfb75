#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a path: chooses a light by power, a ray from it, and leaves the path's first VPL.
#include "engine/kernel.glsl"
#include "passes/vpl/vpl_io.h"
layout(push_constant, scalar) uniform Push { VplEmitPush push; };
#include "passes/vpl/path.glsl"

// The first light whose share of the power ends beyond `selection`. A light without power has no share.
uint light_for(float selection) {
    uint low = 0u;
    uint high = push.light_count - 1u;
    while (low < high) {
        const uint middle = (low + high) / 2u;
        if (push.lights.at[middle].cdf > selection) high = middle;
        else low = middle + 1u;
    }
    return low;
}

void main() {
    const uint path = thread_index();
    if (path >= push.on.paths) return;
    const float selection = path_selection(path, push.on.paths, push.on.seed);
    const uint chosen = light_for(selection);
    const Light light = push.lights.at[chosen];
    const float before = chosen > 0u ? push.lights.at[chosen - 1u].cdf : 0.0;
    // The share as stored, rounded: it is what the choice is really made by.
    const float share = light.cdf - before;
    const vec4 x = path_emission_point(path_index(path, push.on.path_bits), push.on.seed);
    const float to_path = 1.0 / (share * float(push.on.paths));

    if (light.type == light_triangle) {
        const vec2 place = triangle_point(x.xy);
        Surface s = surface_at(push.on.geometry, light.triangle, place.x, place.y);
        // What the choice of the light left over chooses the side.
        if (s.double_sided && (selection - before) / share >= 0.5) s.geometric_normal = -s.geometric_normal;
        leave_vpl(0u, path, s, pi * light.extent.x * to_path * s.emission, 0u);
    } else if (push.on.layer < push.layers) {
        const Emission e = emit_punctual(light, x);
        follow_ray(path, e.origin, e.direction, e.flux * to_path, 1u);
    }
}
