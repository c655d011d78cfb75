// The cut of many views, in groups: what the node-view kernels write and the splat reads.
//
// A group stands for up to eight node-views of sibling nodes in one view, in 64 bits: the block that holds the siblings,
// the view, and two masks over the block's slots, of which there are as many as the tree's arity. It is the paper's inactive list (ManyLoDs 3.1), run-length coded:
// culled node-views stay in it, as the paper keeps them (3.2), and cost nothing there.
#ifndef MYRIAD_COMPUTE_CUT_IO_H
#define MYRIAD_COMPUTE_CUT_IO_H

#include "engine/shared.h"

MYRIAD_BEGIN
const uint cut_max_blocks = 1u << 26;  // at arity 8, 2^28 samples and more; at 2, 2^25
const uint cut_max_views = 1u << 22;   // four million

struct CutGroup {
    uint block, view;
    uint drawn;   // bit i: slot arity * block + i is in the cut and valid (or a leaf)
    uint culled;  // bit i: it is in the cut and outside the view's frustum
};

MYRIAD_FN uvec2 cut_pack(uint block, uint view, uint masks) {  // masks: drawn | culled << 8
    return uvec2(block | (view << 26), (view >> 6) | (masks << 16));
}
MYRIAD_FN CutGroup cut_unpack(uvec2 code) {
    CutGroup g;
    g.block = code.x & 0x3ffffffu;
    g.view = (code.x >> 26) | ((code.y & 0xffffu) << 6);
    g.drawn = (code.y >> 16) & 0xffu;
    g.culled = code.y >> 24;
    return g;
}
MYRIAD_END

#endif
