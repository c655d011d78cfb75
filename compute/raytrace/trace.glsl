// Closest hits and occlusion of rays, for any kernel:
//
//     RayHit trace_closest(BvhRef bvh, vec3 origin, vec3 direction, float t_min, float t_max)
//     bool trace_occluded(BvhRef bvh, vec3 origin, vec3 direction, float t_min, float t_max)
//
// A triangle is hit where it is (compute/opacity): rays pass the holes of cut-outs.
//
// Hits lie in the open interval, 0 <= t_min; t counts in lengths of `direction`, which need not be unit. Start rays at
// ray_origin() (raytrace_io.h). The results depend on the scene and the ray alone, not on the tree or on other rays:
// of two triangles at the same t, the one of lower index is hit.
//
// Where a subgroup has eight lanes, as on lavapipe, and all of them call, the eight rays share one traversal
// (trace_packet.glsl): 2 to 3 times as fast for neighbouring rays, 1.3 to 1.5 times for unrelated ones. So call with all
// lanes: a lane that has nothing to ask passes t_max < t_min instead of branching around the call. Elsewhere, and with
// lanes missing, each lane walks alone (trace_single.glsl).
#ifndef MYRIAD_COMPUTE_RAYTRACE_TRACE_GLSL
#define MYRIAD_COMPUTE_RAYTRACE_TRACE_GLSL

#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_shuffle : require

#include "engine/group.glsl"
#include "compute/raytrace/raytrace_io.h"
#include "compute/raytrace/intersect.h"
#include "compute/instances/instances.glsl"
#include "compute/opacity/opacity.glsl"

layout(constant_id = trace_asks_constant) const bool trace_asks = false;

const uint no_triangle = 0xffffffffu;

struct RayHit {
    float t;             // t_max for a miss
    uint triangle;       // as in the scene; no_triangle for a miss
    float u, v;          // position = (1 - u - v) p0 + u p1 + v p2
    bool front;          // the ray met the side that sees p0, p1, p2 counter-clockwise
};

// Becomes true when the rays of this invocation together took more steps than BvhRef::loop_budget, most of what the device
// lets an invocation loop (engine: Device::loop_limit); results are then void. Kernels OR it into a status word, and the
// host makes an error of it or splits the work.
bool trace_exhausted = false;
uint trace_steps = 0u;

// Which dice this invocation's rays throw at blended surfaces (opacity_io.h).
uint trace_dice = opacity_alone;

bool trace_step(BvhRef bvh) {
    if (++trace_steps > bvh.loop_budget) trace_exhausted = true;
    return !trace_exhausted;
}

struct TraceState {
    TraceRay ray;
    uint slot;           // of the closest hit: an element of bvh.triangles
    uint first_id;       // of its instance, if there are any
    vec3 weights;
};

// Where the boxes are that are tested: the world, or within an instance, the mesh's own space.
struct TraceSpace {
    vec3 origin, inverse;  // of the ray, there; t is the same
    vec3 pad;              // what boxes are enlarged by; 0 in the world
    uint floor_;           // how high the stack was where the instance was entered; 0 in the world
    Instance instance;
};

TraceSpace trace_in_world(TraceRay ray) {
    TraceSpace space;
    space.origin = ray.origin;
    space.inverse = ray.inverse;
    space.pad = vec3(0.0);
    space.floor_ = 0u;
    return space;
}

// Into an instance, whose node says how (bvh_is_instance). `space.instance` is the caller's to load, whose lanes may share the work.
void trace_enter(inout TraceSpace space, TraceRay ray, vec3 axis_x, vec3 axis_y, vec3 axis_z, vec3 at, vec3 far, uint top) {
    space.floor_ = top;
    if ((space.instance.flags & instance_in_world) != 0u) return;
    const vec3 from = ray.origin - at;
    space.origin = axis_x * from.x + axis_y * from.y + axis_z * from.z;
    space.inverse = ray_inverses(axis_x * ray.direction.x + axis_y * ray.direction.y + axis_z * ray.direction.z);
    space.pad = ray.t_max < ray.t_min ? vec3(0.0) : instance_pad(axis_x, axis_y, axis_z, from, far);
}

