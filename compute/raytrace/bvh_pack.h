// How the boxes of a node's children are made: the formulae of the builder, and of the refit on the device.
#ifndef MYRIAD_COMPUTE_BVH_PACK_H
#define MYRIAD_COMPUTE_BVH_PACK_H

#include "compute/raytrace/raytrace_io.h"

MYRIAD_BEGIN
struct BvhBox {
    vec3 lo, hi;
};
MYRIAD_ARRAY(BvhBoxArray, BvhBox, 8)
struct BvhChildren {
    BvhBox box[8];
};

MYRIAD_FN BvhBox bvh_united(BvhBox a, BvhBox b) {
    BvhBox all;
    all.lo = min(a.lo, b.lo);
    all.hi = max(a.hi, b.hi);
    return all;
}

// What boxes are enlarged by: 2^-21 of the triangle's extent and of its coordinates (8 u each). The triangle test rounds its
// vertices by up to 3 u of their distances from the ray's origin, so that it accepts rays that pass the exact box by as much; the
// part that grows with the ray's length is in the box test's own slack. A box then also contains its triangle strictly, which
// rays in the plane of a box's face rely on.
MYRIAD_FN vec3 bvh_padding(vec3 lo, vec3 hi) {
    const vec3 extent = hi - lo;
    const float largest = max(extent.x, max(extent.y, extent.z));
    MYRIAD_PRECISE const vec3 pad = (vec3(largest, largest, largest) + max(abs(lo), abs(hi))) * 4.7683716e-7f;
    return pad;
}
MYRIAD_FN BvhBox bvh_padded(vec3 lo, vec3 hi) {
    const vec3 pad = bvh_padding(lo, hi);
    BvhBox box;
    MYRIAD_PRECISE const vec3 l = lo - pad, h = hi + pad;
    box.lo = l;
    box.hi = h;
    return box;
}
// The bounds that a triangle is boxed by.
MYRIAD_FN BvhBox bvh_box_of(vec3 p0, vec3 p1, vec3 p2) { return bvh_padded(min(p0, min(p1, p2)), max(p0, max(p1, p2))); }

MYRIAD_FN float bvh_bound(float origin, uint code, float scale) { return origin + float(code) * scale; }  // as bvh_corner

// The exponent of the least power of two above a 255th of the extent, which spans it but for rounding.
MYRIAD_FN uint bvh_exponent(float extent) {
    const float step = extent / 255.0f;
    return step > 0.0f ? min((floatBitsToUint(step) >> 23) + 1u, 254u) : 127u;
}

// One axis of the children's boxes [lo_i, hi_i], rounded outward to bytes in the frame (origin, 2^(exponent - 127)): lower corners in
// x, upper ones in y. `exponent` grows until they fit.
struct BvhAxis {
    uint exponent;
    uvec2 code[8];
};
MYRIAD_FN BvhAxis bvh_pack_axis(BvhChildren children, uint count, int axis, float low, float high) {
    BvhAxis packed;
    for (packed.exponent = bvh_exponent(high - low);; ++packed.exponent) {
        const float scale = uintBitsToFloat(packed.exponent << 23);
        bool fits = true;
        for (uint i = 0u; i < count; ++i) {
            const float lo = children.box[i].lo[axis], hi = children.box[i].hi[axis];
            uint a = uint(clamp(int((lo - low) / scale), 0, 255));
            while (a > 0u && bvh_bound(low, a, scale) > lo) --a;
            uint b = uint(clamp(int((hi - low) / scale), int(a), 255));
            while (b < 255u && bvh_bound(low, b, scale) < hi) ++b;
            fits = fits && bvh_bound(low, b, scale) >= hi;
            packed.code[i] = uvec2(a, b);
        }
        if (fits || packed.exponent >= 254u) return packed;
    }
}

// Boxes of `count` children, at least one. What the codes say beside boxes stays.
MYRIAD_FN BvhNode bvh_pack(BvhNode node, BvhChildren children, uint count) {
    BvhBox all = children.box[0];
    for (uint i = 1u; i < count; ++i) all = bvh_united(all, children.box[i]);
    node.origin = all.lo;
    node.frame = count << 24;
    for (uint i = 0u; i < count; ++i) node.child[i] = node.child[i] & uvec2(0xff000000u, 0xff000000u);
    for (int axis = 0; axis < 3; ++axis) {
        const BvhAxis packed = bvh_pack_axis(children, count, axis, all.lo[axis], all.hi[axis]);
        node.frame |= packed.exponent << uint(8 * axis);
        for (uint i = 0u; i < count; ++i) {
            node.child[i].x |= packed.code[i].x << uint(8 * axis);
            node.child[i].y |= packed.code[i].y << uint(8 * axis);
        }
    }
    return node;
}

// ---- Refit ----

MYRIAD_ARRAY(BvhPositions, vec3, 4)

// "raytrace/move": an invocation a triangle of the tree that moves; takes its corners from the scene's vertices.
struct BvhMovePush {
    Uint2s moving;          // its index in the tree, and its index as stored
    Uint4s triangles;       // as stored
    BvhPositions positions;
    BvhTriangles tree;
    uint count;
};

// "raytrace/refit": an invocation a node of one level, whose children's boxes are known.
struct BvhRefitPush {
    BvhNodes nodes;
    BvhTriangles triangles;
    BvhBoxArray boxes;      // by node: around all of its children, before it is packed
    Uints moving;           // nodes
    uint first, count;      // the level's
};
MYRIAD_END

#ifdef __cplusplus
static_assert(sizeof(myriad::BvhBox) == 24);
#endif

#endif
