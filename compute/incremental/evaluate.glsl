// One block in one view, with its slack: what "update" and "open" share.
#include "compute/append/append.glsl"
#include "compute/incremental/incremental_io.h"
layout(push_constant, scalar) uniform Push { CarryPush push; };

struct Evaluation {
    uint found;    // drawn | culled << 8 | open << 16, as classify_child
    bool open;     // whether the block's owner is open; false: the block must go
    Slack slack;
};

// How many node-views an item holds.
int members(uint block, uint masks) { return block == push.blocks && masks == cut_no_view ? 0 : bitCount(masks); }

void count_members(int change) {
    const uint sum = group_sum(uint(change));  // wraps, as the counter does
    if (group_elect() && sum != 0u) atomicAdd(push.memory.at[0].state.at[0].cut, sum);
}

// Where a node goes, and what slack it leaves the block.
uint look(inout Evaluation e, vec3 towards, View view, Sphere s, uint height) {
    const uint where = classify(view, s, height, push.epsilon, push.map_size);
    e.slack = slack_with(e.slack, towards, view, s.center - view.position, s.radius, height, where, float(push.map_size) / push.epsilon);
    return where;
}

BshShape shape() { return BshShape(push.leaves, push.blocks); }

// What the nodes of a block and its owner have come, and whether they did since the last frame.
struct Shift {
    float way;
    bool own, any;
};
Shift shift_of(uint block) {
    Shift shift = Shift(0.0f, false, false);
    if ((push.flags & carry_ways) == 0u) return shift;
    Ways ways = push.memory.at[0].ways;
    const uint now = push.memory.at[0].bounds_now;
    const float q = float(push.map_size) / push.epsilon;
    const Way own = ways.at[block];
    shift.way = way_length(own, q);
    shift.own = now != 0u && own.version == now;
    shift.any = shift.own;
    if (block == push.blocks) return shift;
    const Way above = ways.at[bsh_owner_of(block, shape()) >> bsh_arity_log2];
    shift.way += way_length(above, q);
    shift.any = shift.any || (now != 0u && above.version == now);
    return shift;
}

Evaluation evaluate(uint block, View view) {
    Evaluation e = Evaluation(0u, true, slack_begin(vec3(0.0f)));
    const uint height = bsh_height(bsh_arity * block, shape());
    vec3 towards = unpack_towards(e.slack.towards);
    if (block != push.blocks) {  // the owner, which sits in the block above
        const uint owner = bsh_owner_of(block, shape());
        const Sphere s = bsh_decode(push.frames.at[owner >> bsh_arity_log2], push.spheres.at[owner]);
        e.slack = slack_begin(s.center - view.position);
        towards = unpack_towards(e.slack.towards);
        e.open = look(e, towards, view, s, height + 1u) == node_view_open;
    }
    if (!e.open) return e;
    const vec4 frame = push.frames.at[block];
    const uvec2 first = push.spheres.at[bsh_arity * block];
    [[unroll]] for (uint i = 0u; i < bsh_arity; ++i) {
        const uvec2 code = push.spheres.at[bsh_arity * block + i];
        const bool absent = bsh_is_absent(code);  // no slack has less for the first child looked at twice
        const uint bit = node_view_bit(look(e, towards, view, bsh_decode(frame, absent ? first : code), height));
        e.found |= (absent ? 0u : bit) << i;
    }
    return e;
}
