// A tile's VPLs that are not culled: walks the nodes over [first, end) of the curve and calls found(first, end) for each range that remains, in order. Nodes
// are culled down to those whose children are VPLs.
const uint culled_stack = 7u * view_tree_levels + 1u;

void found(uint first, uint end);

void each_remaining(PickTile tile, uint first, uint end) {
    uint stack[culled_stack];
    uint height = 0u;
    if (first < end) stack[height++] = push.capacity;
    while (height > 0u) {
        const uint number = stack[--height];
        const ViewGroup group = push.groups.at[number - push.capacity];
        if (group.end <= first || group.first >= end) continue;
        if (pick_culled(tile, push.nodes.at[number], push.reach)) continue;
        if (group.first_child < push.capacity) found(max(group.first, first), min(group.end, end));
        else
            for (uint i = group.children; i-- > 0u;) stack[height++] = group.first_child + i;
    }
}
