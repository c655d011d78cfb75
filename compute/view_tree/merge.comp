#version 460
#extension GL_GOOGLE_include_directive : require
// Bounds of a level's nodes from their children's: a sphere around the places, and a cone that holds all frustums.
#include "engine/kernel.glsl"
#include "compute/view_tree/view_tree_merge.h"
layout(push_constant, scalar) uniform Push { ViewMergePush push; };

void main() {
    const ViewLevel level = push.levels.at[push.level];
    if (thread_index() >= level.count) return;
    const uint node = level.first + thread_index();
    const uint inner = node - push.capacity;
    if (inner >= push.inner) return;
    const ViewGroup group = push.groups.at[inner];
    const bool leaf = group.first_child < push.capacity;

    ViewBox box = view_box_empty();
    vec3 sum = vec3(0.0f);
    for (uint i = 0u; i < group.children; ++i) {
        const uint child = group.first_child + i;
        const View view = push.nodes.at[child];
        if (view_sees_nothing(view)) continue;
        ViewBox part = view_box_of(view);
        if (!leaf) part = push.boxes.at[child - push.capacity];
        box = view_box_merge(box, part);
        sum += view.direction;
    }
    View merged = view_of_nothing();
    float radius = 0.0f;
    if (box.low.x <= box.high.x) {
        merged.position = view_box_middle(box);
        radius = view_box_radius(box);
        const float length2 = dot(sum, sum);
        float least = -1.0f;
        merged.direction = vec3(1.0f, 0.0f, 0.0f);
        if (length2 > 1e-6f) {  // of at most 8 units: less has no direction to speak of
            merged.direction = sum / sqrt(length2);
            least = 1.0f;
        }
        float reach = 0.0f;
        for (uint i = 0u; i < group.children; ++i) {
            const uint child = group.first_child + i;
            const View view = push.nodes.at[child];
            if (view_sees_nothing(view)) continue;
            least = min(least, view_cone_around(merged.direction, view));
            reach = max(reach, view_reach(merged.position, view.position, leaf ? 0.0f : push.groups.at[child - push.capacity].radius));
        }
        radius = min(radius, reach);
        merged.cos_phi = least;
        merged.sin_phi = sqrt(max(1.0f - least * least, 0.0f));
    }
    push.boxes.at[inner] = box;
    push.groups.at[inner].radius = radius;
    push.nodes.at[node] = merged;
}
