#version 460
#extension GL_GOOGLE_include_directive : require
// Sums each tile of the items into one item of the level above.
#include "engine/group.glsl"
#include "compute/scan/scan_io.h"
layout(push_constant, scalar) uniform Push { ScanTilePush push; };

void main() {
    const uint tile = group_index();
    const uint count = push.count.at[0];
    if (tile >= scan_tiles(count)) return;
    const uint end = min(count, (tile + 1u) * scan_tile);
    uint sum = 0u;
    for (uint i = tile * scan_tile + group_lane(); i < end; i += group_size()) sum += push.values.at[i];
    sum = group_sum(sum);
    if (group_elect()) push.sums.at[tile] = sum;
}
