// Conservative voxelisation: the formulae, and what the kernels and their host share. See README.md.
#ifndef MYRIAD_COMPUTE_VOXELS_IO_H
#define MYRIAD_COMPUTE_VOXELS_IO_H

#include "compute/append/append_io.h"
#include "compute/instances/instances.h"
#include "compute/octree/octree.h"

MYRIAD_BEGIN
// A work item is a cell and a triangle in 64 bits: 36 of the cell's Morton key at its level, 28 of the triangle.
const uint voxels_max_depth = 12u;
const uint voxels_triangle_bits = 28u;
MYRIAD_FN uvec2 voxel_pack(uvec2 key, uint triangle) { return uvec2(key.x, key.y << voxels_triangle_bits | triangle); }
MYRIAD_FN uvec2 voxel_key(uvec2 item) { return uvec2(item.x, item.y >> voxels_triangle_bits); }
MYRIAD_FN uint voxel_triangle_of(uvec2 item) { return item.y & ((1u << voxels_triangle_bits) - 1u); }

// A triangle in units of leaf cells, from the cube's origin, and by how much cells are taken larger for it: more than what all roundings can move a corner, a
// projection or a cell's half side by. (Those are below 2^-22 of the largest number: the origin's subtraction and the product with the scale, 2^-23 of a
// corner; corners from a cell's centre and edges, 2^-24 each of themselves; a projection of two products, 2^-22 of the corner times the edge.)
struct VoxelTriangle {
    vec3 a, b, c;
    float margin;   // < 0: a corner is not finite, and the triangle nowhere
};
MYRIAD_FN float voxel_largest(vec3 v) { return max(abs(v.x), max(abs(v.y), abs(v.z))); }
MYRIAD_FN float voxel_sum(vec3 v) { return abs(v.x) + abs(v.y) + abs(v.z); }
MYRIAD_FN bool voxel_is_finite(float f) { return (floatBitsToUint(f) & 0x7f800000u) != 0x7f800000u; }
MYRIAD_FN bool voxel_is_finite(vec3 v) { return voxel_is_finite(v.x) && voxel_is_finite(v.y) && voxel_is_finite(v.z); }
MYRIAD_FN VoxelTriangle voxel_triangle(Corners corners, OctreeCube cube, uint depth) {
    VoxelTriangle t;
    t.a = (corners.p0 - cube.origin) * cube.cells_per_length;
    t.b = (corners.p1 - cube.origin) * cube.cells_per_length;
    t.c = (corners.p2 - cube.origin) * cube.cells_per_length;
    t.margin = (max(voxel_largest(t.a), max(voxel_largest(t.b), voxel_largest(t.c))) + float(1u << depth)) * 9.5367431640625e-7f;  // 2^-20
    if (!(voxel_is_finite(t.a) && voxel_is_finite(t.b) && voxel_is_finite(t.c))) t.margin = -1.0f;
    return t;
}

// Whether a triangle and closed cells meet, by the 13 axes that can part them (Akenine-Moeller 2001), for the eight children of a cell at once: what a child's middle
// adds to the parent's projection is the same but for signs. Never no where they meet; yes too where they are closer than the margin. A triangle without area is the
// segment that it is: the axes of its normal then part nothing, the others all.
//
// An edge's cross product with a coordinate axis, in whose plane (u, v) are the other two coordinates. `end` is a corner on the edge, `other` the one across; h: half a
// child's side, of which the margin is none. Of a child at (u, v) = (+-h, +-h), those that are not parted: bits 0 to 3 for (+, +), (-, -), (+, -), (-, +).
MYRIAD_FN uint voxel_axis_keeps(float edge_u, float edge_v, float end_u, float end_v, float other_u, float other_v, float h, float margin) {
    const float p = edge_u * end_v - edge_v * end_u;
    const float q = edge_u * other_v - edge_v * other_u;
    const float r = (h + margin) * (abs(edge_u) + abs(edge_v));
    const float low = min(p, q) - r;
    const float high = max(p, q) + r;
    const float same = (edge_u - edge_v) * h;
    const float apart = (edge_u + edge_v) * h;
    uint kept = 15u;
    if (low > same || high < same) kept &= ~1u;
    if (low > -same || high < -same) kept &= ~2u;
    if (low > -apart || high < -apart) kept &= ~4u;
    if (low > apart || high < apart) kept &= ~8u;
    return kept;
}
// The octants that these four are, where u, v are y, z; z, x; and x, y.
MYRIAD_FN uint voxel_octants(uint kept, uint both, uint neither, uint u_only, uint v_only) {
    return ((kept & 1u) != 0u ? both : 0u) | ((kept & 2u) != 0u ? neither : 0u) | ((kept & 4u) != 0u ? u_only : 0u) | ((kept & 8u) != 0u ? v_only : 0u);
}
MYRIAD_FN uint voxel_edge_keeps(vec3 edge, vec3 end, vec3 other, float h, float margin) {
    return voxel_octants(voxel_axis_keeps(edge.y, edge.z, end.y, end.z, other.y, other.z, h, margin), 0xc0u, 0x03u, 0x0cu, 0x30u) &
           voxel_octants(voxel_axis_keeps(edge.z, edge.x, end.z, end.x, other.z, other.x, h, margin), 0xa0u, 0x05u, 0x50u, 0x0au) &
           voxel_octants(voxel_axis_keeps(edge.x, edge.y, end.x, end.y, other.x, other.y, h, margin), 0x88u, 0x11u, 0x22u, 0x44u);
}
// Of a coordinate axis.
MYRIAD_FN uint voxel_side_keeps(float least, float most, float h, float margin, uint above) {
    uint kept = 0xffu;
    if (most < -margin || least > 2.0f * h + margin) kept &= ~above;
    if (least > margin || most < -2.0f * h - margin) kept &= above;
    return kept;
}

