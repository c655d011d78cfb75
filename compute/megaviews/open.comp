#version 460
#extension GL_GOOGLE_include_directive : require
// One step of the double traversal (MegaViews 3.2): each open pair is split on its larger side, and each of the up to eight pairs that come of
// it is culled, drawn, or open in the next step.
//
// Invariant. Every (scene leaf, view) that is wanted is below exactly one among {open pairs} + {culled, edge-on and drawn pairs so far}.
#include "compute/megaviews/pairs.glsl"

const uint splits_views = 1u << 24;

void main() {
    const uint item = append_item();
    PairRefs memory = push.memory.at[0];
    uvec2 pair = uvec2(0u);
    if (append_has(item, push.lists)) pair = push.lists.items.at[item];
    const uint slot = pair.x;
    const uint node = pair.y;
    uint found = 0u;
    uint sharing = 0u;
    if (append_decides(item, push.lists)) {
        const ViewBound bound = view_bound(node);
        const TreeBlock own = tree_block(push.frames, slot >> bsh_arity_log2, shape());
        const uint index = tree_index(own, slot);
        const Sphere sphere = bsh_decode(own.frame, push.spheres.at[index]);
        const bool leaf = own.height == 0u;
        if (pair_splits_views(bound.radius, sphere.radius, leaf)) {
            found = splits_views;
            const ViewGroup group = memory.groups.at[node - push.capacity];
            for (uint i = 0u; i < group.children; ++i) {
                const uint child = group.first_child + i;
                const ViewBound part = view_bound(child);
                if (part.views == 0u) continue;
                const View lower = memory.nodes.at[child];
                const uint fate = pair_fate(classify_pair(lower, part.radius, sphere, leaf, own.height, push.epsilon, push.map_size), lower, sphere, index, i);
                found += fate;
                if ((fate & 0xffu) != 0u) sharing += part.views;
            }
        } else {
            const View view = memory.nodes.at[node];
            const TreeBlock below = tree_block(push.frames, tree_block_of(own, slot, shape()), shape());
            [[unroll]] for (uint i = 0u; i < bsh_arity; ++i) {
                if (svo_tree && i >= below.children) break;
                const uvec2 code = push.spheres.at[below.first + i];
                if (bsh_is_absent(code)) continue;
                const Sphere lower = bsh_decode(below.frame, code);
                const uint where = classify_pair(view, bound.radius, lower, below.height == 0u, below.height, push.epsilon, push.map_size);
                found += pair_fate(where, view, lower, below.first + i, i);
            }
            sharing = bitCount(found & 0xffu) * bound.views;
        }
    }
    if (append_pass != append_pass_write)
        count_up(push.step, bitCount(found & 0xffffffu) + count_edge_on(found), bitCount(found & 0xff00u), count_edge_on(found), bitCount(found & 0xffu), sharing);
    found = append_payload(item, found, push.lists);

    uint drawn = found & 0xffu;
    uint open = (found >> 16) & 0xffu;
    const bool by_view = (found & splits_views) != 0u;
    const uvec2 at = append_reserve(item, uvec2(bitCount(open), by_view ? bitCount(drawn) : drawn != 0u ? 1u : 0u), push.lists);
    if (!append_writes || (drawn | open) == 0u) return;
    uint next = at.x;
    if (by_view) {
        const uint first = memory.groups.at[node - push.capacity].first_child;
        for (uint kept = at.y; drawn != 0u; ++kept, drawn &= drawn - 1u)
            append_kept(kept, cut_pack(slot >> bsh_arity_log2, first + findLSB(drawn), 1u << (slot & (bsh_arity - 1u))), push.lists);
        for (; open != 0u; ++next, open &= open - 1u) append_next(next, uvec2(slot, first + findLSB(open)), push.lists);
    } else {
        const uint block = tree_block_of(push.frames, slot, shape());
        if (drawn != 0u) append_kept(at.y, cut_pack(block, node, drawn), push.lists);
        for (; open != 0u; ++next, open &= open - 1u) append_next(next, uvec2(bsh_arity * block + findLSB(open), node), push.lists);
    }
}
