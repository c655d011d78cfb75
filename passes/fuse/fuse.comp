#version 460
#extension GL_GOOGLE_include_directive : require
// What a node's views share with others comes into its own map: from the nearest map above, which holds all of those above it already.
#include "engine/kernel.glsl"
#include "passes/fuse/fuse_io.h"
layout(push_constant, scalar) uniform Push { FusePush push; };

void main() {
    if (push.failed.at[0] != 0u) return;
    const uint i = thread_index() / fuse_threads;
    uint node;
    uint map;
    if (push.level == fuse_of_views) {
        node = push.first + i;
        if (i >= push.limit || node >= push.count.at[0]) return;
        map = i;
    } else {
        const ViewLevel level = push.levels.at[push.level];
        node = level.first + i;
        if (i >= level.count || node - push.view_capacity >= push.inner) return;
        if (push.marks.at[node - push.view_capacity] == 0u) return;
        map = push.limit + push.places.at[node - push.view_capacity];
    }
    const uint above = push.above.at[node];
    if (above == fuse_no_map) return;
    const View view = push.nodes.at[node];
    if (view_sees_nothing(view)) return;
    const vec3 offset = view.position - push.nodes.at[above].position;
    const uint size = push.map_size;
    const uint own = map * map_texels(size);
    const uint shared_map = (push.limit + push.places.at[above - push.view_capacity]) * map_texels(size);
    for (uint row = thread_index() % fuse_threads; row < 2u * size; row += fuse_threads) {
        const uint half_index = row / size;
        for (uint x = 0u; x < size; ++x) {
            const uint texel = row * size + x;
            const uint depth = push.atlas.at[shared_map + texel];
            if (depth == atlas_nothing) continue;
            const float t = fused_depth(offset, unproject(half_index, texel_middle(x, row - half_index * size, size)), uintBitsToFloat(depth));
            if (t < uintBitsToFloat(push.atlas.at[own + texel])) push.atlas.at[own + texel] = floatBitsToUint(t);
        }
    }
}
