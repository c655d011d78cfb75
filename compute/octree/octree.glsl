// What both kernels of a build do: go through the sorted keys, a group (engine/group.glsl) a tile, and see at which levels nodes begin.
//
// Item i begins a node at every level from the one where its key parts from that of item i - 1 down to the leaves. So one pass over the keys finds the
// nodes of all levels, and since an item that begins a node begins that node's first child too, a node's first child is the one written with it.
// As in compute/sort, a group of one invocation keeps its counters where the scan reads; a subgroup keeps them in registers, the same in all lanes.
#ifndef MYRIAD_COMPUTE_OCTREE_GLSL
#define MYRIAD_COMPUTE_OCTREE_GLSL

#include "engine/group.glsl"
#include "compute/sort/sort_io.h"
#include "compute/octree/octree_io.h"

layout(constant_id = 2) const uint tile_items = 1024u;
layout(push_constant, scalar) uniform Push { OctreeBuildPush push; };

// The highest level at which item i begins a node. `before` is the key of the item before.
uint begins(uint i, uvec2 before, uvec2 key) { return i == 0u ? 0u : octree_parting(before, key, push.depth); }

#endif
