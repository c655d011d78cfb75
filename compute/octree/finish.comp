#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation: where the levels are, and the end of the last leaf. Runs between the scan and "octree/write", which changes the counters.
#include "compute/sort/sort_io.h"
#include "compute/octree/octree_io.h"
layout(local_size_x = 1) in;
layout(constant_id = 2) const uint tile_items = 1024u;
layout(push_constant, scalar) uniform Push { OctreeBuildPush push; };

void main() {
    const uint items = push.count.at[0], columns = sort_columns(sort_tiles(items, tile_items));
    const uint nodes = push.counters.at[(push.depth + 1u) * columns];
    const bool fits = nodes <= push.capacity;
    for (uint level = 0u; level <= octree_max_levels; ++level) {
        const uint begin = level <= push.depth ? push.counters.at[level * columns] : nodes;
        const uint end = level < push.depth ? push.counters.at[(level + 1u) * columns] : nodes;
        push.state.at[0].first[level] = fits ? begin : 0u;
        if (level < octree_max_levels) push.state.at[0].count[level] = fits ? end - begin : 0u;
    }
    push.state.at[0].items = fits ? items : 0u;
    push.state.at[0].needed = nodes;
    push.state.at[0].failed = fits ? 0u : octree_overflow;
    push.first.at[fits ? nodes : 0u] = fits ? nodes + items : 0u;
}
