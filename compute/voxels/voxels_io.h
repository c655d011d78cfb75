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

// Whether an edge's cross product with a coordinate axis, in whose plane (u, v) are the other two coordinates, keeps the triangle apart from the cell of half side h around the
// origin. `end` is a corner on the edge, `other` the one across.
MYRIAD_FN bool voxel_axis_parts(float edge_u, float edge_v, float end_u, float end_v, float other_u, float other_v, float h) {
    const float p = edge_u * end_v - edge_v * end_u, q = edge_u * other_v - edge_v * other_u;
    const float r = h * (abs(edge_u) + abs(edge_v));
    return min(p, q) > r || max(p, q) < -r;
}
MYRIAD_FN bool voxel_edge_parts(vec3 edge, vec3 end, vec3 other, float h) {
    return voxel_axis_parts(edge.y, edge.z, end.y, end.z, other.y, other.z, h) || voxel_axis_parts(edge.z, edge.x, end.z, end.x, other.z, other.x, h) ||
           voxel_axis_parts(edge.x, edge.y, end.x, end.y, other.x, other.y, h);
}

// Whether a triangle and a closed cell meet, by the 13 axes that can part them (Akenine-Moeller 2001). Never no where they do; yes too where they are closer than
// the margin. A triangle without area is the segment that it is: the axes of its normal then part nothing, the others all.
MYRIAD_FN bool voxel_overlaps(VoxelTriangle t, vec3 centre, float half_side) {
    if (t.margin < 0.0f) return false;
    const float h = half_side + t.margin;
    const vec3 a = t.a - centre, b = t.b - centre, c = t.c - centre;
    const vec3 least = min(a, min(b, c)), most = max(a, max(b, c));
    if (max(least.x, max(least.y, least.z)) > h || min(most.x, min(most.y, most.z)) < -h) return false;
    const vec3 ab = t.b - t.a, bc = t.c - t.b, ca = t.a - t.c;
    const vec3 normal = cross(ab, bc);
    // A needle's normal is what roundings leave of it: they are counted by themselves.
    const float slack = voxel_sum(ab) * voxel_sum(bc) * voxel_largest(a) * 9.5367431640625e-7f;
    if (abs(dot(normal, a)) > h * voxel_sum(normal) + slack) return false;
    return !(voxel_edge_parts(ab, a, c, h) || voxel_edge_parts(bc, b, a, h) || voxel_edge_parts(ca, c, b, h));
}

// Which of a cell's eight children meet a triangle; `level` is the cell's.
MYRIAD_FN uint voxel_children(VoxelTriangle t, uvec2 key, uint level, uint depth) {
    const float side = float(1u << (depth - level - 1u));
    const uvec3 cell = octree_cell_of(key);
    uint found = 0u;
    for (uint octant = 0u; octant < 8u; ++octant) {
        const uvec3 child = cell * 2u + uvec3(octant & 1u, octant >> 1 & 1u, octant >> 2);
        if (voxel_overlaps(t, (vec3(child) + 0.5f) * side, 0.5f * side)) found |= 1u << octant;
    }
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
