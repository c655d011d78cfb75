#version 460
#extension GL_GOOGLE_include_directive : require
// See sieve_io.h. Used by tests and benches only.
#include "compute/append/append.glsl"
#include "compute/append/sieve_io.h"
layout(push_constant, scalar) uniform Push { SievePush push; };

void main() {
    const uint item = append_item();
    uvec2 value = uvec2(0u);
    if (append_has(item, push.lists)) value = push.first_step != 0u ? uvec2(item * 2654435761u >> 8, 0u) : push.lists.items.at[item];
    uint found = 0u;
    if (append_decides(item, push.lists)) found = sieve_copies(value) | (sieve_keeps(value) ? 16u : 0u);
    found = append_payload(item, found, push.lists);
    const uint copies = found & 15u;
    const bool keep = (found & 16u) != 0u;
    const uvec2 at = append_reserve(item, uvec2(copies, keep ? 1u : 0u), push.lists);
    if (!append_writes) return;
    if (keep) append_kept(at.y, value, push.lists);
    for (uint i = 0u; i < copies; ++i) append_next(at.x + i, sieve_child(value, i), push.lists);
}
