#version 460
#extension GL_GOOGLE_include_directive : require
// Bounds of each tile's receivers: a sphere around the middle of their box, and a cone around the mean of their normals. One invocation a tile.
#include "engine/kernel.glsl"
#include "passes/pick/pick_io.h"
layout(push_constant, scalar) uniform Push { PickTilesPush push; };

void main() {
    const uint width = push.gbuffer.width, height = push.gbuffer.height, columns = pick_columns(width, push.side), tile = thread_index();
    if (tile >= columns * pick_columns(height, push.side)) return;
    const uint x0 = (tile % columns) * push.side, y0 = (tile / columns) * push.side;
    const uint x1 = min(x0 + push.side, width), y1 = min(y0 + push.side, height);
    vec3 low = vec3(3e38f), high = vec3(-3e38f), sum = vec3(0.0f);
    for (uint y = y0; y < y1; ++y)
        for (uint x = x0; x < x1; ++x) {
            const vec4 position = push.gbuffer.positions.at[y * width + x];
            if (position.w == 0.0f) continue;
            low = min(low, position.xyz);
            high = max(high, position.xyz);
            sum += unpack_direction(push.gbuffer.normals.at[y * width + x].x);
        }
    PickTile bounds = pick_tile_begin(low, high, sum);
    for (uint y = y0; y < y1; ++y)
        for (uint x = x0; x < x1; ++x) {
            const vec4 position = push.gbuffer.positions.at[y * width + x];
            if (position.w != 0.0f) bounds = pick_tile_add(bounds, position.xyz, unpack_direction(push.gbuffer.normals.at[y * width + x].x));
        }
    push.tiles.at[tile] = pick_tile_end(bounds);
}
