#version 460
#extension GL_GOOGLE_include_directive : require
// A cell and a triangle become those of the cell's children that the triangle meets.
#include "compute/append/append.glsl"
#include "compute/instances/instances.glsl"
#include "compute/voxels/voxels_io.h"
layout(push_constant, scalar) uniform Push { VoxelsPush push; };

void main() {
    const uint item = append_item();
    uvec2 pair = uvec2(0u);
    if (append_has(item, push.lists))
        pair = push.level == 0u ? voxel_pack(uvec2(0u), push.first_triangle + item) : push.lists.items.at[item];
    const uvec2 key = voxel_key(pair);
    const uint triangle = voxel_triangle_of(pair);
    uint found = 0u;
    if (append_decides(item, push.lists)) found = voxel_children(voxel_triangle(world_corners(push.instances, push.instance_count, push.triangles, push.positions, triangle), push.cube, push.depth), key, push.level, push.depth);
    found = append_payload(item, found, push.lists);
    const bool leaves = push.level + 1u == push.depth;
    const uint children = bitCount(found);
    const uvec2 at = append_reserve(item, leaves ? uvec2(0u, children) : uvec2(children, 0u), push.lists);
    if (!append_writes) return;
    for (uint i = 0u; found != 0u; ++i) {
        const uvec2 child = voxel_pack(voxel_child_key(key, uint(findLSB(found))), triangle);
        found &= found - 1u;
        if (leaves) append_kept(at.y + i, child, push.lists);
        else append_next(at.x + i, child, push.lists);
    }
}
