// What both levels' kernels end with: a block and its owner are written from the block's children.
#include "engine/kernel.glsl"
#include "compute/bsh/bsh_build.h"
layout(push_constant, scalar) uniform Push { BshLevelPush push; };

// The block of this invocation, counted from the level's first; past the end where it has none.
uint own_block() {
    const uint i = thread_index();
    if (push.listed_count == 0u) return i;
    return i < push.listed_count ? push.listed.at[i] : push.nodes;
}

// Of a block that has fewer children, the last is repeated: it changes no bound.
uint child_of(uint block, uint i) { return min(bsh_arity * block + i, push.nodes - 1u); }

void write_block(uint block, BshSpheres spheres, BshCones cones, BshBoxes boxes) {
    const uint slot = push.first_slot + bsh_arity * block;
    const uint count = min(bsh_arity, push.nodes - bsh_arity * block);
    const vec4 frame = bsh_frame(spheres);
    push.frames.at[slot >> bsh_arity_log2] = frame;
    for (uint i = 0u; i < bsh_arity; ++i) {
        const uvec2 code = bsh_encode(frame, spheres.at[i]);
        push.spheres.at[slot + i] = i < count ? code : uvec2(0u, bsh_absent << 16);
        if (i >= count) push.cones.at[slot + i] = bsh_cone_all;
        spheres.at[i] = bsh_decode(frame, code);
        push.boxes.at[slot + i] = i < count ? bsh_encode_box(spheres.at[i], boxes.at[i], boxes.missing[i]) : uvec2(0u);
    }
    if (push.first_owner == 0u) return;
    const Sphere owner = bsh_merge(spheres);
    push.merged.at[slot >> bsh_arity_log2] = vec4(owner.center, owner.radius);
    push.cones.at[push.first_owner + block] = bsh_cone_merge(cones);
    const BshBox box = bsh_merge_boxes(boxes);
    push.merged_boxes.at[2u * (slot >> bsh_arity_log2)] = vec4(box.low, float(bsh_merge_missing(boxes)));
    push.merged_boxes.at[2u * (slot >> bsh_arity_log2) + 1u] = vec4(box.high, 0.0f);
}
