#version 460
#extension GL_GOOGLE_include_directive : require
// A workgroup draws points of one view, an invocation `points_a_thread` of them.
#include "engine/kernel.glsl"
#include "passes/ism/ism_io.h"
layout(constant_id = 2) const uint points_a_thread = 8u;
layout(push_constant, scalar) uniform Push { IsmSplatPush push; };

void draw_half(IsmDisc s, uint half_index, uint map) {
    const Footprint f = footprint(half_index, s.d, s.radius);
    const uint size = push.map_size;
    const uint x0 = splat_first(f.center.x - f.radius, size), x1 = splat_end(f.center.x + f.radius, size);
    const uint y0 = splat_first(f.center.y - f.radius, size), y1 = splat_end(f.center.y + f.radius, size);
    if (x0 >= x1) return;
    uint x = x0;
    for (uint y = y0; y < y1;) {
        const float depth = ism_depth(s, unproject(half_index, texel_middle(x, y, size)));
        if (depth > 0.0f) atomicMin(push.atlas.at[map + texel_index(half_index, x, y, size)], floatBitsToUint(depth));
        ++x;
        if (x == x1) {
            x = x0;
            ++y;
        }
    }
}

void main() {
    const uint v = push.first_view + workgroup_index() / push.groups_a_view;
    if (v >= min(push.first_view + push.limit, push.count.at[0])) return;
    const View view = push.views.at[v];
    const uint map = (v - push.first_view) * map_texels(push.map_size);
    uint i = (workgroup_index() % push.groups_a_view) * gl_WorkGroupSize.x * points_a_thread + gl_LocalInvocationIndex;
    for (uint k = 0u; k < points_a_thread; ++k, i += gl_WorkGroupSize.x) {
        if (i >= push.subset) return;
        const IsmPoint p = push.points.at[ism_chosen(v, i, push.subset, push.samples, push.seed)];
        const IsmDisc s = ism_disc(view, p, push.radius);
        if (s.height == 0.0f || outside_frustum(view, s.d, s.radius) || !opacity_in_view(ism_missing(p), v)) continue;
        const uint near = half_of(s.d);
        draw_half(s, near, map);
        if (splat_in_both(s.d, s.radius, push.map_size)) draw_half(s, 1u - near, map);
    }
}
