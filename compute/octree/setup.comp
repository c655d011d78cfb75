#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation: the grid over tiles and the length of the scan, from a length that only the device knows.
#include "compute/sort/sort_io.h"
#include "compute/octree/octree_io.h"
layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Push { OctreeSetupPush push; };

void main() {
    const uint items = min(push.item_count.at[0], push.max_items);
    const uint columns = sort_columns(sort_tiles(items, push.tile));
    push.args.at[0] = sort_grid(columns, push.group_size, push.workgroup_size);
    push.counts.at[octree_count_items] = items;
    push.counts.at[octree_count_counters] = columns * push.levels;
}
