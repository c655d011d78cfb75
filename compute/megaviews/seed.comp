#version 460
#extension GL_GOOGLE_include_directive : require
// The first pair: both roots. The scene's sits alone in the block over it (bsh_io.h).
#include "compute/megaviews/pairs.glsl"

void main() {
    const uint item = append_item();
    const uint over_root = tree_over_root(shape());
    const uint slot = bsh_arity * over_root;
    const uint node = push.capacity;
    uint found = 0u;
    uint views = 0u;
    if (append_decides(item, push.lists)) {
        PairRefs memory = push.memory.at[0];
        const ViewBound bound = view_bound(node);
        views = bound.views;
        if (views != 0u) {
            const TreeBlock own = tree_block(push.frames, over_root, shape());
            const Sphere root = bsh_decode(own.frame, push.spheres.at[own.first]);
            found = pair_bit(classify_pair(memory.nodes.at[node], bound.radius, root, false, own.height, push.epsilon, push.map_size));
        }
    }
    if (append_pass != append_pass_write)
        count_up(push.step, bitCount(found), (found >> 8) & 1u, 0u, found & 1u, (found & 1u) * views);
    found = append_payload(item, found, push.lists);
    const bool drawn = (found & 1u) != 0u;
    const bool open = (found >> 16) != 0u;
    const uvec2 at = append_reserve(item, uvec2(open ? 1u : 0u, drawn ? 1u : 0u), push.lists);
    if (!append_writes) return;
    if (drawn) append_kept(at.y, cut_pack(over_root, node, 1u), push.lists);
    if (open) append_next(at.x, uvec2(slot, node), push.lists);
}
