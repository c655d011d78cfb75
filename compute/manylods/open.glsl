// Opening a block: the decision that lists and walks share.
#include "compute/manylods/manylods_io.h"

// Reads 16 + 8 * arity bytes of the tree and 32 of the view, and decides so many node-views in registers.
uint open_block(uint block, View view, BshRef tree, float epsilon, uint map_size) {
    const vec4 frame = tree.frames.at[block];
    const uint height = bsh_height(bsh_arity * block, bsh_shape(tree));
    uint found = 0u;
    [[unroll]] for (uint i = 0u; i < bsh_arity; ++i)
        found |= classify_child(view, frame, tree.spheres.at[bsh_arity * block + i], height, epsilon, map_size) << i;
    return found;
}
