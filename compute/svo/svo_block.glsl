// What both levels' kernels end with: a block and its owner, from the block's children, which are gone through twice. Who includes it says before what a child is:
// SvoChild svo_child(uint at).
#include "compute/svo/svo_build.h"

uint svo_depth() { return push.shape >> 28; }
// Whether there is room for all inner nodes.
bool svo_fits() { return push.octree.state.at[0].first[svo_depth()] <= (push.shape & 0xfffffffu); }

struct SvoChild {
    Sphere sphere;
    BshBox box;
    float weight;
    uint missing;
    uint cone;
};
SvoChild svo_child(uint at);

// `at`: of the first child, in what svo_child takes.
void write_block(uint node, uint level, uint first, uint count, uint at) {
    SvoOwner owner = svo_owner();
    SvoExtent extent;
    vec3 origin;
    for (uint i = 0u; i < count; ++i) {
        const SvoChild child = svo_child(at + i);
        const vec3 axis = bsh_cone_axis(child.cone);
        if (i == 0u) {
            origin = child.sphere.center;
            extent = svo_extent(origin, axis);
        }
        svo_add(extent, child.sphere.center, axis);
        svo_add(owner, origin, child.sphere, child.box, child.weight, child.missing);
    }
    const vec4 frame = svo_frame_of(extent);
    push.blocks.at[node + 1u] = SvoBlock(frame.xyz, svo_bits(frame.w, count, svo_depth() - level - 1u), first);
    const vec3 middle = svo_middle(owner, origin);
    SvoCone cone = svo_cone(extent);
    float radius = 0.0f;
    for (uint i = 0u; i < count; ++i) {
        const SvoChild child = svo_child(at + i);
        const uvec2 code = bsh_encode(frame, child.sphere);
        const Sphere decoded = bsh_decode(frame, code);
        push.spheres.at[first + i] = code;
        push.boxes.at[first + i] = bsh_encode_box(decoded, child.box, child.missing);
        radius = max(radius, bsh_reach(middle, decoded));
        svo_add(cone, child.cone);
    }
    radius = radius * bsh_slack;
    push.cones.at[node] = svo_code(cone);
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
