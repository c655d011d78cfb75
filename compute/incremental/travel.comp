#version 460
#extension GL_GOOGLE_include_directive : require
// How far each view has come since the last frame (slack.h), and whether there is anything to look at at all.
#include "engine/kernel.glsl"
#include "compute/incremental/incremental_io.h"
layout(push_constant, scalar) uniform Push { TravelPush push; };

void main() {
    const uint i = thread_index();
    if (i >= push.limit) return;
    CarriedRefs memory = push.memory.at[0];
    const bool exists = push.first_view + i < push.count.at[0];
    View now = memory.before.at[i];
    if (exists) now = push.views.at[push.first_view + i];
    Travel t = memory.travels.at[i];
    t = travel_on(t, memory.before.at[i], (t.flags & travel_exists) != 0u, now, exists);
    memory.travels.at[i] = t;
    memory.before.at[i] = now;
    const bool all = (push.flags & carry_all) != 0u;
    const bool stirs = travel_stirs(t) || all;
    memory.changed.at[i] = stirs ? 1u : 0u;
    if (stirs || memory.bounds_now != 0u) atomicMax(memory.state.at[0].look, memory.state.at[0].items);
}
