#version 460
#extension GL_GOOGLE_include_directive : require
// Every other level, from the spheres and cones that the level below left for the owners of its blocks.
#include "compute/bsh/bsh_block.glsl"

void main() {
    const uint block = own_block();
    if (bsh_arity * block >= push.nodes) return;
    BshSpheres spheres;
    BshCones cones;
    BshBoxes boxes;
    for (uint i = 0u; i < bsh_arity; ++i) {
        const uint node = child_of(block, i);
        const vec4 s = push.merged.at[push.first_child_block + node];
        spheres.at[i].center = vec3(s);
        spheres.at[i].radius = s.w;
        cones.at[i] = push.cones.at[push.first_slot + node];
        const vec4 low = push.merged_boxes.at[2u * (push.first_child_block + node)];
        boxes.at[i].low = vec3(low);
        boxes.missing[i] = uint(low.w);
        boxes.at[i].high = vec3(push.merged_boxes.at[2u * (push.first_child_block + node) + 1u]);
    }
    write_block(block, spheres, cones, boxes);
}
