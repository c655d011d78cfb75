// What both kernels of a pass do: read digits, and count in counters of the group's own.
//
// A group (engine/group.glsl) has a tile of consecutive items and a counter for each digit. A group of one invocation walks its tile alone and
// counts where the scan will read: nothing is shared, no atomics, no ranking; a CPU device does best so. A subgroup walks its tile a subgroup's worth
// of items at a time and counts in shared memory; lanes with the same digit are found by ballots.
#ifndef MYRIAD_COMPUTE_SORT_GLSL
#define MYRIAD_COMPUTE_SORT_GLSL

#extension GL_KHR_shader_subgroup_shuffle : require
#include "engine/group.glsl"
#include "compute/sort/sort_io.h"

layout(constant_id = 2) const uint key_words = 1u;
layout(constant_id = 3) const uint tile_items = 1024u;
layout(constant_id = 4) const uint shared_counters = 1u;  // of all groups of a workgroup
layout(push_constant, scalar) uniform Push { SortPassPush push; };

shared uint counters[shared_counters];

// What lanes of a group wrote to shared memory is seen by its other lanes afterwards. All subgroups of a workgroup must come here equally often.
void group_sync() {
    subgroupMemoryBarrierShared();
    subgroupBarrier();
}

uvec2 key_at(uint i) { return key_words == 2u ? Uint2s(push.keys_in).at[i] : uvec2(push.keys_in.at[i], 0u); }
uint digit_in(uint word) { return word >> push.shift & (1u << push.bits) - 1u; }
uint digit_of(uvec2 key) { return digit_in(push.word == 0u ? key.x : key.y); }
uint digit_at(uint i) { return digit_in(push.keys_in.at[i * key_words + push.word]); }  // reads no more than the digit's word

#endif
