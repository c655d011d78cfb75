#version 460
#extension GL_GOOGLE_include_directive : require
// The rival of the lists: one invocation walks one view's whole cut, depth first, with nothing in memory but the tree.
//
// The walk keeps, for each depth, the mask of children still to be opened: eight bits a depth, four depths a word. Going up
// is arithmetic (bsh_io.h). The same groups come out as from the lists, in another order.
#include "engine/kernel.glsl"
#include "compute/manylods/open.glsl"
layout(push_constant, scalar) uniform Push { WalkPush push; };

uint byte_of(uvec4 words, uint i) { return (words[i >> 2] >> (8u * (i & 3u))) & 0xffu; }

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

    const uint root = classify_child(view, push.tree.frames.at[over_root], push.tree.spheres.at[8u * over_root],
                                     bsh_height(8u * over_root, leaves, over_root), push.epsilon, push.map_size);
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
            pending[depth >> 2] = (pending[depth >> 2] & ~(0xffu << (8u * (depth & 3u)))) | ((found >> 16) << (8u * (depth & 3u)));
            ++opened;
        }
        const uint open = byte_of(pending, depth);
        if (open != 0u) {  // down, into the first child that is left
            pending[depth >> 2] &= ~((open & (~open + 1u)) << (8u * (depth & 3u)));
            block = 8u * block + findLSB(open) - leaves;
            ++depth;
            arrived = true;
        } else {           // up
            if (depth == 0u) break;
            --depth;
            block = (block + leaves) >> 3;
            arrived = false;
        }
    }
    atomicAdd(push.state.at[0].processed[0], opened);
}
