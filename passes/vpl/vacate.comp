#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a slot: lists the places of the dead, in the order of slots, and darkens them. And the counts.
#include "engine/kernel.glsl"
#include "passes/vpl/vpl_io.h"
layout(push_constant, scalar) uniform Push { VplPlacesPush push; };

void main() {
    const uint slot = thread_index();
    if (slot >= push.slot_count) return;
    const uint asking = push.flags.at[push.slot_count];  // the sum of the first half
    if (slot == 0u) {
        const uint vacant = push.flags.at[2u * push.slot_count] - asking;
        const uint before = push.count.at[0];
        const uint settled = min(asking, vacant + push.max_vpls - before);
        push.count.at[0] = before + (settled > vacant ? settled - vacant : 0u);
        push.count.at[1] = before - vacant + settled;
        push.count.at[2] = asking - settled;
        push.count.at[3] = before;
    }
    const uint rank = push.flags.at[push.slot_count + slot];
    if (push.flags.at[push.slot_count + slot + 1u] == rank) return;
    const uint place = push.places.at[slot];
    push.vacant.at[rank - asking] = place;
    push.vpls.at[place] = vpl_of_nothing();
    push.views.at[place] = view_of_nothing();
}
