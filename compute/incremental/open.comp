#version 460
#extension GL_GOOGLE_include_directive : require
// Opens blocks as the basic approach does (manylods/open.comp), and puts each in the carried list: into a hole while there is one, then at the
// end. In the last step of a lazy frame, children that should be opened stay in the cut, and the item is due in the next frame.
#include "compute/incremental/evaluate.glsl"

void main() {
    CarriedRefs memory = push.memory.at[0];
    const uint index = append_item();
    uvec2 pair = uvec2(0u);
    if (append_has(index, push.lists)) pair = push.lists.items.at[index];
    uint found = 0u;
    Due due = Due(0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0u);
    if (append_decides(index, push.lists)) {
        const Evaluation e = evaluate(pair.x, push.views.at[pair.y]);
        found = e.found;
        due = due_after(memory.travels.at[pair.y - push.first_view], shift_of(pair.x).way, e.slack);
        const uint late = (push.flags & carry_last) != 0u ? found >> 16 : 0u;
        if (late != 0u) {
            found = (found | late) & 0xffffu;
            due.frustum = -1.0f;
            atomicOr(memory.travels.at[pair.y - push.first_view].flags, travel_waits);
            atomicAdd(memory.state.at[0].invalid, bitCount(late));
        }
        if (append_pass == append_pass_count) memory.found.at[index] = due;
    }
    if (append_pass != append_pass_write) count_members(bitCount(found & 0xffffu));
    const bool has = append_has(index, push.lists);
    found = append_payload(index, found, push.lists);

    uint open = found >> 16;
    const uvec2 at = append_reserve(index, uvec2(bitCount(open), has ? 1u : 0u), push.lists);
    if (!append_writes || !has) return;
    if (append_pass == append_pass_write) due = memory.found.at[index];
    const uint holes = memory.state.at[0].holes;
    const uint place = at.y < holes ? memory.free.at[holes - 1u - at.y] : memory.state.at[0].items + (at.y - holes);
    if (place < push.lists.kept_capacity) {
        memory.codes.at[place] = cut_pack(pair.x, pair.y, found & 0xffffu);
        memory.dues.at[place] = due;
    }
    for (uint next = at.x; open != 0u; ++next, open &= open - 1u)
        append_next(next, uvec2(bsh_block_of(bsh_arity * pair.x + findLSB(open), shape()), pair.y), push.lists);
}
