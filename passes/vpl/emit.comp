#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a path: chooses a light by its share, a ray from it, and leaves the path's first VPL.
#include "engine/kernel.glsl"
#include "passes/vpl/vpl_io.h"
layout(push_constant, scalar) uniform Push { VplEmitPush push; };
#include "passes/vpl/path.glsl"

layout(constant_id = 2) const bool guided = false;

float share_end(uint light) { return guided ? push.shares.at[light] : push.lights.at[light].cdf; }

#include "passes/vpl/choose_light.glsl"

// Which of the guide's strips `x` falls in, one coordinate of a place: returns the place that is as far through the strip
// of the domain, where `density` times as many paths go as without a guide. Strips only get wider or narrower, in order:
// points that fill the square evenly fill each cell evenly.
float into_strip(uint first, float x, out uint strip, inout float density) {
    strip = 0u;
    for (uint step_ = guide_side / 2u; step_ > 0u; step_ /= 2u)
        if (push.cells.at[first + strip + step_ - 1u] <= x) strip += step_;
    const float before = strip > 0u ? push.cells.at[first + strip - 1u] : 0.0;
    const float width = push.cells.at[first + strip] - before;
    density *= width * float(guide_side);
    return (float(strip) + (x - before) / width) / float(guide_side);
}

vec2 guide(uint light, vec2 x, out float density) {
    density = 1.0;
    if (!guided || light >= push.guided_layers >> 8) return x;
    uint column, row;
    const float place = into_strip(light * guide_floats, x.x, column, density);
    return vec2(place, into_strip(light * guide_floats + guide_side * (column + 1u), x.y, row, density));
}

void main() {
    const uint path = thread_index();
    if (path >= push.on.paths) return;
    const float selection = path_selection(path, push.on.paths, push.on.seed);
    const uint chosen = light_for(selection, push.light_count);
    const Light light = push.lights.at[chosen];
    const float before = chosen > 0u ? share_end(chosen - 1u) : 0.0;
    // The share as stored, rounded: it is what the choice is really made by.
    const float share = share_end(chosen) - before;
    const vec4 x = path_emission_point(path_index(path, push.on.path_bits), push.on.seed);
    const float to_path = 1.0 / (share * float(push.on.paths));

    if (light.type == light_triangle) {
        const vec2 place = triangle_point(x.xy);
        // Where a cut-out is not, it does not shine; the others keep their flux, for the choice knows the whole area.
        if (trace_asks && !opacity_is_there(push.on.bvh.opacity, light.triangle, place.x, place.y, trace_dice)) return;
        Surface s = surface_at(push.on.geometry, light.triangle, place.x, place.y);
        // What the choice of the light left over chooses the side.
        if (s.double_sided && (selection - before) / share >= 0.5) s.geometric_normal = -s.geometric_normal;
        leave_vpl(0u, path, s, pi * light.extent.x * to_path * s.emission, 0u);
    } else if (push.on.layer < (push.guided_layers & 255u)) {
        float density;
        const Emission e = emit_punctual(light, guide(chosen, x.xy, density));
        follow_ray(path, e.origin, e.direction, e.flux * (to_path / density), 1u);
    }
}
