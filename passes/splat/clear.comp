#version 460
#extension GL_GOOGLE_include_directive : require
// Empties the maps of views that changed.
#include "engine/kernel.glsl"
#include "passes/splat/splat_io.h"
layout(push_constant, scalar) uniform Push { SplatClearPush push; };

void main() {
    const uint row = thread_index();
    const uint view = row / (2u * push.map_size);
    if (view >= push.views || push.changed.at[view] == 0u) return;
    for (uint x = 0u; x < push.map_size; ++x) push.atlas.at[row * push.map_size + x] = atlas_nothing;
}
