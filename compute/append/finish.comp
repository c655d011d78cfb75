#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation: closes a step. Takes the totals, notes what was needed, and makes the next list the active one: empty if
// anything overflowed, so that the steps still recorded cost nothing and write nothing.
#include "compute/append/append_io.h"
layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Push { AppendFinishPush push; };

void main() {
    AppendState s = push.state.at[0];
    if (push.scan != 0u) {
        const uint blocks = s.sums / 2u;
        s.next = push.sums.at[blocks];
        s.kept += push.sums.at[2u * blocks] - push.sums.at[blocks];
    }
    s.next_needed = max(s.next_needed, s.next);
    s.kept_needed = max(s.kept_needed, s.kept);
    if (s.next > push.next_capacity) s.failed |= append_next_overflow;
    if (s.kept > push.kept_capacity) s.failed |= append_kept_overflow;
    s.items = (s.failed & append_next_overflow) != 0u ? 0u : s.next;
    s.next = 0u;
    const uint before = s.processed[0];
    s.processed[0] += s.items * push.weight;  // an active list is at most 2^28 long
    if (s.processed[0] < before) s.processed[1] += 1u;
    s.opened[0] += s.items;
    if (s.opened[0] < s.items) s.opened[1] += 1u;
    s.sums = 2u * ((s.items + push.group_size - 1u) / push.group_size);
    push.state.at[0] = s;
    push.args.at[0] = grid_of((s.items + push.workgroup_size - 1u) / push.workgroup_size);
}
