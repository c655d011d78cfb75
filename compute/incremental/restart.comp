#version 460
#extension GL_GOOGLE_include_directive : require
// The trivial cut to start from: the root of every view, which need not even exist, culled and due. Places [0, limit) of the list are theirs
// for good.
#include "engine/kernel.glsl"
#include "compute/incremental/incremental_io.h"
layout(push_constant, scalar) uniform Push { TravelPush push; };

void main() {
    const uint i = thread_index();
    if (i >= push.limit) return;
    CarriedRefs memory = push.memory.at[0];
    memory.codes.at[i] = cut_pack(push.over_root, push.first_view + i, cut_no_view);
    memory.dues.at[i] = Due(-1.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0u);
    memory.travels.at[i] = Travel(0.0f, 0.0f, 0.0f, 0u, vec3(0.0f), vec3(0.0f));
    memory.before.at[i] = View(vec3(0.0f), 0.0f, vec3(0.0f), 0.0f);
    if (i == 0u) memory.state.at[0] = CarriedState(0u, push.limit, 0u, 0u, 0u, 0u, 0u);
}
