#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a group (or, on devices that limit loops, a slot of a group: specialisation constant 2).
#include "engine/kernel.glsl"
#include "compute/svo/tree.glsl"
#include "passes/splat/splat_io.h"
layout(constant_id = 2) const uint threads_per_group = 1u;
layout(constant_id = shared_maps_constant) const bool shared_maps = false;
layout(constant_id = coverage_constant) const uint coverage = coverage_exact;
layout(push_constant, scalar) uniform Push { SplatPush push; };

void draw_half(Splat s, uint half_index, uint map, uint dice) {
    const Footprint f = footprint(half_index, s.d, s.radius);
    const uint size = push.map_size;
    if (coverage != coverage_exact && splat_is_small(f.radius * float(size))) {
        const SmallSplat small = splat_small(s, half_index, f.center, size, coverage, dice);
        if (small.depth > 0.0f) atomicMin(push.atlas.at[map + texel_index(half_index, small.x, small.y, size)], floatBitsToUint(small.depth));
        return;
    }
    const uint x0 = splat_first(f.center.x - f.radius, size), x1 = splat_end(f.center.x + f.radius, size);
    const uint y0 = splat_first(f.center.y - f.radius, size), y1 = splat_end(f.center.y + f.radius, size);
    if (x0 >= x1) return;
    // One loop over the rectangle, not two: lanes whose rectangles differ in shape stay together.
    uint x = x0;
    for (uint y = y0; y < y1;) {
        const float depth = splat_depth(s, unproject(half_index, texel_middle(x, y, size)));
        if (depth > 0.0f) atomicMin(push.atlas.at[map + texel_index(half_index, x, y, size)], floatBitsToUint(depth));
        ++x;
        if (x == x1) {
            x = x0;
            ++y;
        }
    }
}

void draw_parallel(View view, Splat s, ParallelFrame frame, uint map, uint dice) {
    const uint columns = parallel_columns(view);
    const float texel = parallel_texel(view, push.map_size), radius = s.radius / texel;
    const vec2 middle = parallel_place(view, frame, s.d, push.map_size);
    if (coverage != coverage_exact && splat_is_small(2.0f * radius)) {
        const SmallSplat small = splat_small_parallel(s, view, frame, middle, push.map_size, coverage, dice);
        if (small.depth > 0.0f) atomicMin(push.atlas.at[map + small.y * columns + small.x], floatBitsToUint(small.depth));
        return;
    }
    const uint x0 = parallel_first(middle.x, radius, columns), x1 = parallel_end(middle.x, radius, columns);
    const uint y1 = parallel_end(middle.y, radius, parallel_rows(view, push.map_size));
    if (x0 >= x1) return;
    uint x = x0;
    for (uint y = parallel_first(middle.y, radius, parallel_rows(view, push.map_size)); y < y1;) {
        const vec3 off = ((float(x) + 0.5f - middle.x) * texel) * frame.across + ((float(y) + 0.5f - middle.y) * texel) * frame.down;
        const float depth = splat_parallel_depth(s, view.direction, off);
        if (depth > 0.0f) atomicMin(push.atlas.at[map + y * columns + x], floatBitsToUint(depth));
        ++x;
        if (x == x1) {
            x = x0;
            ++y;
        }
    }
}

void draw(View view, Sphere sphere, uint cone, uvec2 box, uint map, uint dice) {
    const Splat s = splat_of(view, sphere, cone, box);
    if (is_parallel(view)) {
        draw_parallel(view, s, parallel_frame(view.direction), map, dice);
        return;
    }
    if (s.height == 0.0f) return;  // seen edge-on
    const uint near = half_of(s.d);
    draw_half(s, near, map, dice);
    if (splat_in_both(s.d, s.radius, push.map_size)) draw_half(s, 1u - near, map, dice);
}

void main() {
    const uint index = thread_index() / threads_per_group;
    if (index >= min(push.count.at[0], push.capacity) || push.failed.at[0] != 0u) return;
    const CutGroup g = cut_unpack(push.groups.at[index]);
    uint drawn = g.drawn;
    if (threads_per_group != 1u) drawn &= 1u << (thread_index() % threads_per_group);
    if (drawn == 0u) return;
    if (push.keeps != 0u && push.changed.at[g.view - push.first_view] == 0u) return;
    const View view = push.views.at[g.view];
    const TreeBlock block = tree_block(push.tree.frames, g.block, bsh_shape(push.tree));
    uint map = g.view - push.first_view;
    if (shared_maps && g.view >= push.view_capacity) map = push.first_shared + push.places.at[g.view - push.view_capacity];
    map *= map_texels(push.map_size);
    for (; drawn != 0u; drawn &= drawn - 1u) {
        const uint node = block.first + findLSB(drawn);
        const uvec2 box = push.tree.boxes.at[node];
        if (!opacity_in_view(bsh_missing(box), g.view)) continue;
        draw(view, bsh_decode(block.frame, push.tree.spheres.at[node]), push.tree.cones.at[node], box, map, splat_dice(node, g.view));
    }
}
