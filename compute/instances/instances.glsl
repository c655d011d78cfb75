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

#endif
