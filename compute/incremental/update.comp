#version 460
#extension GL_GOOGLE_include_directive : require
// The kernel of ManyLoDs 3.2, on items that are due. Each decides for itself.
//
// An item (block, view) says: in this view the inner node that owns the block is open. If it is not any more, the item goes, and so does every
// item below it, for their owners are closed too (manylods_io.h). Nobody has to hand the parent up, as the first child does in the
// paper: the item of the parent's block is there, and finds one child more that is closed. If the owner is still open, each child is
// looked at; one that was closed and is open now brings its own block to the active list.
//
// Invariant. Before and after, the items of a view are the blocks that are open in it, each once, together with all above them.
#include "compute/incremental/evaluate.glsl"

const uint dropped = 1u << 24;

void main() {
    CarriedRefs memory = push.memory.at[0];
    const uint index = append_item();
    uint item = 0u;
    if (append_has(index, push.lists)) item = push.lists.items.at[index].x;
    uint found = 0u;  // opened children << 16 | dropped
    int change = 0;
    const uvec2 code = memory.codes.at[item];
    const CutGroup group = cut_unpack(code);
    if (append_decides(index, push.lists)) {
        const Travel t = memory.travels.at[group.view - push.first_view];
        const bool exists = (t.flags & travel_exists) != 0u;
        const bool root = group.block == push.blocks;
        Evaluation e = Evaluation(cut_no_view, root, slack_begin(vec3(0.0f)));
        if (exists) e = evaluate(group.block, push.views.at[group.view]);
        const uint old = group.drawn | group.culled;
        change = (e.open ? members(group.block, e.found & 0xffffu) : 0) - members(group.block, group.drawn | (group.culled << 8));
        if (e.open) {
            found = e.found & (old << 16);
            const uvec2 now = cut_pack(group.block, group.view, e.found & 0xffffu);
            if (now != code) memory.changed.at[group.view - push.first_view] = 1u;
            memory.codes.at[item] = now;
            memory.dues.at[item] = due_after(t, shift_of(group.block).way, e.slack);
        } else {
            found = dropped;
            memory.changed.at[group.view - push.first_view] = 1u;
        }
    }
    if (append_pass != append_pass_write) count_members(change);
    found = append_payload(index, found, push.lists);

    uint open = (found >> 16) & 0xffu;
    const uvec2 at = append_reserve(index, uvec2(bitCount(open), (found & dropped) != 0u ? 1u : 0u), push.lists);
    if (!append_writes) return;
    if ((found & dropped) != 0u) {
        memory.free.at[memory.state.at[0].holes + at.y] = item;
        memory.codes.at[item] = cut_hole();
    }
    for (uint next = at.x; open != 0u; ++next, open &= open - 1u)
        append_next(next, uvec2(bsh_block_of(bsh_arity * group.block + findLSB(open), shape()), group.view), push.lists);
}
