#version 460
#extension GL_GOOGLE_include_directive : require
// Which inner view nodes receive something. Many write the same 1.
#include "engine/kernel.glsl"
#include "passes/fuse/fuse_io.h"
layout(push_constant, scalar) uniform Push { FuseMarkPush push; };

void main() {
    const uint i = thread_index();
    if (i >= min(push.count.at[0], push.capacity)) return;
    const uint node = cut_unpack(push.groups.at[i]).view;
    if (node >= push.view_capacity) push.marks.at[node - push.view_capacity] = 1u;
}
