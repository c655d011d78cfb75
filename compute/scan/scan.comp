#version 460
#extension GL_GOOGLE_include_directive : require
// Scans each tile in place: a group walks it front to back with the running sum in a register. The last tile also writes
// the total behind the last item.
#include "engine/group.glsl"
#include "compute/scan/scan_io.h"
layout(push_constant, scalar) uniform Push { ScanTilePush push; };

void main() {
    const uint tile = group_index();
    const uint count = push.count.at[0];
    const uint tiles = max(1u, scan_tiles(count));
    if (tile >= tiles) return;
    const uint end = min(count, (tile + 1u) * scan_tile);
    uint running = push.has_sums != 0u ? push.sums.at[tile] : 0u;
    // The loop is uniform over the group: lanes past the end take part with zero.
    for (uint base = tile * scan_tile; base < end; base += group_size()) {
        const uint i = base + group_lane();
        const uint value = i < end ? push.values.at[i] : 0u;
        const uint before = group_exclusive_sum(value);
        if (i < end) push.values.at[i] = running + before;
        running += group_sum(value);
    }
    if (tile == tiles - 1u && group_elect()) push.values.at[count] = running;
}
