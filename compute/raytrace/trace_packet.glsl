// Eight rays, a whole subgroup, share one traversal, which goes wherever any of them goes. A lane is a ray for triangles,
// and a child for nodes: it loads and decodes its child's box, and tests all eight rays against it. So the packet reads
// three words a lane for a node and two for a triangle, where a ray on its own reads 22 and 9, and eight unrelated rays
// still cost less than eight walks. Rays meet in registers (broadcasts and shuffles): no shared memory, no barrier.

#define TRACE_RAYS(DO) DO(0) DO(1) DO(2) DO(3) DO(4) DO(5) DO(6) DO(7)

uint trace_or(uint v) {
    v |= subgroupShuffleXor(v, 1u);
    v |= subgroupShuffleXor(v, 2u);
    return v | subgroupShuffleXor(v, 4u);
}

// The stack: entry e is in lane e % 8 of register e / 8, since an array with a computed index is memory on lavapipe. The last
// register is for trees with instances.
struct TraceLanes {
    uint r0, r1, r2, r3;
};
uint trace_get(TraceLanes lanes, uint e) {
    const uint r = e >> 3;
    return subgroupShuffle(r == 0u ? lanes.r0 : r == 1u ? lanes.r1 : !instanced || r == 2u ? lanes.r2 : lanes.r3, e & 7u);
}
void trace_set(inout TraceLanes lanes, uint e, uint value) {
    const bool mine = gl_SubgroupInvocationID == (e & 7u);
    const uint r = e >> 3;
    lanes.r0 = mine && r == 0u ? value : lanes.r0;
    lanes.r1 = mine && r == 1u ? value : lanes.r1;
    lanes.r2 = mine && r == 2u ? value : lanes.r2;
    if (instanced) lanes.r3 = mine && r == 3u ? value : lanes.r3;
}

// Lane k of a pair of words holds words 2 k and 2 k + 1.
vec3 trace_floats(uvec2 pair, const uint first) {
    const uint a = (first & 1u) == 0u ? subgroupBroadcast(pair.x, first / 2u) : subgroupBroadcast(pair.y, first / 2u);
    const uint b = (first & 1u) != 0u ? subgroupBroadcast(pair.x, (first + 1u) / 2u) : subgroupBroadcast(pair.y, first / 2u);
    const uint c = (first & 1u) == 0u ? subgroupBroadcast(pair.x, first / 2u + 1u) : subgroupBroadcast(pair.y, first / 2u + 1u);
    return uintBitsToFloat(uvec3(a, b, c));
}

Instance trace_instance(BvhRef bvh, uint index) {
    Uint2s pairs = Uint2s(bvh.instances);
    const uvec2 pair = pairs.at[index * 8u + gl_SubgroupInvocationID];
    Instance i;
    i.x = trace_floats(pair, 0u), i.y = trace_floats(pair, 3u), i.z = trace_floats(pair, 6u), i.at = trace_floats(pair, 9u);
    i.first_id = subgroupBroadcast(pair.x, 6u), i.first_triangle = subgroupBroadcast(pair.y, 6u);
    i.count = subgroupBroadcast(pair.x, 7u), i.flags = subgroupBroadcast(pair.y, 7u);
    return i;
}

