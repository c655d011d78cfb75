// What the kernels that share maps between views, their host and their twin share; see README.md.
#ifndef MYRIAD_PASSES_FUSE_IO_H
#define MYRIAD_PASSES_FUSE_IO_H

#include "compute/append/append_io.h"
#include "compute/manylods/cut_io.h"
#include "compute/view_tree/view_tree_io.h"
#include "compute/views/paraboloid.h"
#include "passes/fuse/shared_map.h"
#include "passes/splat/splat_io.h"

MYRIAD_BEGIN
// "fuse/reach": one invocation a level. The inner nodes above views [first, first + limit): of a level neighbours, for nodes follow the curve.
struct FuseReachPush {
    ViewGroups groups;
    ViewLevels levels;
    ViewLevels reached;
    Uints inner_nodes;  // inner_nodes.at[0]: of all levels
    uint view_capacity, inner, first, limit;
};

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
    Uints inner_nodes;
    AppendStates lists;
    Uints needed;       // needed.at[0]: maps of inner nodes
    uint room;
};

// "fuse/inherit": one invocation a reached inner node of a level, the root's level first.
struct FuseInheritPush {
    ViewGroups groups;
    ViewLevels levels;
    Uints marks;
    Uints above;        // by node: the nearest node above it that has a map, or fuse_no_map
    uint level, view_capacity, inner;
};

// "fuse/fuse": fuse_threads invocations a node. Of a level's reached inner nodes, or of views [first, first + limit).
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

// "fuse/ask": one invocation a view of [first, first + limit).
struct FuseAskPush {
    Views nodes;
    Uints count;
    Uints places;
    Uints above;
    SharedMapArray shared_maps;
    uint view_capacity, map_size, first, limit;
};
MYRIAD_END

#endif
