#version 460
#extension GL_GOOGLE_include_directive : require
// Splits ranges of the curve into the octants that its first and last key part at, so that no node has a single inner child; ranges of one key,
// by number. A range of at most view_tree_most views is split into these.
#include "compute/append/append.glsl"
#include "compute/view_tree/view_tree_io.h"
layout(push_constant, scalar) uniform Push { ViewSplitPush push; };

// The first view of [first, end) whose octant is at least `octant`.
uint first_of(uint octant, uint parting, uint first, uint end) {
    while (first < end) {
        const uint middle = (first + end) / 2u;
        if (view_key_octant(push.keys.at[middle], parting) < octant) first = middle + 1u;
        else end = middle;
    }
    return first;
}

void main() {
    const uint item = append_item();
    const bool has = append_has(item, push.lists);
    uvec2 range = uvec2(0u);
    if (has) range = push.level == 0u ? uvec2(0u, min(push.count.at[0], push.capacity)) : push.lists.items.at[item];

    // Where the children begin, and where the last one ends.
    uint ends[view_tree_most + 1u];
    ends[0] = range.x;
    uint children = 0u;
    const bool leaf = range.y <= view_tree_most;
    if (has && !leaf) {
        const uint end = range.x + range.y;
        const uvec2 low = push.keys.at[range.x];
        const uvec2 high = push.keys.at[end - 1u];
        const uint parting = octree_parting(low, high, view_tree_curve_bits);
        for (uint i = 1u; i <= view_tree_most; ++i) {
            uint at = end;
            if (low == high) at = range.x + uint((float(range.y) * float(i)) / float(view_tree_most));
            else if (i < view_tree_most) at = first_of(i, parting, ends[children], end);
            if (i == view_tree_most) at = end;
            if (at > ends[children]) ends[++children] = at;
        }
    }
    const uvec2 at = append_reserve(item, uvec2(children, 0u), push.lists);
    if (!append_writes || !has) return;
    const ViewLevel level = push.levels.at[push.level];
    const uint items = push.lists.state.at[0].items;
    const uint next = push.level == 0u ? push.capacity + 1u : level.first + items;
    if (item == 0u) {
        if (push.level == 0u) push.levels.at[0].first = push.capacity;
        push.levels.at[push.level].count = items;
        push.levels.at[push.level + 1u].first = next;
    }
    const uint node = (push.level == 0u ? push.capacity : level.first) + item;
    if (node - push.capacity < push.inner)
        push.groups.at[node - push.capacity] = ViewGroup(0.0f, leaf ? range.x : next + at.x, leaf ? range.y : children, range.x, range.x + range.y);
    for (uint i = 0u; i < children; ++i) append_next(at.x + i, uvec2(ends[i], ends[i + 1u] - ends[i]), push.lists);
}
