#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a slot: who needs a place, and who leaves one to others.
#include "engine/kernel.glsl"
#include "passes/vpl/vpl_io.h"
layout(push_constant, scalar) uniform Push { VplPlacesPush push; };

void main() {
    const uint slot = thread_index();
    if (slot >= push.slot_count) return;
    const bool alive = push.alive.at[slot] != 0u;
    const bool owns = push.owners.at[push.places.at[slot]] == slot;
    push.flags.at[slot] = alive && !owns ? 1u : 0u;
    push.flags.at[push.slot_count + slot] = !alive && owns ? 1u : 0u;
}