void trace_leave(inout TraceSpace space, TraceRay ray) {
    space.origin = ray.origin;
    space.inverse = ray.inverse;
    space.pad = vec3(0.0);
    space.floor_ = 0u;
}

uint trace_id(BvhRef bvh, uint slot, uint first_id) {
    const uint id = trace_asks ? bvh.triangles.at[slot].id & ~bvh_asks : bvh.triangles.at[slot].id;
    return instanced ? first_id + id : id;
}

// Whether the triangle is where it was hit, if it asks.
bool trace_counts(BvhRef bvh, TraceSpace space, uint slot, vec3 weights) {
    const uint word = bvh.triangles.at[slot].id;
    if ((word & bvh_asks) == 0u) return true;
    const uint own = word & ~bvh_asks;
    if (!instanced || (space.instance.flags & instance_in_world) != 0u) return opacity_is_there(bvh.opacity, own, weights.x, weights.y, trace_dice);
    const OpacityPlace at = OpacityPlace(space.instance.first_triangle + own, instance_swaps(space.instance));
    return opacity_is_there(bvh.opacity, at, space.instance.first_id + own, weights.x, weights.y, trace_dice);
}

// In `any` mode a ray that has met something gets t_max = -1, so that nothing else meets it.
void trace_triangle(BvhRef bvh, inout TraceState state, TraceSpace space, uint slot, Corners corners, const bool any) {
    float t;
    vec3 weights;
    // In the world, on the very floats that the triangle had if it were not shared: hits are the same, and so is their order.
    if (instanced) corners = instance_corners(space.instance, corners);
    if (!triangle_hit(state.ray, corners.p0, corners.p1, corners.p2, t, weights)) return;
    bool closer = t < state.ray.t_max;
    if (!any && t == state.ray.t_max && state.slot != no_triangle)
        closer = trace_id(bvh, slot, space.instance.first_id) < trace_id(bvh, state.slot, state.first_id);
    if (!closer) return;
    if (trace_asks && !trace_counts(bvh, space, slot, weights)) return;
    state.slot = slot;
    if (instanced) state.first_id = space.instance.first_id;
    state.ray.t_max = any ? -1.0 : t;
    if (!any) state.weights = weights;
}

// Children of a node wait on the stack as one word of order, a nibble each, nearest lowest: 1 + the child, 0 for none.
// The key of a child sorts by its distance; its lowest three bits are the child.
const uint no_key = 0xffffffffu;
uint trace_key(float entry, uint child) { return (floatBitsToUint(entry) & ~7u) | child; }
float trace_key_entry(uint key) { return uintBitsToFloat(key & ~7u); }

// The triangles of a leaf as bits, counted from the node's first.
uint trace_leaf(uvec2 child) { return ((1u << (child.x >> 24)) - 1u) << (child.y >> 24); }

#include "compute/raytrace/trace_single.glsl"
#include "compute/raytrace/trace_packet.glsl"

TraceState trace(BvhRef bvh, vec3 origin, vec3 direction, float t_min, float t_max, const bool any) {
    TraceState state;
    state.ray = trace_ray(origin, direction, t_min, t_max);
    state.slot = no_triangle;
    state.first_id = 0u;
    state.weights = vec3(0.0);
    if (!plain_groups && gl_SubgroupSize == 8u && subgroupBallotBitCount(subgroupBallot(true)) == 8u) trace_packet(bvh, state, any);
    else trace_single(bvh, state, any);
    return state;
}

RayHit trace_closest(BvhRef bvh, vec3 origin, vec3 direction, float t_min, float t_max) {
    const TraceState state = trace(bvh, origin, direction, t_min, t_max, false);
    RayHit hit;
    hit.t = state.ray.t_max;
    hit.triangle = no_triangle;
    if (state.slot != no_triangle) hit.triangle = trace_id(bvh, state.slot, state.first_id);
    hit.u = state.weights.x;
    hit.v = state.weights.y;
    hit.front = state.weights.z > 0.0;
    return hit;
}

bool trace_occluded(BvhRef bvh, vec3 origin, vec3 direction, float t_min, float t_max) {
    return trace(bvh, origin, direction, t_min, t_max, true).slot != no_triangle;
}

#endif