// Which of a cell's eight children meet a triangle; `level` is the cell's.
MYRIAD_FN uint voxel_children(VoxelTriangle t, uvec2 key, uint level, uint depth) {
    if (t.margin < 0.0f) return 0u;
    const float h = 0.5f * float(1u << (depth - level - 1u));
    const vec3 middle = (vec3(octree_cell_of(key)) * 2.0f + 1.0f) * (2.0f * h);
    const vec3 a = t.a - middle;
    const vec3 b = t.b - middle;
    const vec3 c = t.c - middle;
    const vec3 least = min(a, min(b, c));
    const vec3 most = max(a, max(b, c));
    uint found = voxel_side_keeps(least.x, most.x, h, t.margin, 0xaau) & voxel_side_keeps(least.y, most.y, h, t.margin, 0xccu) &
                 voxel_side_keeps(least.z, most.z, h, t.margin, 0xf0u);
    const vec3 ab = t.b - t.a;
    const vec3 bc = t.c - t.b;
    const vec3 ca = t.a - t.c;
    found &= voxel_edge_keeps(ab, a, c, h, t.margin) & voxel_edge_keeps(bc, b, a, h, t.margin) & voxel_edge_keeps(ca, c, b, h, t.margin);
    const vec3 normal = cross(ab, bc);
    // A needle's normal is what roundings leave of it: they are counted by themselves.
    const float slack = voxel_sum(ab) * voxel_sum(bc) * (voxel_largest(a) + h) * 9.5367431640625e-7f;
    const float reach = (h + t.margin) * voxel_sum(normal) + slack;
    const float d = normal.x * a.x + normal.y * a.y + normal.z * a.z;
    const float same = (normal.x + normal.y) * h;
    const float apart = (normal.x - normal.y) * h;
    const float up = normal.z * h;
    if (abs(d + same + up) > reach) found &= ~0x01u;
    if (abs(d - apart + up) > reach) found &= ~0x02u;
    if (abs(d + apart + up) > reach) found &= ~0x04u;
    if (abs(d - same + up) > reach) found &= ~0x08u;
    if (abs(d + same - up) > reach) found &= ~0x10u;
    if (abs(d - apart - up) > reach) found &= ~0x20u;
    if (abs(d + apart - up) > reach) found &= ~0x40u;
    if (abs(d - same - up) > reach) found &= ~0x80u;
    return found;
}
MYRIAD_FN uvec2 voxel_child_key(uvec2 key, uint octant) { return uvec2(key.x << 3 | octant, key.y << 3 | key.x >> 29); }

// "voxels/open": pairs of a cell of `level` and a triangle that may meet; those of its children that do are appended: to the next list, or to the kept one where
// they are leaves. Items of the first step are triangles, with the root.
struct VoxelsPush {
    AppendRef lists;
    Positions positions;
    Uint4s triangles;
    Instances instances;
    OctreeCube cube;
    uint instance_count, first_triangle;
    uint level, depth;
};

// "voxels/items": keys and triangles of the kept pairs, for the octree builder.
struct VoxelItemsPush {
    Uint2s pairs;
    Uints count;          // count.at[0] pairs, clamped to max_items
    Uint2s keys;
    Uints items;
    uint max_items;
};
MYRIAD_END

#endif
