#version 460
#extension GL_GOOGLE_include_directive : require
// From which node's map each node inherits.
#include "engine/kernel.glsl"
#include "passes/fuse/fuse_io.h"
layout(push_constant, scalar) uniform Push { FuseInheritPush push; };

void main() {
    const ViewLevel level = push.levels.at[push.level];
    if (thread_index() >= level.count) return;
    const uint node = level.first + thread_index();
    const uint inner = node - push.view_capacity;
    if (inner >= push.inner) return;
    uint above = fuse_no_map;
    if (push.level != 0u) above = push.above.at[node];
    else push.above.at[node] = fuse_no_map;
    if (push.marks.at[inner] != 0u) above = node;
    const ViewGroup group = push.groups.at[inner];
    for (uint i = 0u; i < group.children; ++i) push.above.at[group.first_child + i] = above;
}
