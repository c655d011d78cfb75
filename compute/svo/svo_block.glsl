// What both levels' kernels end with: a block and its owner, from the block's children.
#include "engine/kernel.glsl"
#include "compute/svo/svo_build.h"

uint svo_depth() { return push.shape >> 28; }
// Whether there is room for all inner nodes.
bool svo_fits() { return push.octree.state.at[0].first[svo_depth()] <= (push.shape & 0xfffffffu); }

void write_block(uint node, uint level, uint first, uint count, BshSpheres spheres, BshCones cones, BshBoxes boxes, SvoOwner owner) {
    const vec4 frame = bsh_frame(spheres, count);
    push.blocks.at[node + 1u] = SvoBlock(frame.xyz, svo_bits(frame.w, count, svo_depth() - level - 1u), first);
    const vec3 middle = svo_middle(owner, spheres.at[0].center);
    float radius = 0.0f;
    for (uint i = 0u; i < count; ++i) {
        const uvec2 code = bsh_encode(frame, spheres.at[i]);
        const Sphere decoded = bsh_decode(frame, code);
        push.spheres.at[first + i] = code;
        push.boxes.at[first + i] = bsh_encode_box(decoded, boxes.at[i], boxes.missing[i]);
        radius = max(radius, bsh_reach(middle, decoded));
    }
    radius = radius * bsh_slack;
    push.cones.at[node] = bsh_cone_merge(cones, count);
    push.merged.at[3u * node] = vec4(middle, radius);
    push.merged.at[3u * node + 1u] = vec4(owner.low, owner.weight);
    push.merged.at[3u * node + 2u] = vec4(owner.high, float(owner.missing));
    if (level != 0u) return;
    const Sphere root = Sphere(middle, radius);
    const uvec2 code = bsh_encode(vec4(middle, 0.0), root);
    push.blocks.at[0] = SvoBlock(middle, svo_bits(0.0, 1u, svo_depth()), 0u);
    push.spheres.at[0] = code;
    push.boxes.at[0] = bsh_encode_box(bsh_decode(vec4(middle, 0.0), code), BshBox(owner.low, owner.high), owner.missing);
}
