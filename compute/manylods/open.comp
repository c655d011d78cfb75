#version 460
#extension GL_GOOGLE_include_directive : require
// The node-view kernel of ManyLoDs 3.1, basic approach.
//
// Queues. An *active* item (block, view) says: in this view, the inner node that owns the block is not valid; look at its
// children. Each child goes one of three ways: it is *open* and its own block becomes an item of the next active list; it
// is *drawn*, being valid or a leaf; or it is *culled*. Drawn and culled children together make one group of the kept list,
// the paper's inactive list I (cut_io.h).
//
// Invariants. Every (leaf, view) has exactly one ancestor-or-self among {active items' children} + {groups}: each step
// replaces an item by all of its children. Children exist once, so no node-view is ever made twice. After `levels` steps no
// item is active, since leaves are never open.
//
// The paper tests one node-view a thread and appends its children; testing the children of a block at once reads the
// pair, the view and the frame once for up to eight node-views, and writes one group for them.
#include "compute/append/append.glsl"
#include "compute/manylods/open.glsl"
layout(push_constant, scalar) uniform Push { ManyLodsPush push; };

void main() {
    const uint item = append_item();
    uvec2 pair = uvec2(0u);
    if (append_has(item, push.lists)) pair = push.lists.items.at[item];
    uint found = 0u;
    if (append_decides(item, push.lists)) found = open_block(pair.x, push.views.at[pair.y], push.tree, push.epsilon, push.map_size);
    found = append_payload(item, found, push.lists);

    const uint kept = found & 0xffffu;
    uint open = found >> 16;
    const uvec2 at = append_reserve(item, uvec2(bitCount(open), kept != 0u ? 1u : 0u), push.lists);
    if (!append_writes) return;
    if (kept != 0u) append_kept(at.y, cut_pack(pair.x, pair.y, kept), push.lists);
    for (uint next = at.x; open != 0u; ++next, open &= open - 1u)
        append_next(next, uvec2(bsh_arity * pair.x + findLSB(open) - push.tree.leaves, pair.y), push.lists);
}
