#version 460
#extension GL_GOOGLE_include_directive : require
// The rival of the lists: one invocation walks one view's whole cut, depth first, with nothing in memory but the tree.
//
// The walk keeps, for each depth, the mask of children still to be opened: as many bits as the arity, which are depths enough for
// any tree. Going up is arithmetic (bsh_io.h). The same groups come out as from the lists, in another order.
#include "engine/kernel.glsl"
#include "compute/manylods/open.glsl"
layout(push_constant, scalar) uniform Push { WalkPush push; };

// Where a depth's mask is: the word, and the bit in it.
const uint masks_log2 = 5u - bsh_arity_log2;  // in a word
uint word_of(uint depth) { return depth >> masks_log2; }
uint bit_of(uint depth) { return bsh_arity * (depth & ((1u << masks_log2) - 1u)); }
const uint mask = (1u << bsh_arity) - 1u;

void keep(uint block, uint view, uint masks) {
    if (masks == 0u) return;
    const uint at = atomicAdd(push.state.at[0].kept, 1u);
    if (at < push.kept_capacity) push.kept.at[at] = cut_pack(block, view, masks);
}

void main() {
    const uint index = thread_index();
    if (index >= push.limit || push.first_view + index >= push.count.at[0]) return;
    const uint view_index = push.first_view + index;
    const View view = push.views.at[view_index];
    const uint leaves = push.tree.leaves;
    const uint over_root = push.tree.blocks;

    const uint root = classify_child(view, push.tree.frames.at[over_root], push.tree.spheres.at[bsh_arity * over_root],
                                     bsh_height(bsh_arity * over_root, bsh_shape(push.tree)), push.epsilon, push.map_size);
    keep(over_root, view_index, root & 0xffffu);
    if ((root >> 16) == 0u) return;

    uvec4 pending = uvec4(0u);
    uint depth = 0u;
    uint block = push.tree.blocks - 1u;
    bool arrived = true;
    uint opened = 0u;
    while (true) {
        if (arrived) {
            const uint found = open_block(block, view, push.tree, push.epsilon, push.map_size);
            keep(block, view_index, found & 0xffffu);
            pending[word_of(depth)] = (pending[word_of(depth)] & ~(mask << bit_of(depth))) | ((found >> 16) << bit_of(depth));
            ++opened;
        }
        const uint open = (pending[word_of(depth)] >> bit_of(depth)) & mask;
        if (open != 0u) {  // down, into the first child that is left
            pending[word_of(depth)] &= ~((open & (~open + 1u)) << bit_of(depth));
            block = bsh_arity * block + findLSB(open) - leaves;
            ++depth;
            arrived = true;
        } else {           // up
            if (depth == 0u) break;
            --depth;
            block = (block + leaves) >> bsh_arity_log2;
            arrived = false;
        }
    }
    atomicAdd(push.state.at[0].processed[0], opened);
}
