#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation: the grids of each level, from a length that only the device knows.
#include "compute/scan/scan_io.h"
layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Push { ScanSetupPush push; };

void main() {
    const ScanLevels levels = scan_levels(min(push.item_count.at[0], push.max_length));
    for (uint i = 0u; i < scan_max_levels; ++i) {
        // A level of no items still has one tile: its scan writes the total, zero.
        const uint groups = max(1u, scan_tiles(levels.count[i]));
        push.args.at[i] = grid_of((groups * push.group_size + push.workgroup_size - 1u) / push.workgroup_size);
        push.counts.at[i] = levels.count[i];
    }
}
