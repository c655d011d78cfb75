// What kernels that append, and their host, share. See README.md.
#ifndef MYRIAD_COMPUTE_APPEND_IO_H
#define MYRIAD_COMPUTE_APPEND_IO_H

#include "engine/shared.h"

MYRIAD_BEGIN
// Counts keep counting past the capacity; what does not fit is not written, the bit is set, and later steps do nothing.
const uint append_next_overflow = 1u;
const uint append_kept_overflow = 2u;
const uint append_caller_overflow = 4u;  // set by a caller: what is made of the kept list does not fit (passes/fuse)

struct AppendState {
    uint items;         // length of the active list, the list that this step reads
    uint next;          // items appended to the next list by this step
    uint kept;          // items appended to the kept list by all steps
    uint failed;        // append_*_overflow
    uint next_needed;   // the largest `next` of any step: what a list must hold
    uint kept_needed;
    uint sums;          // entries of AppendRef.sums that this step fills (scan mode)
    uint processed[2];  // items read by all steps, each times its step's weight; low and high word
    uint opened[2];     // items that were appended to next lists by all steps
};
MYRIAD_ARRAY(AppendStates, AppendState, 4)

// Handed to kernels in push constants: 56 bytes.
struct AppendRef {
    Uint2s items, next, kept;
    AppendStates state;
    Uints payload;      // scan mode: what the counting pass found out, one word an item
    Uints sums;         // scan mode: by block, counts of `next`, then counts of `kept`; later their prefix sums
    uint next_capacity, kept_capacity;
};

// "append/begin": sets the counters for a first step over min(source.at[0] - first, limit) items.
// "append/finish": closes a step and prepares the next.
struct AppendFinishPush {
    AppendStates state;
    DispatchArgsArray args;   // of the next step's kernel
    Uints sums;
    Uints source;
    uint next_capacity, kept_capacity;
    uint group_size, workgroup_size;
    uint scan;                // 1 in scan mode
    uint first, limit;
    uint weight;              // of the items of the step that follows
};
MYRIAD_END

#endif
