#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a moving vertex: morphed in its mesh's space, then taken to the world by what of matrices it hangs from. Order and
// roundings are those of scenes::deform, the twin.
#include "engine/kernel.glsl"
#include "passes/deform/deform_io.h"
layout(push_constant, scalar) uniform Push { DeformPush push; };

void main() {
    const uint i = thread_index();
    if (i >= push.count) return;
    const MovingVertex vertex = push.vertices.at[i];
    precise vec3 position = vertex.position, normal = vertex.normal;
    for (uint k = vertex.deltas, end = push.vertices.at[i + 1u].deltas; k < end; ++k) {
        const MorphDelta delta = push.deltas.at[k];
        const float weight = push.weights.at[delta.weight];
        position = position + delta.position * weight;
        normal = normal + delta.normal * weight;
    }
    Affine matrix = affine_zero();
    for (uint k = vertex.influences, end = push.vertices.at[i + 1u].influences; k < end; ++k) {
        const Influence influence = push.influences.at[k];
        matrix = affine_add(matrix, push.matrices.at[influence.matrix], influence.weight);
    }
    push.positions.at[i] = settled_point(affine_point(matrix, position));
    push.normals.at[i] = affine_normal(matrix, normal);
    if (push.has_tangents != 0u) push.tangents.at[i] = affine_tangent(matrix, push.tangents_at_rest.at[i]);
}
