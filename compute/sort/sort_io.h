// What the sort's kernels and their host share. See README.md.
#ifndef MYRIAD_COMPUTE_SORT_IO_H
#define MYRIAD_COMPUTE_SORT_IO_H

#include "engine/shared.h"

MYRIAD_BEGIN
const uint sort_max_digit_bits = 11u;

MYRIAD_FN uint sort_tiles(uint count, uint tile) { return (count + tile - 1u) / tile; }
// Counters lie digit by digit, so that one scan of them all gives the places; this many apart. Tiles and some columns of zeros: an odd number of
// cache lines of 64 bytes, for at a distance of a power of two all digits of a tile would fall into the same few places of a cache.
MYRIAD_FN uint sort_columns(uint tiles) { return ((tiles + 15u) / 16u | 1u) * 16u; }

// The grid that gives each column a group (engine/group.glsl).
MYRIAD_FN DispatchArgs sort_grid(uint columns, uint group_size, uint workgroup_size) { return grid_of((columns * group_size + workgroup_size - 1u) / workgroup_size); }

// "sort/setup": from a length on the device, what the kernels below run over.
struct SortSetupPush {
    Uints item_count;        // item_count.at[0] items, clamped to max_length
    DispatchArgsArray args;  // one group a column
    Uints counts;            // see sort_count_*
    uint max_length, tile, workgroup_size, group_size;
};
const uint sort_count_items = sort_max_digit_bits + 1u;  // counts.at[b], b <= 11: counters of a pass over b bits; at [12]: items
const uint sort_counts = sort_max_digit_bits + 2u;

// "sort/count": how many items of each tile have each digit; counters.at[digit * sort_columns + tile].
// "sort/scatter": moves each item to where the counters' prefix sums say, in the order of the items.
struct SortPassPush {
    Uints keys_in, payload_in, keys_out, payload_out;
    Uints counters;
    Uints count;             // count.at[0] items
    uint word, shift, bits;  // the digit: bits [shift, shift + bits) of a word of the key; 0 is the low one
};
MYRIAD_END

#endif
