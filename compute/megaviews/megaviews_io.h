// What the kernels of the double traversal and their host share, and the formulae of its decisions; see README.md.
#ifndef MYRIAD_COMPUTE_MEGAVIEWS_IO_H
#define MYRIAD_COMPUTE_MEGAVIEWS_IO_H

#include "compute/append/append_io.h"
#include "compute/bsh/bsh_io.h"
#include "compute/manylods/cut_io.h"
#include "compute/view_tree/view_tree_io.h"
#include "compute/views/paraboloid.h"
#include "compute/views/splat_plane.h"

MYRIAD_BEGIN
// Of one step of the traversal. Low and high words.
struct PairCounts {
    uint tested[2];      // pairs
    uint culled[2];
    uint edge_on[2];     // would be rendered, and cover nothing
    uint rendered[2];
    uint sharing[2];      // views below the view nodes of rendered pairs
};
MYRIAD_ARRAY(PairCountsArray, PairCounts, 4)

// Memory that push constants point to.
struct PairRefs {
    Views nodes;         // of the view tree
    ViewGroups groups;
    PairCountsArray counts;  // by step
    Uints cones;         // of the scene's tree, by slot
};
MYRIAD_ARRAY(PairRefsArray, PairRefs, 8)

// "megaviews/seed", "megaviews/open". Active and next: (slot of a scene node, view node), an open pair. Kept: cut groups (cut_io.h), whose view
// is a view node.
struct PairPush {
    AppendRef lists;
    Float4s frames;      // of the scene's tree, as in BshRef
    Uint2s spheres;
    PairRefsArray memory;
    uint leaves, blocks;
    float epsilon;       // texels
    uint map_size;
    uint capacity;       // of the view tree
    uint first, end;     // views, along the curve, that maps are made for; view nodes without any are left out
    uint step;
};

// Whether a scene node in a sphere of radius r, at d from the middle of a view node of radius R, is drawn alike in all its views, to epsilon texels
// (MegaViews 3.2, figure 6, with the exact stereographic size). The paper asks that R be no larger than r, so that moving a view moves the
// projection by no more than its own radius; here the larger of both is measured, from the place in the view node where it looks largest. For a lone
// view this is the criterion of cuts.
MYRIAD_FN bool pair_fits(vec3 d, float r, float view_radius, uint size, float epsilon) {
    if (view_radius == 0.0f) return fits(d, r, size, epsilon);
    const float rho = max(r, view_radius);
    MYRIAD_PRECISE const float l = sqrt(d.x * d.x + d.y * d.y + d.z * d.z) * (1.0f - 1.0f / 1048576.0f) - view_radius;
    MYRIAD_PRECISE const float l2 = l * l;
    MYRIAD_PRECISE const float tangent2 = l2 - rho * rho;
    if (!(l > 0.0f && tangent2 > 0.0625f * l2)) return false;
    MYRIAD_PRECISE const float c = float(size) * rho / (max(abs(d.x) - view_radius, 0.0f) + sqrt(tangent2));
    return c < epsilon;
}

// Where a pair goes. Culled: no view of the node sees anything of the sphere (figure 4, with the apex case of the spec): all frustums lie within the
// node's cone, moved by its radius at most. Drawn: alike in all of them; or neither can be split: a leaf, and views at one place.
const uint pair_open = 0u;
const uint pair_drawn = 1u;
const uint pair_culled = 2u;
MYRIAD_FN uint classify_pair(View view, float view_radius, Sphere sphere, bool leaf, uint height, float epsilon, uint map_size) {
    const vec3 d = sphere.center - view.position;
    MYRIAD_PRECISE const float around = sphere.radius + view_radius;
    if (outside_frustum(view, d, cull_radius(d, around, view_radius > 0.0f ? height + 1u : height))) return pair_culled;
    if (leaf && view_radius == 0.0f) return pair_drawn;
    return pair_fits(d, sphere.radius, view_radius, map_size, epsilon) ? pair_drawn : pair_open;
}
// Whether a pair that is drawn covers nothing, since its node is seen edge-on: so are most nodes near to a VPL, those of its own wall.
MYRIAD_FN bool pair_edge_on(View view, Sphere sphere, uint cone) {
    return splat_plane(sphere.center - view.position, sphere.radius, bsh_cone_axis(cone), (cone >> 24) == 255u).height == 0.0f;
}
// Which side of an open pair is split (figure 8): the larger. A view node that is one place has nothing to split that matters.
MYRIAD_FN bool pair_splits_views(float view_radius, float radius, bool leaf) { return view_radius > 0.0f && (leaf || view_radius > radius); }

// Of up to eight pairs in one word: drawn | culled << 8 | open << 16, a bit each; and how many are edge-on << 25.
MYRIAD_FN uint pair_bit(uint where) { return where == pair_drawn ? 0x1u : where == pair_culled ? 0x100u : 0x10000u; }
MYRIAD_END

#endif
