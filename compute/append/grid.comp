#version 460
#extension GL_GOOGLE_include_directive : require
#include "compute/append/grid_io.h"
layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Push { GridPush push; };

void main() {
    const uint items = min(push.count.at[0], push.limit);
    const uint items_per_workgroup = push.workgroup_size / push.threads_per_item;
    push.args.at[0] = grid_of((items + items_per_workgroup - 1u) / items_per_workgroup);
}
