// Opening a block: the decision that lists and walks share.
#include "compute/manylods/manylods_io.h"

// Reads 16 + 8 * 8 bytes of the tree and 32 of the view, and decides eight node-views in registers.
uint open_block(uint block, View view, BshRef tree, float epsilon, uint map_size) {
    const vec4 frame = tree.frames.at[block];
    const uint height = bsh_height(8u * block, tree.leaves, tree.blocks);
    uint found = 0u;
    [[unroll]] for (uint i = 0u; i < 8u; ++i)
        found |= classify_child(view, frame, tree.spheres.at[8u * block + i], height, epsilon, map_size) << i;
    return found;
}
