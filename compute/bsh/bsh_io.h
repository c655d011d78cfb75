// The bounding-sphere hierarchy as kernels see it.
//
// The paper's tree is a complete binary tree over n = 2^d samples (ManyLoDs 4.1). It is stored with one, two or three of its levels
// taken at once, as a tree of arity a = 2, 4 or 8 (ManyLoDs 7: any works): opening a node reads one block, which holds the bounds of
// its children in 16 + 8 a bytes (the price is words touched per lane).
//
//   slot     a node, seen as a child: slot s belongs to block s / a. Leaves are slots [0, n), in tree order.
//   block    the children of one inner node: slots [a b, a b + a). The inner node in slot s >= n owns block s - n, so
//            parent and child are one addition and one shift apart on every level, and no level needs a table.
//   root     owns the last block, blocks - 1, which has fewer than a children when d is not a multiple of log2 a.
//            The root itself sits alone in slot a * blocks, the first of one more block ("over the root").
//
// A block's children are quantised in the block's own frame: centre = origin + step * (x, y, z), 16 bits each; the radius
// is a float of 16 bits (8 exponent, 8 mantissa), rounded up. Precision is relative to the block, so it holds at any
// scale and anywhere. Every decoded sphere contains what it was made from, bounds are merged from decoded spheres, hence
// each node's sphere contains its descendants' in floating point (spec, section 2).
#ifndef MYRIAD_COMPUTE_BSH_IO_H
#define MYRIAD_COMPUTE_BSH_IO_H

#include "compute/common/packing.h"
#include "compute/surface_sampling/surface_sample.h"
#include "compute/views/view_io.h"

MYRIAD_BEGIN
const uint bsh_most = 8u;            // the largest arity: masks and arrays of children have room for so many
const uint bsh_absent = 0xffffu;     // radius code of a slot without a node
const uint bsh_max_blocks = 1u << 26;  // what cuts can tell apart (compute/manylods/cut_io.h), and of those the last is a hole's
// Kernels walk trees of one arity, which this specialisation constant is the log2 of: its multiplications are shifts, its loops unroll.
const uint bsh_arity_constant = 20u;
MYRIAD_END

// What slots and blocks are reckoned by.
#ifdef __cplusplus
namespace myriad {
struct BshShape {
    uint leaves = 0, blocks = 0;     // as in BshRef
    uint arity_log2 = 3;

    uint arity() const { return 1u << arity_log2; }
    uint root() const { return blocks << arity_log2; }  // its slot
};
inline uint bsh_log2_of(const BshShape& shape) { return shape.arity_log2; }
}  // namespace myriad
#else
layout(constant_id = bsh_arity_constant) const uint bsh_arity_log2 = 3u;
const uint bsh_arity = 1u << bsh_arity_log2;
struct BshShape {
    uint leaves, blocks;
};
uint bsh_log2_of(BshShape shape) { return bsh_arity_log2; }
#endif

MYRIAD_BEGIN
// What a kernel needs to walk the tree. All arrays are indexed by block or by slot as said.
struct BshRef {
    Float4s frames;                  // by block: origin xyz, step
    Uint2s spheres;                  // by slot: x | y << 16, z | radius code << 16
    Uints cones;                     // by slot: see bsh_cone_*
    Uint2s boxes;                    // by slot: see bsh_box_*
    uint leaves;                     // n
    uint blocks;                     // without the one over the root
};

MYRIAD_FN bool bsh_is_leaf(uint slot, uint leaves) { return slot < leaves; }
// Levels above the leaves. Level k begins at slot an/(a-1) (1 - a^-k), so an - (a-1) slot lies in (an a^-(k+1), an a^-k].
MYRIAD_FN uint bsh_height(uint slot, BshShape shape) {
    const uint k = bsh_log2_of(shape);
    const uint depth = uint(findMSB(shape.leaves));
    if (slot == shape.blocks << k) return max((depth + k - 1u) / k, 1u);  // the root
    const uint left = (shape.leaves << k) - ((1u << k) - 1u) * slot;
    return (depth + k - 1u - uint(findMSB(left - 1u))) / k;
}
// The block that an inner node owns.
MYRIAD_FN uint bsh_block_of(uint slot, BshShape shape) {
    return slot == shape.blocks << bsh_log2_of(shape) ? shape.blocks - 1u : slot - shape.leaves;
}
// And the inner node that owns a block, its inverse. The block over the root has no owner.
MYRIAD_FN uint bsh_owner_of(uint block, BshShape shape) {
    return block + 1u == shape.blocks ? shape.blocks << bsh_log2_of(shape) : block + shape.leaves;
}
MYRIAD_FN bool bsh_is_absent(uvec2 code) { return (code.y >> 16) == bsh_absent; }

MYRIAD_FN Sphere bsh_decode(vec4 frame, uvec2 code) {
    Sphere s;
    s.center = vec3(frame) + frame.w * vec3(float(code.x & 0xffffu), float(code.x >> 16), float(code.y & 0xffffu));
    s.radius = uintBitsToFloat((code.y >> 16) << 15);
    return s;
}

// The smallest radius code whose value is at least r; r >= 0 and finite.
MYRIAD_FN uint bsh_radius_code(float r) { return (floatBitsToUint(r) + 0x7fffu) >> 15; }

// Normal cone, of *lines*: n and -n are the same normal, since a sample is seen from both sides, so a thin sheet with two
// faces is as flat as its one face. Axis in 12 + 12 bits (octahedral), then 8 bits t of half-angle theta in [0, pi/2]:
// cos(theta) = 1 - (t / 255)^2, which is nearly uniform in the angle and needs no trigonometry; rounded up so that the
// decoded cone contains all normals below the node. 255: all directions (also of a triangle without area).
const uint bsh_cone_all = 0xff800800u;

MYRIAD_FN vec3 bsh_cone_axis(uint cone) {
    return oct_unfold(float(int(cone & 0xfffu) - 0x800) / 2047.0f, float(int((cone >> 12) & 0xfffu) - 0x800) / 2047.0f);
}

// What a node's surface fills of its sphere: the box around its samples' patches, 10 bits a side in units of the radius,
// rounded outward, relative to the decoded centre. Spheres decide what is drawn; boxes say how far it reaches, because a
// sphere around a square patch of wall sticks out over its neighbours, and eight levels of that darken every map.
// The two bits that each word has left say how much is missing of the surface (opacity_missing): 0 for all but blended ones,
// which a view's map shows or not (opacity_in_view). A node is as whole as the most whole node below it.
struct BshBox {
    vec3 low, high;
};
MYRIAD_FN uint bsh_missing(uvec2 code) { return (code.x >> 30) | ((code.y >> 30) << 2); }
MYRIAD_FN BshBox bsh_decode_box(uvec2 code, float radius) {
    const float step = radius / 511.0f;
    BshBox box;
    box.low = vec3(float(code.x & 1023u), float((code.x >> 10) & 1023u), float((code.x >> 20) & 1023u)) * step - radius;
    box.high = vec3(float(code.y & 1023u), float((code.y >> 10) & 1023u), float((code.y >> 20) & 1023u)) * step - radius;
    return box;
}
// Cosine and sine of the half-angle.
MYRIAD_FN vec2 bsh_cone_cos_sin(uint cone) {
    const float t = float(cone >> 24) / 255.0f;
    return vec2(1.0f - t * t, t * sqrt(2.0f - t * t));
}
MYRIAD_END

#ifndef __cplusplus
BshShape bsh_shape(BshRef tree) { return BshShape(tree.leaves, tree.blocks); }
#endif

#endif
