#version 460
#extension GL_GOOGLE_include_directive : require
// Picks by importance: all of a tile's numbers stand at the root, and each node hands its own on to its children, in proportion to what they may bring to
// the tile's receivers, by one throw of dice a node. So each VPL has count * p of them in the mean, p the product of shares on its way, a node that may
// bring much has many, evenly spread, and none in a row of numbers is further from its share than one a level (hierarchical sample warping, Clarberg et
// al. 2005; light trees: Estevez and Kulla 2018; one cut for a block of pixels: Yuksel 2019). Every invocation follows the nodes that hold its own
// pick_a_walk numbers: what it has put off holds at least one of them each, so the stack is that high. Nodes near the root have weights from below (pick/weigh).
#include "engine/kernel.glsl"
#include "passes/pick/pick_io.h"
layout(push_constant, scalar) uniform Push { PickTreePush push; };

struct Work {
    uint node, first, count;   // numbers [first, first + count)
    float probability;         // of a number to come here
};

void main() {
    const uint tile_index = thread_index() / push.parts;
    if (tile_index >= push.tile_count) return;
    const PickTile tile = push.tiles.at[tile_index];
    if (tile.radius < 0.0f) return;
    const uint sets = pick_sets(push.shape.block), total = sets * push.shape.picks;
    const uint begin = (thread_index() % push.parts) * pick_a_walk, end = min(begin + pick_a_walk, total);

    Work stack[pick_a_walk];
    uint height = 0u;
    if (begin < end) stack[height++] = Work(push.capacity, 0u, total, 1.0f);
    const bool any = push.count.at[0] > 0u;
    while (height > 0u) {
        Work work = stack[--height];
        const LightNode node = push.nodes.at[any ? work.node : 0u];
        const uint children = any ? light_child_count(node) : 0u, first_child = light_first_child(node);
        float importance[view_tree_most];
        float sum = 0.0f;
        for (uint i = 0u; i < children; ++i) {
            const uint child = first_child + i;
            if (child >= push.capacity && child - push.capacity < push.limit) importance[i] = push.weights.at[tile_index * push.limit + child - push.capacity];
            else importance[i] = pick_importance(tile, push.nodes.at[child], push.bound);
            sum += importance[i];
        }
        if (sum > 0.0f) {
            const float dice = pick_dice(work.node, tile_index, push.shape.seed);
            float share = 0.0f;
            uint given = 0u;
            for (uint i = 0u; i < children; ++i) {
                share += importance[i];
                const uint next = i + 1u == children ? work.count : pick_split(work.count, share / sum, dice);
                if (next > given && work.first + next > begin && work.first + given < end)
                    stack[height++] = Work(first_child + i, work.first + given, next - given, work.probability * (importance[i] / sum));
                given = next;
            }
            continue;
        }
        // A light; or nothing below may bring anything: then the place keeps the order, and counts nothing.
        float weight = children == 0u && any ? 1.0f / (float(push.shape.picks) * work.probability) : 0.0f;
        while (any && work.node >= push.capacity) work.node = light_first_child(push.nodes.at[work.node]);
        for (uint number = max(begin, work.first); number < min(end, work.first + work.count); ++number)
            push.picks.at[pick_slot(number, sets, push.shape.picks, tile_index, push.shape.seed)] = Pick(any ? work.node : 0u, weight);
    }
}
