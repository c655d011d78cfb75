// What the ManyLoDs kernels and their host share.
#ifndef MYRIAD_COMPUTE_MANYLODS_IO_H
#define MYRIAD_COMPUTE_MANYLODS_IO_H

#include "compute/append/append_io.h"
#include "compute/bsh/bsh_io.h"
#include "compute/manylods/cut_io.h"
#include "compute/views/paraboloid.h"
#include "compute/views/parallel.h"
#include "compute/views/pinhole.h"

MYRIAD_BEGIN
// "manylods/seed" and "manylods/open".
struct ManyLodsPush {
    AppendRef lists;     // active and next: (block, view), an inner node to open; kept: groups of the cut
    BshRef tree;
    Views views;
    float epsilon;       // texels: a node-view is valid when its criterion is below
    uint map_size;       // texels a side of a half map
    uint first_view;     // seed: the view of item 0
};

// "manylods/walk": one depth-first walk a view.
struct WalkPush {
    BshRef tree;
    Views views;
    Uint2s kept;
    AppendStates state;
    Uints count;
    float epsilon;
    uint map_size;
    uint kept_capacity;
    uint first_view, limit;
};

// Where one node-view goes (ManyLoDs 3.1, on the exact stereographic size of the spec). A node `height` levels above the leaves that is not
// open has no open node below it, in floating point: closed nodes' descendants are closed (paraboloid.h says why).
const uint node_view_open = 0u;
const uint node_view_drawn = 1u;
const uint node_view_culled = 2u;
MYRIAD_FN uint classify(View view, Sphere sphere, uint height, float epsilon, uint map_size) {
    if (is_parallel(view)) return height == 0u || parallel_fits(view, sphere.radius, map_size, epsilon) ? node_view_drawn : node_view_open;
    const vec3 d = sphere.center - view.position;
    if (is_pinhole(view)) {
        const Pinhole p = pinhole_of(view, map_size);
        if (pinhole_outside(p, d, cull_radius(d, sphere.radius, height))) return node_view_culled;
        return height == 0u || pinhole_fits(p, d, sphere.radius, epsilon) ? node_view_drawn : node_view_open;
    }
    if (outside_frustum(view, d, cull_radius(d, sphere.radius, height))) return node_view_culled;
    return height == 0u || fits(d, sphere.radius, map_size, epsilon) ? node_view_drawn : node_view_open;
}

// Of a block's children in one word: drawn | culled << 8 | open << 16, a bit a slot; this is slot 0's.
MYRIAD_FN uint node_view_bit(uint where) {
    return where == node_view_drawn ? 0x1u : where == node_view_culled ? 0x100u : 0x10000u;
}
MYRIAD_FN uint classify_child(View view, vec4 frame, uvec2 code, uint height, float epsilon, uint map_size) {
    if (bsh_is_absent(code)) return 0u;
    return node_view_bit(classify(view, bsh_decode(frame, code), height, epsilon, map_size));
}
MYRIAD_END

#endif
