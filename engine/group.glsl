// A *group* is the unit that scans and appends cooperate in: the subgroup, whatever its size, with no barrier. With
// specialisation constant 1 set (MYRIAD_PLAIN_GROUPS=1, or a device without subgroup arithmetic) a group is a single
// invocation and the same kernels run without subgroup operations: slower, and the twin that tests compare with.
#ifndef MYRIAD_ENGINE_GROUP_GLSL
#define MYRIAD_ENGINE_GROUP_GLSL

#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require

#include "engine/kernel.glsl"

layout(constant_id = 1) const bool plain_groups = false;

uint group_size() { return plain_groups ? 1u : gl_SubgroupSize; }
uint group_lane() { return plain_groups ? 0u : gl_SubgroupInvocationID; }

// Which group of the dispatch this is. Derived from subgroup built-ins, since nothing ties a subgroup's invocations to
// consecutive local indices.
uint group_index() {
    return plain_groups ? thread_index() : workgroup_index() * gl_NumSubgroups + gl_SubgroupID;
}

uint group_sum(uint v) { return plain_groups ? v : subgroupAdd(v); }
uint group_exclusive_sum(uint v) { return plain_groups ? 0u : subgroupExclusiveAdd(v); }
uint group_first(uint v) { return plain_groups ? v : subgroupBroadcastFirst(v); }
bool group_elect() { return plain_groups ? true : subgroupElect(); }

#endif
