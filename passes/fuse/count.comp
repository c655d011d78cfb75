#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes/fuse/fuse_io.h"
layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Push { FuseCountPush push; };

void main() {
    const uint needed = push.places.at[push.inner_nodes.at[0]];
    push.needed.at[0] = needed;
    if (needed > push.room) atomicOr(push.lists.at[0].failed, append_caller_overflow);
}
