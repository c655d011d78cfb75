#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a slot: puts what is alive in its place, and makes its view. Who asks gets the place of a dead one that is near in the
// order of slots, or else one that nobody has had.
#include "engine/kernel.glsl"
#include "passes/vpl/vpl_io.h"
layout(push_constant, scalar) uniform Push { VplPlacesPush push; };

void main() {
    const uint slot = thread_index();
    if (slot >= push.slot_count || push.alive.at[slot] == 0u) return;
    uint place = push.places.at[slot];
    const uint rank = push.flags.at[slot];
    if (push.flags.at[slot + 1u] != rank) {
        const uint vacant = push.flags.at[2u * push.slot_count] - push.flags.at[push.slot_count];
        place = rank < vacant ? push.vacant.at[rank] : push.count.at[3] + (rank - vacant);
        if (place >= push.max_vpls) return;
        push.owners.at[place] = slot;
        push.places.at[slot] = place;
    }
    const Vpl vpl = push.slots.at[slot];
    push.vpls.at[place] = vpl;
    push.views.at[place] = View(vpl.position, 0.0, unpack_direction(vpl.normal), 1.0);  // the hemisphere: phi = pi / 2
}
