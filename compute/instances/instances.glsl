// Which instance a triangle of the world belongs to, for kernels.
#ifndef MYRIAD_COMPUTE_INSTANCES_GLSL
#define MYRIAD_COMPUTE_INSTANCES_GLSL

#include "compute/instances/instances.h"

layout(constant_id = instanced_constant) const bool instanced = false;

// The instance of a triangle; `count` > 0 instances.
uint find_instance(Instances instances, uint count, uint triangle) {
    uint low = 0u;
    uint high = count - 1u;
    while (low < high) {
        const uint middle = (low + high + 1u) / 2u;
        if (instances.at[middle].first_id <= triangle) low = middle;
        else high = middle - 1u;
    }
    return low;
}

// A triangle of the world, wherever its vertices are stored.
Corners world_corners(Instances instances, uint count, Uint4s triangles, Positions positions, uint triangle) {
    uint stored = triangle;
    Instance instance;
    if (instanced) {
        instance = instances.at[find_instance(instances, count, triangle)];
        stored = instance.first_triangle + (triangle - instance.first_id);
    }
    const uvec4 t = triangles.at[stored];
    const Corners corners = Corners(positions.at[t.x], positions.at[t.y], positions.at[t.z]);
    return instanced ? instance_corners(instance, corners) : corners;
}

#endif
