// What the sort's kernels and their host share. See README.md.
#ifndef MYRIAD_COMPUTE_SORT_IO_H
#define MYRIAD_COMPUTE_SORT_IO_H

#include "engine/shared.h"

MYRIAD_BEGIN
const uint sort_max_digit_bits = 11u;

MYRIAD_FN uint sort_tiles(uint count, uint tile) { return (count + tile - 1u) / tile; }

// Bits [shift, shift + bits) of a key of one or two words, low word first; bits <= 11.
MYRIAD_FN uint sort_digit(uint low, uint high, uint shift, uint bits) {
    uint value = 0u;
    if (shift >= 32u) value = high >> (shift - 32u);
    else value = shift == 0u ? low : low >> shift | high << (32u - shift);
    return value & ((1u << bits) - 1u);
}

// "sort/setup": from a length on the device, what the kernels below run over.
struct SortSetupPush {
    Uints item_count;        // item_count.at[0] items, clamped to max_length
    DispatchArgsArray args;  // one group a tile
    Uints counts;            // see sort_count_*
    uint max_length, tile, workgroup_size, group_size;
};
const uint sort_count_items = sort_max_digit_bits + 1u;  // counts.at[b], b <= 11: counters of a pass over b bits; at [12]: items
const uint sort_counts = sort_max_digit_bits + 2u;

// "sort/count": how many items of each tile have each digit; counters.at[digit * tiles + tile].
// "sort/scatter": moves each item to where the counters' prefix sums say, in the order of the items.
struct SortPassPush {
    Uints keys_in, payload_in, keys_out, payload_out;
    Uints counters;
    Uints count;             // count.at[0] items
    uint shift, bits;        // the digit
};
MYRIAD_END

#endif
