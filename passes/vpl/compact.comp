#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a slot.
#include "engine/kernel.glsl"
#include "passes/vpl/vpl_io.h"
layout(push_constant, scalar) uniform Push { VplCompactPush push; };

void main() {
    const uint slot = thread_index();
    if (slot >= push.slot_count) return;
    if (slot == 0u) {
        const uint alive = push.offsets.at[push.slot_count];
        push.count.at[0] = min(alive, push.max_vpls);
        push.count.at[1] = alive;
    }
    const uint to = push.offsets.at[slot];
    if (push.offsets.at[slot + 1u] == to || to >= push.max_vpls) return;
    const Vpl vpl = push.slots.at[slot];
    push.vpls.at[to] = vpl;
    push.views.at[to] = View(vpl.position, 0.0, unpack_direction(vpl.normal), 1.0);  // the hemisphere: phi = pi / 2
}
