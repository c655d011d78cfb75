// What both kernels of the traversal do with pairs.
#include "compute/append/append.glsl"
#include "compute/megaviews/megaviews_io.h"
#include "compute/svo/tree.glsl"
layout(push_constant, scalar) uniform Push { PairPush push; };

BshShape shape() { return BshShape(push.leaves, push.blocks); }

// A view node's radius, and the views below it that are wanted.
struct ViewBound {
    float radius;
    uint views;
};
ViewBound view_bound(uint node) {
    uint first = node;
    uint end = node + 1u;
    float radius = 0.0f;
    if (node >= push.capacity) {
        PairRefs memory = push.memory.at[0];
        const ViewGroup g = memory.groups.at[node - push.capacity];
        radius = g.radius;
        first = g.first;
        end = g.end;
    }
    first = max(first, push.first);
    end = min(end, push.end);
    return ViewBound(radius, end > first ? end - first : 0u);
}

// All lanes together; wraps are carried.
void count_up(uint step, uint tested, uint culled, uint edge_on, uint rendered, uint shared_views) {
    PairRefs memory = push.memory.at[0];
    const uvec4 sums = uvec4(group_sum(tested), group_sum(culled), group_sum(rendered), group_sum(shared_views));
    const uint group_edge_on = group_sum(edge_on);
    if (!group_elect() || sums.x == 0u) return;
    uint before = atomicAdd(memory.counts.at[step].tested[0], sums.x);
    if (before + sums.x < before) atomicAdd(memory.counts.at[step].tested[1], 1u);
    if (sums.y != 0u) {
        before = atomicAdd(memory.counts.at[step].culled[0], sums.y);
        if (before + sums.y < before) atomicAdd(memory.counts.at[step].culled[1], 1u);
    }
    if (group_edge_on != 0u) {
        before = atomicAdd(memory.counts.at[step].edge_on[0], group_edge_on);
        if (before + group_edge_on < before) atomicAdd(memory.counts.at[step].edge_on[1], 1u);
    }
    if (sums.z == 0u) return;
    before = atomicAdd(memory.counts.at[step].rendered[0], sums.z);
    if (before + sums.z < before) atomicAdd(memory.counts.at[step].rendered[1], 1u);
    before = atomicAdd(memory.counts.at[step].sharing[0], sums.w);
    if (before + sums.w < before) atomicAdd(memory.counts.at[step].sharing[1], 1u);
}

const uint one_edge_on = 1u << 25;
uint count_edge_on(uint found) { return found >> 25; }
// What becomes of a pair, as bit i; `index`: where the scene node's cone is.
uint pair_fate(uint where, View view, Sphere sphere, uint index, uint i) {
    if (where == pair_drawn && pair_edge_on(view, sphere, push.memory.at[0].cones.at[index])) return one_edge_on;
    return pair_bit(where) << i;
}
