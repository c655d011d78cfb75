#version 460
#extension GL_GOOGLE_include_directive : require
#include "engine/kernel.glsl"
#include "compute/octree/octree_io.h"
layout(push_constant, scalar) uniform Push { OctreeKeysPush push; };

void main() {
    const uint i = thread_index();
    if (i >= min(push.count.at[0], push.max_items)) return;
    push.keys.at[i] = octree_key(octree_cell(push.points.at[i].xyz, push.cube, push.depth));
    push.items.at[i] = i;
}
