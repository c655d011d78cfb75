// What the ray traversal, its kernels and their host share: the tree's layout, and where rays may start.
#ifndef MYRIAD_COMPUTE_RAYTRACE_IO_H
#define MYRIAD_COMPUTE_RAYTRACE_IO_H

#include "compute/opacity/opacity_io.h"

MYRIAD_BEGIN
const uint bvh_width = 8u;
// Levels of nodes in the deepest tree. Traversal keeps one stack entry a level; the packet's stack is three registers of
// eight lanes, hence 24. Embree's builder stops splitting by cost eight levels above the bound and halves from there.
const uint bvh_max_depth = 24u;
// With instances: levels over them, and levels in a mesh's tree. The stack is then 32 high, four registers.
const uint bvh_max_top_depth = 14u, bvh_max_mesh_depth = 18u, bvh_max_stack = 32u;
// Most triangles in a leaf: a node's leaves then hold at most 32, which one word of bits tells apart.
const uint bvh_leaf_size = 4u;

// Eight children whose boxes are rounded outward to 8 bits in the node's frame (after Ylitie et al. 2017, "Efficient
// incoherent ray traversal on GPUs through compressed wide BVHs"): 22 words where plain boxes take 56. A child's words are
// x, y, z of one corner in three bytes, and in the top byte
//   lower corner: how many triangles the leaf holds, 0 for an inner node
//   upper corner: where they start, counted from first_triangle
// Inner children come before leaves, so that child i is node first_child + i. A bound is fl(origin + byte * 2^(e-127)),
// where the product is exact, so that host and device agree on it to the bit, fused or not.
struct BvhNode {
    vec3 origin;
    uint frame;           // e of x, y, z in a byte each, then the number of children
    uint first_child;
    uint first_triangle;
    uvec2 child[8];
};

// An instance is a node too, which stands where its mesh's tree would: `frame` has bvh_is_instance for a number of children,
// first_child is the root of the tree, first_triangle an element of BvhRef::instances. `child` holds twelve floats: the
// columns of world to object, and the instance's own origin `at`, which is subtracted first; `origin` holds, axis by axis,
// the largest magnitude that a coordinate of the mesh, or a term of its transform, has in the world.
const uint bvh_is_instance = 255u;

// Boxes are met by the ray in the mesh's own space, triangles by the ray itself in the world. The pad that boxes get in a
// mesh's space, for a ray that starts at `from` (relative to the instance's origin): with u = 2^-24 and in units of world
// coordinates, what is off is the ray's origin by 5 u, its direction by 4 u of the way to the mesh, and the mesh's vertices
// by 4 u, which the triangle test rounds by 3 u more: 12 u of |from| and 11 u of `far` at most, of which axis_j of world to
// object makes object coordinates. It gets 20 u.
MYRIAD_FN vec3 instance_pad(vec3 axis_x, vec3 axis_y, vec3 axis_z, vec3 from, vec3 far) {
    const vec3 reach = abs(from) + far;
    return (abs(axis_x) * reach.x + abs(axis_y) * reach.y + abs(axis_z) * reach.z) * 1.1920929e-6f;
}

// Positions gathered so that a test reads 9 words in a row; the tenth is read for the hit that is kept.
struct BvhTriangle {
    vec3 p0, p1, p2;
    uint id;              // in the world; of a shared mesh: counted from its first. And bvh_asks
};
// The triangle is there in part: a hit counts only where opacity_is_there says so.
const uint bvh_asks = 0x80000000u;
// The specialisation constant of kernels that trace: whether any triangle asks. The variant without pays nothing for it.
const uint trace_asks_constant = 16u;

MYRIAD_ARRAY(BvhNodes, BvhNode, 8)
MYRIAD_ARRAY(BvhTriangles, BvhTriangle, 4)

// For push constants. An empty scene has one node without children.
struct BvhRef {
    BvhNodes nodes;
    BvhTriangles triangles;
    Instances instances;  // the tree's own; first_id is what to add to the ids of its triangles
    OpacityRef opacity;   // if any triangle asks
    uint loop_budget;     // see trace_exhausted in trace.glsl
    float reach;          // the scene's largest absolute coordinate, for ray_origin; 0 unless who hands this on sets it
};

MYRIAD_FN vec3 bvh_scale(uint frame) {
    return vec3(uintBitsToFloat((frame & 255u) << 23), uintBitsToFloat((frame >> 8 & 255u) << 23), uintBitsToFloat((frame >> 16 & 255u) << 23));
}
MYRIAD_FN uint bvh_children(uint frame) { return frame >> 24; }
MYRIAD_FN vec3 bvh_corner(vec3 origin, vec3 scale, uint corner) {
    return origin + vec3(float(corner & 255u), float(corner >> 8 & 255u), float(corner >> 16 & 255u)) * scale;
}

// The largest absolute coordinate of a triangle: what the rounding errors of a point on it are proportional to.
MYRIAD_FN float ray_reach(vec3 p0, vec3 p1, vec3 p2) {
    const vec3 m = max(abs(p0), max(abs(p1), abs(p2)));
    return max(m.x, max(m.y, m.z));
}

// Where a ray that leaves the surface at p starts, so that it does not meet the surface itself. `normal` is the unit
// geometric normal on the side that the ray leaves to, `reach` the ray_reach of p's triangle, or anything larger.
// The offset is 32 u reach, in units of length, with u = 2^-24: p = (1-u-v) p0 + u p1 + v p2 in floats is off its plane by at
// most 5 u reach a coordinate, so 9 u along the normal; adding the offset costs 2 u; the next ray's distance to the plane is
// a sum of products of coordinates relative to p (up to 2 reach, rounded) and of a rounded normal: 18 u. A grazing ray
// magnifies all of them alike, and the offset too.
MYRIAD_FN vec3 ray_origin(vec3 p, vec3 normal, float reach) { return p + normal * (reach * 1.9073486e-6f); }

// "raytrace/closest" and "raytrace/occluded" run over lists of rays.
struct Ray {
    vec3 origin;
    float t_min;
    vec3 direction;
    float t_max;
};
MYRIAD_ARRAY(Rays, Ray, 16)

struct RayHitRecord {
    float t;
    uint triangle;        // ~0 for a miss
    float u, v;
    uint front;
};
MYRIAD_ARRAY(RayHitRecords, RayHitRecord, 4)

struct RayQueryPush {
    BvhRef bvh;
    Rays rays;
    RayHitRecords hits;   // closest
    Uints occluded;       // occluded: 0 or 1 a ray
    Uints status;         // status.at[0] != 0: a traversal ran out of its loop budget
    uint count;
};
MYRIAD_END

#ifdef __cplusplus
static_assert(sizeof(myriad::BvhNode) == 88 && sizeof(myriad::BvhTriangle) == 40 && sizeof(myriad::BvhRef) == 40);
static_assert(sizeof(myriad::Ray) == 32 && sizeof(myriad::RayHitRecord) == 20);
#endif

#endif
