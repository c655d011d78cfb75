#version 460
#extension GL_GOOGLE_include_directive : require
// Which nodes of each level are above the views that maps are made for; and how many inner nodes there are.
#include "engine/kernel.glsl"
#include "passes/fuse/fuse_io.h"
layout(push_constant, scalar) uniform Push { FuseReachPush push; };

// The first of a level's nodes that has views at `view` or after it.
uint first_beyond(uint view, uint first, uint end) {
    while (first < end) {
        const uint middle = (first + end) / 2u;
        if (push.groups.at[middle].end <= view) first = middle + 1u;
        else end = middle;
    }
    return first;
}

void main() {
    const uint i = thread_index();
    if (i >= view_tree_levels) return;
    const ViewLevel level = push.levels.at[i];
    const uint first = min(level.first - push.view_capacity, push.inner);
    const uint end = min(first + level.count, push.inner);
    const uint begin = first_beyond(push.first, first, end);
    uint last = first_beyond(push.first + push.limit - 1u, begin, end);  // holds the last view, or is past all
    if (last < end && push.groups.at[last].first < push.first + push.limit) ++last;
    push.reached.at[i] = ViewLevel(push.view_capacity + begin, level.count == 0u ? 0u : last - begin);
    if (level.count != 0u && push.levels.at[i + 1u].count == 0u) push.inner_nodes.at[0] = end;  // nodes are numbered level by level
}
