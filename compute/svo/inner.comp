#version 460
#extension GL_GOOGLE_include_directive : require
// A level above, from what the level below left for its nodes.
#include "engine/kernel.glsl"
#include "compute/svo/svo_build.h"
layout(push_constant, scalar) uniform Push { SvoInnerPush push; };
#include "compute/svo/svo_block.glsl"

void main() {
    if (thread_index() >= push.octree.state.at[0].count[push.level] || !svo_fits()) return;
    const uint node = push.octree.state.at[0].first[push.level] + thread_index();
    const uint first = push.octree.first.at[node];
    const uint count = push.octree.first.at[node + 1u] - first;
    BshSpheres spheres;
    BshCones cones;
    BshBoxes boxes;
    SvoOwner owner = svo_owner();
    for (uint i = 0u; i < count; ++i) {
        const vec4 s = push.merged.at[3u * (first + i)];
        const vec4 low = push.merged.at[3u * (first + i) + 1u];
        const vec4 high = push.merged.at[3u * (first + i) + 2u];
        spheres.at[i] = Sphere(s.xyz, s.w);
        boxes.at[i] = BshBox(low.xyz, high.xyz);
        boxes.missing[i] = uint(high.w);
        cones.at[i] = push.cones.at[first + i];
        svo_add(owner, spheres.at[0].center, spheres.at[i], boxes.at[i], low.w, boxes.missing[i]);
    }
    write_block(node, push.level, first, count, spheres, cones, boxes, owner);
}
