#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a node: the boxes of its children anew, from their triangles where they are leaves, else from what the level below
// left for them.
#include "engine/kernel.glsl"
#include "compute/raytrace/bvh_pack.h"
layout(push_constant, scalar) uniform Push { BvhRefitPush push; };

BvhBox box_of(uint triangle) {
    return bvh_box_of(push.triangles.at[triangle].p0, push.triangles.at[triangle].p1, push.triangles.at[triangle].p2);
}

void main() {
    if (thread_index() >= push.count) return;
    const uint index = push.moving.at[push.first + thread_index()];
    BvhNode node = push.nodes.at[index];
    const uint count = bvh_children(node.frame);
    if (count == bvh_is_instance) {  // of what moves; that is stored in world space
        push.boxes.at[index] = push.boxes.at[node.first_child];
        return;
    }
    BvhChildren children;
    BvhBox all;
    for (uint i = 0u; i < count; ++i) {
        const uint triangles = node.child[i].x >> 24;
        BvhBox box;
        if (triangles == 0u) {
            box = push.boxes.at[node.first_child + i];
        } else {
            const uint first = node.first_triangle + (node.child[i].y >> 24);
            box = box_of(first);
            for (uint k = 1u; k < triangles; ++k) box = bvh_united(box, box_of(first + k));
        }
        children.box[i] = box;
        if (i == 0u) all = box;
        else all = bvh_united(all, box);
    }
    if (count == 0u) return;  // of an empty tree
    push.boxes.at[index] = all;
    push.nodes.at[index] = bvh_pack(node, children, count);
}
