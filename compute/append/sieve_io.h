// The kernel that tests the append lists: a made-up process in which items multiply, shrink, are kept, or vanish.
#ifndef MYRIAD_COMPUTE_SIEVE_IO_H
#define MYRIAD_COMPUTE_SIEVE_IO_H

#include "compute/append/append_io.h"

MYRIAD_BEGIN
struct SievePush {
    AppendRef lists;
    uint first_step;   // 1: an item is its index
};

// Item (value, step): puts value % 4 items on the next list, each a third of the value and one step on, and keeps odd values.
MYRIAD_FN uint sieve_copies(uvec2 item) { return item.x % 4u; }
MYRIAD_FN bool sieve_keeps(uvec2 item) { return item.x % 2u == 1u; }
MYRIAD_FN uvec2 sieve_child(uvec2 item, uint copy) { return uvec2(item.x / 3u + copy, item.y + 1u); }
MYRIAD_END

#endif
