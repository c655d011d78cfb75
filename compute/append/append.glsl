// Appending from a kernel: each item of the active list puts some items on the next list and some on the kept list.
//
//   const uint item = append_item();                        // this lane's item; every lane of the group goes on
//   uint found = 0u;
//   if (append_decides(item, ref)) found = …;               // the costly part, in one word
//   found = append_payload(item, found, ref);               // scan mode: stored by the counting pass, read by the writing one
//   const uvec2 at = append_reserve(item, uvec2(n, k), ref); // all lanes together; those without an item ask for nothing
//   if (append_writes) { append_next(at.x, …, ref); … }     // bounds are checked here
//
// One kernel source, three specialisations of `append_pass`:
//   atomic   decide and write at once; a group reserves by one atomic. The set is exact, the order is the scheduler's.
//   count    decide, keep the answer as payload, and leave each block's counts.
//   write    after a scan of the counts: positions in the order of the items, whatever the schedule.
// A block is a group's worth of items (engine/group.glsl), so there is no barrier in any of them.
#ifndef MYRIAD_COMPUTE_APPEND_GLSL
#define MYRIAD_COMPUTE_APPEND_GLSL

#include "engine/group.glsl"
#include "compute/append/append_io.h"

const uint append_pass_atomic = 0u;
const uint append_pass_count = 1u;
const uint append_pass_write = 2u;
layout(constant_id = 2) const uint append_pass = append_pass_atomic;

const bool append_writes = append_pass != append_pass_count;

uint append_item() { return group_index() * group_size() + group_lane(); }
bool append_has(uint item, AppendRef ref) { return item < ref.state.at[0].items; }
// Whether this pass has to work the answer out for this item.
bool append_decides(uint item, AppendRef ref) { return append_pass != append_pass_write && append_has(item, ref); }

uint append_payload(uint item, uint found, AppendRef ref) {
    if (append_pass == append_pass_atomic || !append_has(item, ref)) return found;
    if (append_pass == append_pass_write) return ref.payload.at[item];
    ref.payload.at[item] = found;
    return found;
}

// How many items this lane appends to (next, kept) -> where its first ones go.
uvec2 append_reserve(uint item, uvec2 counts, AppendRef ref) {
    const uint block = item / group_size();
    const uint blocks = (ref.state.at[0].items + group_size() - 1u) / group_size();
    if (append_pass == append_pass_count) {
        const uvec2 sums = uvec2(group_sum(counts.x), group_sum(counts.y));
        if (block < blocks && group_elect()) {
            ref.sums.at[block] = sums.x;
            ref.sums.at[blocks + block] = sums.y;
        }
        return uvec2(0u);
    }
    const uvec2 before = uvec2(group_exclusive_sum(counts.x), group_exclusive_sum(counts.y));
    uvec2 base = uvec2(0u);
    if (append_pass == append_pass_write) {
        if (block < blocks)  // the kept counts stand behind the next counts in one scan: take those out again
            base = uvec2(ref.sums.at[block], ref.state.at[0].kept + ref.sums.at[blocks + block] - ref.sums.at[blocks]);
    } else {
        const uvec2 sums = uvec2(group_sum(counts.x), group_sum(counts.y));
        if (group_elect()) {
            if (sums.x != 0u) base.x = atomicAdd(ref.state.at[0].next, sums.x);
            if (sums.y != 0u) base.y = atomicAdd(ref.state.at[0].kept, sums.y);
        }
        base = uvec2(group_first(base.x), group_first(base.y));
    }
    return base + before;
}

void append_next(uint at, uvec2 value, AppendRef ref) {
    if (at < ref.next_capacity) ref.next.at[at] = value;
}
void append_kept(uint at, uvec2 value, AppendRef ref) {
    if (at < ref.kept_capacity) ref.kept.at[at] = value;
}

#endif
