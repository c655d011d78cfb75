#version 460
#extension GL_GOOGLE_include_directive : require
// The leaves and their parents. A leaf's triangles are a run of the octree's sorted items, in the triangles' order: what is summed has a fixed order.
#include "engine/kernel.glsl"
#include "compute/instances/instances.glsl"
#include "compute/opacity/opacity.glsl"
#include "compute/svo/svo_build.h"
layout(push_constant, scalar) uniform Push { SvoLeavesPush push; };
#include "compute/svo/svo_block.glsl"

layout(constant_id = 2) const bool asks = false;  // some surface is not everywhere

void main() {
    const uint level = svo_depth() - 1u;
    if (thread_index() >= push.octree.state.at[0].count[level] || !svo_fits()) return;
    const uint node = push.octree.state.at[0].first[level] + thread_index();
    const uint nodes = push.octree.state.at[0].first[level + 2u];
    const uint first = push.octree.first.at[node];
    const uint count = push.octree.first.at[node + 1u] - first;
    BshSpheres spheres;
    BshCones cones;
    BshBoxes boxes;
    SvoOwner owner = svo_owner();
    uint item = push.octree.first.at[first] - nodes;
    for (uint i = 0u; i < count; ++i) {
        const SvoCell cell = svo_cell(push.octree.keys.at[first + i], push.cube, svo_depth());
        const uint end = push.octree.first.at[first + i + 1u] - nodes;
        SvoLeaf leaf = svo_leaf();
        for (; item < end; ++item) {
            const uint triangle = push.octree.items.at[item];
            const Corners t = world_corners(push.instances, push.instance_count, push.triangles, push.positions, triangle);
            const SvoPiece piece = svo_piece(t, cell);
            uint missing = 0u;
            if (asks) {
                const vec2 at = svo_barycentrics(t, cell.middle + piece.mean * cell.half_side);
                missing = opacity_missing_at(push.opacity, triangle, at.x, at.y);
            }
            svo_add(leaf, piece, bsh_cone_of(t.p1 - t.p0, t.p2 - t.p0), missing);
        }
        spheres.at[i] = svo_sphere(leaf, cell);
        boxes.at[i] = svo_box(leaf, cell);
        boxes.missing[i] = leaf.missing;
        cones.at[i] = leaf.cone;
        push.cones.at[first + i] = leaf.cone;
        svo_add(owner, spheres.at[0].center, spheres.at[i], boxes.at[i], leaf.weight, leaf.missing);
    }
    write_block(node, level, first, count, spheres, cones, boxes, owner);
}
