// The tree over views with what their lights send out, as kernels see it; see README.md.
#ifndef MYRIAD_PASSES_LIGHT_TREE_IO_H
#define MYRIAD_PASSES_LIGHT_TREE_IO_H

#include "compute/view_tree/view_tree_io.h"
#include "passes/vpl/vpl_io.h"

MYRIAD_BEGIN
// A node of a compute::ViewTree, by its number: 32 bytes, all that a walk needs. Lights below lie in the sphere, and their normals in the cone.
struct LightNode {
    vec3 position;
    float radius;
    uint axis;              // pack_direction
    float cos_spread;       // of the cone's half-angle; -1: all directions
    float flux;             // W, of all channels; 0: no light comes from here
    uint children;          // first child << 4 | how many; 0: a light
};
MYRIAD_ARRAY(LightNodes, LightNode, 16)

MYRIAD_FN uint light_first_child(LightNode node) { return node.children >> 4; }
MYRIAD_FN uint light_child_count(LightNode node) { return node.children & 15u; }

// Sums of many stay finite.
MYRIAD_FN float light_flux(vec3 flux) { return min(max(flux.x + flux.y + flux.z, 0.0f), 1e30f); }

MYRIAD_FN LightNode light_leaf(Vpl light) {
    LightNode node;
    node.position = light.position;
    node.radius = 0.0f;
    node.axis = light.normal;
    node.cos_spread = 1.0f;
    node.flux = light_flux(light.flux);
    node.children = 0u;
    return node;
}

// By how much packing turns an axis, and more (radians).
const float light_axis_slack = 1e-4f;

// Of an inner node: `bound` holds the frustums of its views, hemispheres, so it is wider than the cone of their normals by a right angle.
MYRIAD_FN LightNode light_inner(View bound, float radius, float flux, uint first_child, uint children) {
    LightNode node;
    node.position = bound.position;
    node.radius = radius;
    node.axis = pack_direction(bound.direction);
    const float sin_spread = max(-bound.cos_phi, 0.0f);
    node.cos_spread = bound.cos_phi <= -0.999f ? -1.0f : max(bound.sin_phi, 0.0f) - light_axis_slack * (sin_spread + light_axis_slack);
    node.flux = min(flux, 1e30f);
    node.children = first_child << 4 | children;
    return node;
}

// "light_tree/leaves": one invocation a light, in the tree's order.
struct LightLeavesPush {
    Vpls lights;
    Uints order;            // by place along the curve: which light
    Uints count;
    Vpls ordered;
    LightNodes nodes;
    uint limit;
};

// "light_tree/merge": one invocation an inner node of a level, the deepest level first.
struct LightMergePush {
    Views views;            // by node
    ViewGroups groups;
    ViewLevels levels;
    LightNodes nodes;
    uint level, capacity, inner;
};
MYRIAD_END

#ifdef __cplusplus
static_assert(sizeof(myriad::LightNode) == 32);
#endif

#endif
