// How bounds of views are merged, for the kernel and its twin. All is rounded outward.
#ifndef MYRIAD_COMPUTE_VIEW_TREE_MERGE_H
#define MYRIAD_COMPUTE_VIEW_TREE_MERGE_H

#include "compute/view_tree/view_tree_io.h"

MYRIAD_BEGIN
// What floats may have lost, relative to the lengths that were added up.
const float view_tree_rounding = 1.0f / 1048576.0f;

MYRIAD_FN ViewBox view_box_empty() {
    ViewBox b;
    b.low = vec3(3e38f);
    b.high = vec3(-3e38f);
    return b;
}
MYRIAD_FN ViewBox view_box_of(View view) {
    ViewBox b = view_box_empty();
    if (view_sees_nothing(view)) return b;
    b.low = view.position;
    b.high = view.position;
    return b;
}
MYRIAD_FN ViewBox view_box_merge(ViewBox a, ViewBox b) {
    a.low = min(a.low, b.low);
    a.high = max(a.high, b.high);
    return a;
}
MYRIAD_FN vec3 view_box_middle(ViewBox b) { return 0.5f * b.low + 0.5f * b.high; }
// Of a sphere around the middle that holds the box.
MYRIAD_FN float view_box_radius(ViewBox b) {
    const vec3 c = view_box_middle(b);
    const vec3 reach = max(b.high - c, c - b.low);
    if (reach.x <= 0.0f && reach.y <= 0.0f && reach.z <= 0.0f) return 0.0f;
    return sqrt(reach.x * reach.x + reach.y * reach.y + reach.z * reach.z) * (1.0f + view_tree_rounding) + 1e-18f;
}
// How far a child's sphere reaches from c. Its own radius where the centres are one, so that a place stays a place.
MYRIAD_FN float view_reach(vec3 c, vec3 center, float radius) {
    const vec3 d = center - c;
    if (d.x == 0.0f && d.y == 0.0f && d.z == 0.0f) return radius;
    return (sqrt(d.x * d.x + d.y * d.y + d.z * d.z) + radius) * (1.0f + view_tree_rounding) + 1e-18f;
}

// The least cosine of an angle that holds the cone (direction, cos_phi, sin_phi) around `axis`; -1 where it is all directions.
MYRIAD_FN float view_cone_around(vec3 axis, View view) {
    if (axis == view.direction) return view.cos_phi;
    const float c = dot(axis, view.direction);
    if (c + view.cos_phi <= 4.0f * view_tree_rounding) return -1.0f;  // the angles' sum is pi or more
    const vec3 n = cross(axis, view.direction);
    const float s = sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
    return max(c * view.cos_phi - s * view.sin_phi - 4.0f * view_tree_rounding, -1.0f);
}
MYRIAD_END

#endif
