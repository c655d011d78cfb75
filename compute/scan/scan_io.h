// What the scan kernels and their host share.
#ifndef MYRIAD_COMPUTE_SCAN_IO_H
#define MYRIAD_COMPUTE_SCAN_IO_H

#include "engine/shared.h"

MYRIAD_BEGIN
// Items that one group reduces or scans before it writes a sum. Long enough that the sums are nothing beside the items;
// short enough that 2^16 items already make 64 groups.
const uint scan_tile = 1024u;
const uint scan_max_levels = 3u;  // 1024^3 = 2^30 items

MYRIAD_FN uint scan_tiles(uint count) { return (count + scan_tile - 1u) / scan_tile; }

// Where the sums of tiles of each level live, one after the other, each with room for its total.
struct ScanLevels {
    uint count[3];   // items of each level; 0 where there is no such level
};
MYRIAD_FN ScanLevels scan_levels(uint items) {
    ScanLevels levels;
    levels.count[0] = items;
    levels.count[1] = scan_tiles(items);
    levels.count[2] = scan_tiles(levels.count[1]);
    return levels;
}

// "scan/setup": from a length on the device, the grids of the kernels below.
struct ScanSetupPush {
    Uints item_count;        // item_count.at[0] items, clamped to max_length
    DispatchArgsArray args;  // one an entry of ScanLevels
    Uints counts;            // the items of each level
    uint max_length, workgroup_size, group_size;
};

// "scan/reduce": sums.at[t] = sum of tile t. "scan/scan": scans each tile, starting at what sums.at[t] holds.
struct ScanTilePush {
    Uints values;
    Uints sums;
    Uints count;             // count.at[0] items
    uint has_sums;           // scan only: 0 at the top level, whose tiles start at 0
};
MYRIAD_END

#endif
