#version 460
#extension GL_GOOGLE_include_directive : require
// The leaves and their parents. A workgroup has svo_parents consecutive parents: first its lanes share out their leaves, then the parents. A lane's leaves are
// consecutive too, and gone through triangle by triangle: lanes of a subgroup then have about as many triangles, where leaves and parents have few or many.
// A leaf's triangles are a run of the octree's sorted items, in the triangles' order: what is summed has a fixed order.
#include "engine/kernel.glsl"
#include "compute/instances/instances.glsl"
#include "compute/opacity/opacity.glsl"
#include "compute/svo/svo_build.h"
layout(push_constant, scalar) uniform Push { SvoLeavesPush push; };
#include "compute/svo/svo_block.glsl"

layout(constant_id = 2) const bool asks = false;  // some surface is not everywhere

shared vec4 spheres[8u * svo_parents];
shared vec4 lows[8u * svo_parents];
shared vec4 highs[8u * svo_parents];
shared uint cones[8u * svo_parents];

SvoChild svo_child(uint at) {
    const vec4 s = spheres[at];
    const vec4 low = lows[at];
    const vec4 high = highs[at];
    return SvoChild(Sphere(s.xyz, s.w), BshBox(low.xyz, high.xyz), low.w, uint(high.w), cones[at]);
}

void make_leaves(uint leaf, uint end, uint base) {
    if (leaf >= end) return;
    const uint nodes = push.octree.state.at[0].first[svo_depth() + 1u];
    uint item = push.octree.first.at[leaf] - nodes;
    const uint last = push.octree.first.at[end] - nodes;
    uint behind = item;  // the leaf's last item
    SvoCell cell;
    SvoLeaf sum;
    for (; item < last; ++item) {
        if (item == behind) {
            cell = svo_cell(push.octree.keys.at[leaf], push.cube, svo_depth());
            sum = svo_leaf();
            behind = push.octree.first.at[leaf + 1u] - nodes;
        }
        const uint triangle = push.octree.items.at[item];
        const SvoTriangle t = push.triangles.at[triangle];
        const SvoPiece piece = svo_piece(t.corners, cell);
        uint missing = 0u;
        if (asks) {
            const vec2 at = svo_barycentrics(t.corners, cell.middle + piece.mean * cell.half_side);
            missing = opacity_missing_at(push.opacity, triangle, at.x, at.y);
        }
        svo_add(sum, piece, t.cone, missing);
        if (item + 1u < behind) continue;
        const Sphere s = svo_sphere(sum, cell);
        const BshBox box = svo_box(sum, cell);
        spheres[leaf - base] = vec4(s.center, s.radius);
        lows[leaf - base] = vec4(box.low, sum.weight);
        highs[leaf - base] = vec4(box.high, float(sum.missing));
        cones[leaf - base] = sum.cone;
        push.cones.at[leaf] = sum.cone;
        ++leaf;
    }
}

void main() {
    const uint level = svo_depth() - 1u;
    const uint begin = workgroup_index() * svo_parents;
    const uint parents = push.octree.state.at[0].count[level];
    if (begin >= parents || !svo_fits()) return;  // all of a workgroup
    const uint node = push.octree.state.at[0].first[level] + begin;
    const uint count = min(parents - begin, svo_parents);
    const uint base = push.octree.first.at[node];
    const uint leaves = push.octree.first.at[node + count] - base;
    const uint lane = gl_LocalInvocationIndex;
    make_leaves(base + leaves * lane / gl_WorkGroupSize.x, base + leaves * (lane + 1u) / gl_WorkGroupSize.x, base);
    barrier();
    for (uint i = lane; i < count; i += gl_WorkGroupSize.x) {
        const uint first = push.octree.first.at[node + i];
        write_block(node + i, level, first, push.octree.first.at[node + i + 1u] - first, first - base);
    }
}
