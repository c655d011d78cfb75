// What the kernels that share maps between views, their host and their twin share; see README.md.
#ifndef MYRIAD_PASSES_FUSE_IO_H
#define MYRIAD_PASSES_FUSE_IO_H

#include "compute/append/append_io.h"
#include "compute/manylods/cut_io.h"
#include "compute/view_tree/view_tree_io.h"
#include "compute/views/paraboloid.h"
#include "passes/splat/splat_io.h"

MYRIAD_BEGIN
const uint fuse_no_map = 0xffffffffu;

// "fuse/mark": one invocation a group of the kept list. Inner view nodes that something is drawn for get a map.
struct FuseMarkPush {
    Uint2s groups;
    Uints count;
    Uints marks;        // by inner node: 1
    uint capacity;      // of the kept list
    uint view_capacity;
};

// "fuse/count": one invocation, after a scan of the marks. Whether there are maps enough; if not the lists fail.
struct FuseCountPush {
    Uints places;       // by inner node, then the total
    AppendStates lists;
    Uints needed;       // needed.at[0]: maps of inner nodes
    uint inner, room;
};

// "fuse/inherit": one invocation an inner node of a level, the root's level first.
struct FuseInheritPush {
    ViewGroups groups;
    ViewLevels levels;
    Uints marks;
    Uints above;        // by node: the nearest node above it that has a map, or fuse_no_map
    uint level, view_capacity, inner;
};

// "fuse/fuse": fuse_threads invocations a node. Of a level's inner nodes, or of views [first, first + limit).
const uint fuse_threads = 32u;
struct FusePush {
    Views nodes;
    ViewLevels levels;
    Uints count;        // of views
    Uints marks;
    Uints places;
    Uints above;
    Uints failed;
    Uints atlas;
    uint level;         // fuse_of_views: of views
    uint view_capacity, inner, map_size, first, limit;   // maps from `limit` on are shared
};
const uint fuse_of_views = 0xffffffffu;

// The depth that a texel has in a map at `offset` from the one that shows it at depth t, its middle towards the unit direction w: the surface stays
// where it is, the texel is the same (MegaViews 3.2, "fusion").
MYRIAD_FN float fused_depth(vec3 offset, vec3 w, float t) {
    const vec3 q = t * w - offset;
    return sqrt(q.x * q.x + q.y * q.y + q.z * q.z);
}
MYRIAD_END

#endif
