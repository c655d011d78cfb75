#version 460
#extension GL_GOOGLE_include_directive : require
// The camera's cut, drawn into the picture. Twice: first each pixel gets the least depth of all that covers it, then, of what has that depth, the
// lowest number. Both are minima of whole numbers, so the picture does not depend on who comes first.
//
// One invocation a group; on devices that limit loops, `lanes` of them: a slot of the group each, and every eighth row of what it covers.
#include "engine/group.glsl"
#include "compute/raytrace/raytrace_io.h"
#include "passes/points/points.glsl"
layout(constant_id = 2) const bool finds_what = false;  // the second time
layout(constant_id = 3) const uint lanes = 1u;
layout(constant_id = trace_asks_constant) const bool asks = false;  // some surface is not everywhere
layout(push_constant, scalar) uniform Push { PointsSplatPush push; };

const uint row_step = lanes > 8u ? lanes / 8u : 1u;

void put(uint x, uint y, float depth, uint what) {
    const uint pixel = y * push.width + x;
    const uint bits = floatBitsToUint(depth);
    const uint least = push.pixels.at[pixel];
    if (finds_what) {
        if (bits <= least + points_ulps) atomicMin(push.pixels.at[push.width * push.height + pixel], what);
    } else if (bits < least) {  // what is read may be old, and then too large, never too small
        atomicMin(push.pixels.at[pixel], bits);
    }
}

void draw_cell(PointsScene scene, uvec4 code, uint first_row) {
    const Corners at = points_corners(scene, code.x, push.camera.position);
    const vec2 a = points_corner(code.y), b = points_corner(code.z), c = points_corner(code.w);
    const PointsRect rect = points_triangle_rect(push.camera, points_cell_corners(at, a, b, c), push.width, push.height);
    if (rect.x0 >= rect.x1) return;
    const PointsCell cell = points_cell(push.camera, at, a, b, c, push.width, push.height);
    OpacityPlace place;
    bool all_there = true;
    if (asks) {
        OpacityArrays o = scene.opacity.at[0];
        place = opacity_place(o, code.x);
        all_there = o.materials.at[o.triangles.at[place.stored].w].cutoff == 0.0;
    }
    // One loop over the rectangle, not two: lanes whose rectangles differ in shape stay together.
    uint x = rect.x0;
    for (uint y = rect.y0 + first_row; y < rect.y1;) {
        const PointsHit hit = points_on(cell, float(x), float(y));
        bool covered = points_covered(hit);
        if (asks && covered && !all_there) {
            const vec2 uv = points_barycentrics(cell, hit);
            const vec2 held = points_hold(uv.x, uv.y);
            covered = opacity_is_there(scene.opacity, place, code.x, held.x, held.y, opacity_pixel(x, y));
        }
        if (covered) put(x, y, hit.t, code.x);
        ++x;
        if (x == rect.x1) {
            x = rect.x0;
            y += row_step;
        }
    }
}

void draw_leaf(uint slot, uint first_row) {
    PointsScene scene = push.scene.at[0];
    const uint end = scene.first.at[slot + 1u];
    for (uint i = scene.first.at[slot]; i < end; ++i) draw_cell(scene, scene.cells.at[i], first_row);
}

// Whether there is a surface where a leaf's sample is: the triangle's dice, so that nodes of one pane agree where they overlap.
bool sample_is_there(uint slot, uint x, uint y) {
    PointsScene scene = push.scene.at[0];
    const SurfaceSample s = scene.samples.at[slot];
    return opacity_is_there(scene.opacity, s.triangle, s.u, s.v, opacity_pixel(x, y));
}

void draw_node(uint slot, vec4 frame, uint first_row) {
    const Sphere sphere = bsh_decode(frame, push.tree.spheres.at[slot]);
    const vec3 d = sphere.center - push.camera.position;
    const PointsRect rect = points_rect(push.camera, d, sphere.radius, vec3(0.0), push.width, push.height);
    if (rect.x0 >= rect.x1) return;
    const uvec2 box = push.tree.boxes.at[slot];
    const PointsNode node = points_node(d, sphere.radius, push.tree.cones.at[slot], box);
    const bool all_there = !asks || bsh_missing(box) == 0u;
    uint x = rect.x0;
    for (uint y = rect.y0 + first_row; y < rect.y1;) {
        const vec3 w = points_ray(push.camera, float(x), float(y), push.width, push.height);
        const float depth = points_node_depth(node, w);
        if (depth > 0.0 && (all_there || sample_is_there(points_leaf_below(push.tree, slot, push.camera.position, w), x, y))) put(x, y, depth, points_inner | slot);
        ++x;
        if (x == rect.x1) {
            x = rect.x0;
            y += row_step;
        }
    }
}

void main() {
    const uint index = thread_index() / lanes, lane = thread_index() % lanes;
    CutGroup g;
    g.block = 0u;
    uint drawn = 0u;
    if (index < push.state.at[0].kept && push.state.at[0].failed == 0u) {
        g = cut_unpack(push.groups.at[index]);
        drawn = lanes == 1u ? g.drawn : g.drawn & (1u << (lane & 7u));
    }
    if (!finds_what) {
        const uint sum = group_sum(lane < 8u ? bitCount(drawn) : 0u);
        if (group_elect() && sum != 0u) atomicAdd(push.pixels.at[2u * push.width * push.height], sum);
    }
    if (drawn == 0u) return;
    const vec4 frame = push.tree.frames.at[g.block];
    for (; drawn != 0u; drawn &= drawn - 1u) {
        const uint slot = bsh_arity * g.block + findLSB(drawn);
        if (bsh_is_leaf(slot, push.tree.leaves)) draw_leaf(slot, lane >> 3);
        else draw_node(slot, frame, lane >> 3);
    }
}