void trace_packet(BvhRef bvh, inout TraceState state, const bool any) {
    const uint lane = gl_SubgroupInvocationID;
    TraceLanes base = TraceLanes(0u, 0u, 0u, 0u), orders = base, entries = base;
    uint top = 0u, node = 0u;
    Uints node_words = Uints(bvh.nodes), triangle_words = Uints(bvh.triangles);
    Uint2s node_pairs = Uint2s(bvh.nodes);
    TraceSpace space = trace_in_world(state.ray);
    while (trace_step(bvh)) {
        const uint header = node_words.at[node * 22u + min(lane, 5u)];
        const uvec2 child = node_pairs.at[node * 11u + 3u + lane];
        const uint frame = subgroupBroadcast(header, 3u), first_child = subgroupBroadcast(header, 4u), first_triangle = subgroupBroadcast(header, 5u);
        const vec3 origin = uintBitsToFloat(uvec3(subgroupBroadcast(header, 0u), subgroupBroadcast(header, 1u), subgroupBroadcast(header, 2u)));
        if (instanced && bvh_children(frame) == bvh_is_instance) {
            space.instance = trace_instance(bvh, first_triangle);
            trace_enter(space, state.ray, trace_floats(child, 0u), trace_floats(child, 3u), trace_floats(child, 6u), trace_floats(child, 9u), origin, top);
            space.pad = subgroupMax(space.pad);  // a lane enlarges its child's box for all rays
            node = first_child;
            continue;
        }
        const vec3 scale = bvh_scale(frame);
        vec3 lo = bvh_corner(origin, scale, child.x), hi = bvh_corner(origin, scale, child.y);
        if (instanced) lo -= space.pad, hi += space.pad;
        const float miss = 3.4e38;
        float nearest = miss;
#define TRACE_BOX(j) { \
            const float entry = box_entry(lo, hi, subgroupBroadcast(space.origin, j), subgroupBroadcast(space.inverse, j), \
                                          subgroupBroadcast(state.ray.t_min, j), subgroupBroadcast(state.ray.t_max, j)); \
            nearest = entry >= 0.0 && entry < nearest ? entry : nearest; }
        TRACE_RAYS(TRACE_BOX)
#undef TRACE_BOX
        const bool hit = nearest < miss && lane < bvh_children(frame);

        uint triangles = trace_or(hit ? trace_leaf(child) : 0u);
        while (triangles != 0u && trace_step(bvh)) {
            const uint slot = first_triangle + uint(findLSB(triangles));
            triangles &= triangles - 1u;
            const uint word = triangle_words.at[slot * 10u + lane], last = triangle_words.at[slot * 10u + 8u];
            const vec3 p0 = uintBitsToFloat(uvec3(subgroupBroadcast(word, 0u), subgroupBroadcast(word, 1u), subgroupBroadcast(word, 2u)));
            const vec3 p1 = uintBitsToFloat(uvec3(subgroupBroadcast(word, 3u), subgroupBroadcast(word, 4u), subgroupBroadcast(word, 5u)));
            const vec3 p2 = uintBitsToFloat(uvec3(subgroupBroadcast(word, 6u), subgroupBroadcast(word, 7u), last));
            trace_triangle(bvh, state, space, slot, Corners(p0, p1, p2), any);
        }
        if (any && subgroupAll(state.ray.t_max < state.ray.t_min)) return;

        const bool inner = hit && child.x >> 24 == 0u;
        const uint key = inner ? trace_key(nearest, lane) : no_key;
        uint rank = 0u, first = no_key, second = no_key;
#define TRACE_RANK(j) { \
            const uint other = subgroupBroadcast(key, j); \
            rank += other < key ? 1u : 0u; \
            second = max(first, min(second, other)); \
            first = min(first, other); }
        TRACE_RAYS(TRACE_RANK)
#undef TRACE_RANK
        if (first != no_key && subgroupAny(trace_key_entry(first) <= state.ray.t_max * box_slack)) {
            node = first_child + (first & 7u);
            if (second != no_key) {
                trace_set(base, top, first_child);
                trace_set(orders, top, trace_or(inner ? (lane + 1u) << (4u * rank) : 0u) >> 4);  // without the first
                trace_set(entries, top, second);
                ++top;
            }
            continue;
        }
        bool found = false;
        while (top != 0u && !found && trace_step(bvh)) {
            if (instanced && top == space.floor_) trace_leave(space, state.ray);
            --top;
            if (!subgroupAny(trace_key_entry(trace_get(entries, top)) <= state.ray.t_max * box_slack)) continue;
            uint order = trace_get(orders, top);
            node = trace_get(base, top) + (order & 15u) - 1u;
            order >>= 4;
            if (order != 0u) trace_set(orders, top++, order);
            found = true;
        }
        if (!found) break;
    }
}
#undef TRACE_RAYS
