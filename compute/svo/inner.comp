#version 460
#extension GL_GOOGLE_include_directive : require
// A level above, from what the level below left for its nodes.
#include "engine/kernel.glsl"
#include "compute/svo/svo_build.h"
layout(push_constant, scalar) uniform Push { SvoInnerPush push; };
#include "compute/svo/svo_block.glsl"

SvoChild svo_child(uint node) {
    const vec4 s = push.merged.at[3u * node];
    const vec4 low = push.merged.at[3u * node + 1u];
    const vec4 high = push.merged.at[3u * node + 2u];
    return SvoChild(Sphere(s.xyz, s.w), BshBox(low.xyz, high.xyz), low.w, uint(high.w), push.cones.at[node]);
}

void main() {
    if (thread_index() >= push.octree.state.at[0].count[push.level] || !svo_fits()) return;
    const uint node = push.octree.state.at[0].first[push.level] + thread_index();
    const uint first = push.octree.first.at[node];
    write_block(node, push.level, first, push.octree.first.at[node + 1u] - first, first);
}
