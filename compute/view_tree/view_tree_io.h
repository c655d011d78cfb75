// The tree over views (MegaViews 3.1), as kernels see it; see README.md.
#ifndef MYRIAD_COMPUTE_VIEW_TREE_IO_H
#define MYRIAD_COMPUTE_VIEW_TREE_IO_H

#include "compute/append/append_io.h"
#include "compute/octree/octree.h"
#include "compute/views/view_io.h"

MYRIAD_BEGIN
// A node is a number: below the tree's capacity a view, by its place along the curve; from there on an inner node, level by level from the root.
// So one array of Views holds them all: an inner node's has the middle of its views' places, and a cone that holds all their frustums.
const uint view_tree_most = 8u;          // children
const uint view_tree_curve_bits = 16u;   // a coordinate: depth of the octree that the curve goes through
// Splits along the curve, then of views that are in one cell of it, by number.
const uint view_tree_levels = view_tree_curve_bits + 8u;

struct ViewGroup {
    float radius;           // of a sphere around its views' places; 0: they are one place
    uint first_child;       // node
    uint children;          // 1 to view_tree_most
    uint first, end;        // views
};
MYRIAD_ARRAY(ViewGroups, ViewGroup, 4)

// The box around the views' places; low > high where none of them sees anything.
struct ViewBox {
    vec3 low, high;
};
MYRIAD_ARRAY(ViewBoxes, ViewBox, 4)

// Inner nodes [first, first + count) of a level.
struct ViewLevel {
    uint first, count;
};
MYRIAD_ARRAY(ViewLevels, ViewLevel, 4)

MYRIAD_FN bool view_sees_nothing(View view) { return view.position.x >= 1e14f; }  // view_of_nothing

// The key on the curve of a place, in a cube of 2^view_tree_curve_bits cells a side: of what sees nothing the last one.
MYRIAD_FN uvec2 view_key(View view, OctreeCube cube) {
    if (view_sees_nothing(view)) return octree_key(uvec3((1u << view_tree_curve_bits) - 1u));
    return octree_key(octree_cell(view.position, cube, view_tree_curve_bits));
}
// Two different keys part at some level; there they are in different octants.
MYRIAD_FN uint view_key_octant(uvec2 key, uint parting) { return octree_ancestor(key, view_tree_curve_bits - parting).x & 7u; }

// "view_tree/keys": one invocation a view. "view_tree/place": likewise, after the sort.
struct ViewKeysPush {
    Views views;
    Uints count;
    Uint2s keys;
    Uints order;
    OctreeCube cube;
    uint limit;
};
struct ViewPlacePush {
    Views views;
    Uints count;
    Uints order;        // by place along the curve: which view
    Views nodes;
    uint limit;
};

// "view_tree/split": one item an inner node, views (first, count) of the curve; a step a level.
struct ViewSplitPush {
    AppendRef lists;
    Uint2s keys;
    Uints count;
    ViewGroups groups;
    ViewLevels levels;
    uint level;
    uint capacity;      // of views: where inner nodes' numbers begin
    uint inner;         // room for inner nodes
};

// "view_tree/merge": one invocation an inner node of a level, the deepest level first.
struct ViewMergePush {
    Views nodes;
    ViewGroups groups;
    ViewBoxes boxes;    // by inner node
    ViewLevels levels;
    uint level, capacity, inner;
};
MYRIAD_END

#endif
