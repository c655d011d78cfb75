#version 460
#extension GL_GOOGLE_include_directive : require
// Which shared map each view's look-ups ask, where views have no whole map of their own.
#include "engine/kernel.glsl"
#include "passes/fuse/fuse_io.h"
layout(push_constant, scalar) uniform Push { FuseAskPush push; };

void main() {
    const uint i = thread_index();
    const uint node = push.first + i;
    if (i >= push.limit || node >= push.count.at[0]) return;
    SharedMap s = SharedMap(vec3(0.0f), fuse_no_map);
    const uint above = push.above.at[node];
    if (above != fuse_no_map) {
        s.offset = push.nodes.at[node].position - push.nodes.at[above].position;
        s.first = (push.limit + push.places.at[above - push.view_capacity]) * map_texels(push.map_size);
    }
    push.shared_maps.at[i] = s;
}
