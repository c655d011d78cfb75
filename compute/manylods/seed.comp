#version 460
#extension GL_GOOGLE_include_directive : require
// The first step: tests the root in every view. The root sits alone in the block over it (bsh_io.h).
#include "compute/append/append.glsl"
#include "compute/manylods/open.glsl"
layout(push_constant, scalar) uniform Push { ManyLodsPush push; };

void main() {
    const uint item = append_item();
    const uint view = push.first_view + item;
    const uint over_root = push.tree.blocks;
    uint found = 0u;
    if (append_decides(item, push.lists))
        found = classify_child(push.views.at[view], push.tree.frames.at[over_root], push.tree.spheres.at[bsh_arity * over_root],
                               bsh_height(bsh_arity * over_root, bsh_shape(push.tree)), push.epsilon, push.map_size);
    found = append_payload(item, found, push.lists);

    const uint kept = found & 0xffffu;
    const bool open = (found >> 16) != 0u;
    const uvec2 at = append_reserve(item, uvec2(open ? 1u : 0u, kept != 0u ? 1u : 0u), push.lists);
    if (!append_writes) return;
    if (kept != 0u) append_kept(at.y, cut_pack(over_root, view, kept), push.lists);
    if (open) append_next(at.x, uvec2(push.tree.blocks - 1u, view), push.lists);
}
