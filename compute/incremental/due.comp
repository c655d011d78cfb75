#version 460
#extension GL_GOOGLE_include_directive : require
// Sorts out the items that are due: those that a moved view may have brought to another side of the criterion or of the frustum.
#include "compute/incremental/evaluate.glsl"

void main() {
    const uint item = append_item();
    uint found = 0u;
    if (append_decides(item, push.lists)) {
        CarriedRefs memory = push.memory.at[0];
        const uvec2 code = memory.codes.at[item];
        if (!cut_is_hole(code)) {
            const CutGroup group = cut_unpack(code);
            const Travel t = memory.travels.at[group.view - push.first_view];
            const bool moved = (t.flags & travel_moved) != 0u || (push.flags & carry_bounds) != 0u;
            found = (push.flags & carry_all) != 0u || is_due(memory.dues.at[item], t, way_of(group.block), moved) ? 1u : 0u;
        }
    }
    found = append_payload(item, found, push.lists);
    const uvec2 at = append_reserve(item, uvec2(found, 0u), push.lists);
    if (append_writes && found != 0u) append_next(at.x, uvec2(item, 0u), push.lists);
}
