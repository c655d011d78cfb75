#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation: zeroes the counters and sizes the first step by a count that may only be known on the device.
#include "compute/append/append_io.h"
layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Push { AppendFinishPush push; };

void main() {
    AppendState s;
    const uint items = push.source.at[0];
    s.items = items > push.first ? min(items - push.first, push.limit) : 0u;
    s.next = 0u;
    s.kept = 0u;
    s.failed = 0u;
    s.next_needed = 0u;
    s.kept_needed = 0u;
    s.processed[0] = s.items * push.weight;
    s.processed[1] = 0u;
    s.opened[0] = 0u;
    s.opened[1] = 0u;
    s.sums = 2u * ((s.items + push.group_size - 1u) / push.group_size);
    push.state.at[0] = s;
    push.args.at[0] = grid_of((s.items + push.workgroup_size - 1u) / push.workgroup_size);
}
