#version 460
#extension GL_GOOGLE_include_directive : require
// A level's nodes: flux from their children's, in their order, so that sums are the same in every run; bounds from the tree of views.
#include "engine/kernel.glsl"
#include "passes/light_tree/light_tree_io.h"
layout(push_constant, scalar) uniform Push { LightMergePush push; };

void main() {
    const ViewLevel level = push.levels.at[push.level];
    if (thread_index() >= level.count) return;
    const uint node = level.first + thread_index();
    if (node - push.capacity >= push.inner) return;
    const ViewGroup group = push.groups.at[node - push.capacity];
    float flux = 0.0f;
    for (uint i = 0u; i < group.children; ++i) flux += push.nodes.at[group.first_child + i].flux;
    push.nodes.at[node] = light_inner(push.views.at[node], group.radius, flux, group.first_child, group.children);
}
