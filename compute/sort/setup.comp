#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation: the grid of a pass and the length of its scan, from a length that only the device knows.
#include "compute/sort/sort_io.h"
layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Push { SortSetupPush push; };

void main() {
    const uint items = min(push.item_count.at[0], push.max_length);
    const uint columns = sort_columns(sort_tiles(items, push.tile));
    push.args.at[0] = sort_grid(columns, push.group_size, push.workgroup_size);
    for (uint bits = 0u; bits <= sort_max_digit_bits; ++bits) push.counts.at[bits] = columns << bits;
    push.counts.at[sort_count_items] = items;
}
