#version 460
#extension GL_GOOGLE_include_directive : require
#include "engine/kernel.glsl"
#include "compute/voxels/voxels_io.h"
layout(push_constant, scalar) uniform Push { VoxelItemsPush push; };

void main() {
    const uint i = thread_index();
    if (i >= min(push.count.at[0], push.max_items)) return;
    const uvec2 pair = push.pairs.at[i];
    push.keys.at[i] = voxel_key(pair);
    push.items.at[i] = voxel_triangle_of(pair);
}
