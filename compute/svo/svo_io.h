// The scene's sparse voxel octree as kernels see it (MegaViews 3.1).
//
// It is walked and drawn as the hierarchy over samples is (compute/bsh/bsh_io.h): blocks of up to eight children, spheres that are quantised in the
// block's frame, cones of lines, boxes. What differs is where things are. Nodes have numbers, the root's 0, level by level and in Morton order within a
// level, as the builder of octrees numbers them (compute/octree), so that no slot is empty:
//
//   block    the children of one node: of node n block n + 1. Block 0 is over the root and holds nothing but it.
//   slot     8 * block + i: the block's i-th child. A name: what lists and cuts hold, as with the other tree.
//   node     first + i, with `first` of the block: where the slot's sphere, cone and box are.
//
// All leaves are on one level.
#ifndef MYRIAD_COMPUTE_SVO_IO_H
#define MYRIAD_COMPUTE_SVO_IO_H

#include "compute/bsh/bsh_io.h"

MYRIAD_BEGIN
// Specialisation constant of kernels that walk either tree: it is this one. BshRef::frames are then SvoBlocks, its other arrays go by node, and there are no
// `leaves` and `blocks`.
const uint svo_constant = 24u;

// 20 bytes an inner node.
struct SvoBlock {
    vec3 origin;  // of the frame
    uint bits;    // the frame's step, which is a power of two and has its low bits free; children << 4; their height above the leaves
    uint first;   // child: node
};
MYRIAD_ARRAY(SvoBlocks, SvoBlock, 4)

MYRIAD_FN uint svo_bits(float step, uint children, uint height) { return floatBitsToUint(step) | children << 4 | height; }
MYRIAD_FN uint svo_children(SvoBlock block) { return block.bits >> 4 & 15u; }
MYRIAD_FN uint svo_height(SvoBlock block) { return block.bits & 15u; }
MYRIAD_FN vec4 svo_frame(SvoBlock block) { return vec4(block.origin, uintBitsToFloat(block.bits & 0x7f800000u)); }
MYRIAD_END

#ifdef __cplusplus
static_assert(sizeof(myriad::SvoBlock) == 20);
#endif

#endif
