#version 460
#extension GL_GOOGLE_include_directive : require
// Sorts out the items that are due: those that a view or bounds that moved may have brought to another side of the criterion or of the frustum.
// Of a view that rests it reads the item's code, and whether its block moved.
#include "compute/incremental/evaluate.glsl"

void main() {
    const uint item = append_item();
    uint found = 0u;
    if (append_decides(item, push.lists)) {
        CarriedRefs memory = push.memory.at[0];
        const uvec2 code = memory.codes.at[item];
        if (!cut_is_hole(code)) {
            const CutGroup group = cut_unpack(code);
            const uint view = group.view - push.first_view;
            const Travel t = memory.travels.at[view];
            const Shift shift = shift_of(group.block);
            if (shift.own && group.drawn != 0u) memory.changed.at[view] = 1u;
            if ((push.flags & carry_all) != 0u) found = 1u;
            else if (travel_stirs(t) || shift.any) found = is_due(memory.dues.at[item], t, shift.way) ? 1u : 0u;
        }
    }
    found = append_payload(item, found, push.lists);
    const uvec2 at = append_reserve(item, uvec2(found, 0u), push.lists);
    if (append_writes && found != 0u) append_next(at.x, uvec2(item, 0u), push.lists);
}
