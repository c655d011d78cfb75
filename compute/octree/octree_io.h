// What the octree builder's kernels and their host share, and what kernels that walk an octree read. See README.md.
#ifndef MYRIAD_COMPUTE_OCTREE_IO_H
#define MYRIAD_COMPUTE_OCTREE_IO_H

#include "compute/octree/octree.h"

MYRIAD_BEGIN
const uint octree_max_levels = octree_max_depth + 1u;
const uint octree_overflow = 1u;

// What is where. Nodes of all levels lie in one array, the root first, each level in Morton order. Counts go on past the capacity: then nothing of
// the tree is there (all levels have no nodes), `failed` is set, and `needed` says what it takes.
struct OctreeState {
    uint first[23];   // of each level's nodes; first[depth + 1] = all nodes, and the same in what follows
    uint count[22];   // nodes of each level
    uint items;
    uint needed;      // nodes
    uint failed;      // octree_overflow
};
MYRIAD_ARRAY(OctreeStates, OctreeState, 4)

// The children of node n are [first.at[n], first.at[n + 1]). Items are the level below the leaves: the children of a leaf, less the number of nodes,
// are its places in the list of sorted items.
struct OctreeRef {
    Uints first;          // nodes + 1
    Uint2s keys;          // of nodes: Morton keys of their cells at their level
    Uints items;          // sorted items: indices
    OctreeStates state;
};

// "octree/keys": a key and an index for each point.
struct OctreeKeysPush {
    Float4s points;       // w is not read
    Uint2s keys;
    Uints items;
    Uints count;          // count.at[0] points, clamped to max_items
    OctreeCube cube;
    uint depth, max_items;
};

// "octree/setup": from a length on the device, what the kernels below run over.
struct OctreeSetupPush {
    Uints item_count;     // clamped to max_items
    DispatchArgsArray args;
    Uints counts;         // items, and counters
    uint max_items, tile, workgroup_size, group_size, levels;
};
const uint octree_count_items = 0u;
const uint octree_count_counters = 1u;

// "octree/count": how many nodes of each level begin in each tile of the sorted keys; counters.at[level * columns + tile].
// "octree/write": writes them where the counters' prefix sums say.
// "octree/finish": one invocation: the state.
struct OctreeBuildPush {
    Uint2s sorted;
    Uints counters;
    Uints count;          // count.at[0] items
    Uints first;
    Uint2s keys;
    OctreeStates state;   // finish only
    uint depth, capacity;
};

// "octree/tally": over a level: how many items are below each node. The plainest of merges, which tests and `bench octree` run.
struct OctreeTallyPush {
    Uints first;
    Uints tally;          // of nodes
    OctreeStates state;
    uint level, leaves;   // whether this level is the leaves'
};
MYRIAD_END

#endif
