// What every kernel starts with: the workgroup (its size is specialisation constant 0) and where an invocation stands.
#ifndef MYRIAD_ENGINE_KERNEL_GLSL
#define MYRIAD_ENGINE_KERNEL_GLSL

#include "engine/shared.h"

layout(local_size_x = 64, local_size_x_id = 0) in;

// The index of this workgroup, and of this invocation, over the two-dimensional grid that long dispatches need. The
// grid may be larger than asked for: every kernel compares with its own count.
uint workgroup_index() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }
uint thread_index() { return workgroup_index() * gl_WorkGroupSize.x + gl_LocalInvocationIndex; }

#endif
