// What the kernels of point rendering read of the scene.
#ifndef MYRIAD_PASSES_POINTS_GLSL
#define MYRIAD_PASSES_POINTS_GLSL

#include "compute/instances/instances.glsl"
#include "compute/opacity/opacity.glsl"
#include "passes/points/points_io.h"

// The corners of a sample's triangle, from the eye.
Corners points_corners(PointsScene scene, uint triangle, vec3 eye) {
    uint stored = triangle;
    Instance instance;
    if (instanced) {
        instance = scene.instances.at[find_instance(scene.instances, scene.instance_count, triangle)];
        stored = instance.first_triangle + (triangle - instance.first_id);
    }
    const uvec4 t = scene.triangles.at[stored];
    Corners at = Corners(scene.positions.at[t.x], scene.positions.at[t.y], scene.positions.at[t.z]);
    if (instanced) at = instance_corners(instance, at);
    return Corners(at.p0 - eye, at.p1 - eye, at.p2 - eye);
}

// From a node down to the leaf that a pixel sees of it.
uint points_leaf_below(BshRef tree, uint slot, vec3 eye, vec3 w) {
    while (!bsh_is_leaf(slot, tree.leaves)) {
        const uint block = bsh_block_of(slot, bsh_shape(tree));
        const vec4 frame = tree.frames.at[block];
        float nearest = uintBitsToFloat(0x7f800000u);
        for (uint i = 0u; i < bsh_arity; ++i) {
            const uvec2 code = tree.spheres.at[bsh_arity * block + i];
            const float beside = points_beside(bsh_decode(frame, code).center - eye, w);
            if (bsh_is_absent(code) || !(i == 0u || beside < nearest)) continue;
            nearest = beside;
            slot = bsh_arity * block + i;
        }
    }
    return slot;
}

#endif
