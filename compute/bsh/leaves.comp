#version 460
#extension GL_GOOGLE_include_directive : require
// The lowest level: leaves are discs around samples, bounded by spheres and by their triangles' normals.
#include "compute/bsh/bsh_block.glsl"
#include "compute/instances/instances.glsl"
#include "compute/opacity/opacity.glsl"

layout(constant_id = 2) const bool blends = false;  // some surface does

void main() {
    const uint block = own_block();
    if (bsh_arity * block >= push.nodes) return;
    BshSpheres spheres;
    BshCones cones;
    BshBoxes boxes;
    for (uint i = 0u; i < bsh_arity; ++i) {
        const uint leaf = child_of(block, i);
        const SurfaceSample s = push.samples.at[leaf];
        const Corners at = world_corners(push.instances, push.instance_count, push.triangles, push.positions, s.triangle);
        const vec3 a = at.p0;
        const vec3 b = at.p1;
        const vec3 c = at.p2;
        spheres.at[i].center = bsh_position(a, b, c, s.u, s.v);
        spheres.at[i].radius = push.leaf_radius;
        cones.at[i] = bsh_cone_of(b - a, c - a);
        push.cones.at[leaf] = cones.at[i];
        boxes.at[i] = bsh_patch_box(spheres.at[i].center, a, b, c, cones.at[i], push.leaf_radius, push.leaf_share);
        boxes.missing[i] = blends ? opacity_missing_at(push.opacity, s.triangle, s.u, s.v) : 0u;
    }
    write_block(block, spheres, cones, boxes);
}
