// One ray an invocation. A node costs 22 words and a triangle 9; the stack has an entry a level, for the children of a
// node that are still to come.

void trace_single(BvhRef bvh, inout TraceState state, const bool any) {
    uint stack_base[bvh_max_stack], stack_order[bvh_max_stack];
    float stack_entry[bvh_max_stack];  // of the nearest child that waited first: a lower bound for the others
    uint top = 0u, node = 0u;
    Uint2s words = Uint2s(bvh.nodes);
    Floats points = Floats(bvh.triangles);
    TraceSpace space = trace_in_world(state.ray);
    while (trace_step(bvh)) {
        const uint at = node * 11u;
        const uvec2 w0 = words.at[at], w1 = words.at[at + 1u], w2 = words.at[at + 2u];
        if (instanced && bvh_children(w1.y) == bvh_is_instance) {
            uvec2 w[6];
            [[unroll]] for (uint i = 0u; i < 6u; ++i) w[i] = words.at[at + 3u + i];
            space.instance = bvh.instances.at[w2.y];
            trace_enter(space, state.ray, uintBitsToFloat(uvec3(w[0], w[1].x)), uintBitsToFloat(uvec3(w[1].y, w[2])),
                        uintBitsToFloat(uvec3(w[3], w[4].x)), uintBitsToFloat(uvec3(w[4].y, w[5])), uintBitsToFloat(uvec3(w0, w1.x)), top);
            node = w2.x;
            continue;
        }
        const vec3 origin = uintBitsToFloat(uvec3(w0, w1.x)), scale = bvh_scale(w1.y);
        const uint children = bvh_children(w1.y), first_child = w2.x, first_triangle = w2.y;
        uint key[8], triangles = 0u;
        [[unroll]] for (uint i = 0u; i < 8u; ++i) {
            const uvec2 child = words.at[at + 3u + i];
            vec3 lo = bvh_corner(origin, scale, child.x), hi = bvh_corner(origin, scale, child.y);
            if (instanced) lo -= space.pad, hi += space.pad;
            const float entry = box_entry(lo, hi, space.origin, space.inverse, state.ray.t_min, state.ray.t_max);
            const bool hit = entry >= 0.0 && i < children;
            triangles |= hit ? trace_leaf(child) : 0u;
            key[i] = hit && child.x >> 24 == 0u ? trace_key(entry, i) : no_key;
        }
        while (triangles != 0u && trace_step(bvh)) {
            const uint slot = first_triangle + uint(findLSB(triangles)), p = slot * 10u;
            triangles &= triangles - 1u;
            trace_triangle(bvh, state, space, slot,
                           Corners(vec3(points.at[p], points.at[p + 1u], points.at[p + 2u]),
                                   vec3(points.at[p + 3u], points.at[p + 4u], points.at[p + 5u]),
                                   vec3(points.at[p + 6u], points.at[p + 7u], points.at[p + 8u])), any);
            if (any && state.slot != no_triangle) return;
        }
        // Batcher's network for eight.
#define TRACE_SORT(a, b) { const uint low = min(key[a], key[b]); key[b] = max(key[a], key[b]); key[a] = low; }
        TRACE_SORT(0, 1) TRACE_SORT(2, 3) TRACE_SORT(4, 5) TRACE_SORT(6, 7) TRACE_SORT(0, 2) TRACE_SORT(1, 3) TRACE_SORT(4, 6)
        TRACE_SORT(5, 7) TRACE_SORT(1, 2) TRACE_SORT(5, 6) TRACE_SORT(0, 4) TRACE_SORT(3, 7) TRACE_SORT(1, 5) TRACE_SORT(2, 6)
        TRACE_SORT(1, 4) TRACE_SORT(3, 6) TRACE_SORT(2, 4) TRACE_SORT(3, 5) TRACE_SORT(3, 4)
#undef TRACE_SORT
        uint order = 0u;
        [[unroll]] for (uint i = 8u; i-- > 1u;) order = key[i] == no_key ? order : order << 4 | (key[i] & 7u) + 1u;
        if (order != 0u) {
            stack_base[top] = first_child;
            stack_order[top] = order;
            stack_entry[top] = trace_key_entry(key[1]);
            ++top;
        }
        if (key[0] != no_key && trace_key_entry(key[0]) <= state.ray.t_max * box_slack) {
            node = first_child + (key[0] & 7u);
            continue;
        }
        bool found = false;
        while (top != 0u && !found && trace_step(bvh)) {
            if (instanced && top == space.floor_) trace_leave(space, state.ray);
            --top;
            if (stack_entry[top] > state.ray.t_max * box_slack) continue;
            order = stack_order[top];
            node = stack_base[top] + (order & 15u) - 1u;
            order >>= 4;
            if (order != 0u) stack_order[top++] = order;
            found = true;
        }
        if (!found) break;
    }
}
