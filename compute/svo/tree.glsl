// Either tree of a scene, for kernels that walk or draw it: what they ask of a block and of its slots.
#ifndef MYRIAD_COMPUTE_SVO_TREE_GLSL
#define MYRIAD_COMPUTE_SVO_TREE_GLSL

#include "compute/svo/svo_io.h"

layout(constant_id = svo_constant) const bool svo_tree = false;

struct TreeBlock {
    vec4 frame;
    uint first;     // of its children: where slot 8 * block + i has its sphere, cone and box
    uint children;  // of a BSH's some may be absent
    uint height;    // of the children, above the leaves; 0: they are leaves
};

TreeBlock tree_block(Float4s frames, uint block, BshShape shape) {
    if (svo_tree) {
        const SvoBlock b = SvoBlocks(frames).at[block];
        return TreeBlock(svo_frame(b), b.first, svo_children(b), svo_height(b));
    }
    return TreeBlock(frames.at[block], bsh_arity * block, bsh_arity, bsh_height(bsh_arity * block, shape));
}
uint tree_over_root(BshShape shape) { return svo_tree ? 0u : shape.blocks; }
uint tree_index(TreeBlock block, uint slot) { return block.first + (slot & (bsh_arity - 1u)); }
// The block that the inner node in this slot, which `block` holds, owns.
uint tree_block_of(TreeBlock block, uint slot, BshShape shape) { return svo_tree ? tree_index(block, slot) + 1u : bsh_block_of(slot, shape); }
uint tree_block_of(Float4s frames, uint slot, BshShape shape) {
    if (!svo_tree) return bsh_block_of(slot, shape);
    return SvoBlocks(frames).at[slot >> bsh_arity_log2].first + (slot & (bsh_arity - 1u)) + 1u;
}

#endif
