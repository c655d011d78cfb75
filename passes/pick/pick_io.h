// Which VPLs tiles of pixels pick, and their gather: what the kernels, their host and their twin share; see README.md.
#ifndef MYRIAD_PASSES_PICK_IO_H
#define MYRIAD_PASSES_PICK_IO_H

#include "compute/common/hash.h"
#include "passes/gather/gather_io.h"
#include "passes/light_tree/light_tree_io.h"

MYRIAD_BEGIN
// The receivers of a tile: they lie in the sphere, and their shading normals in the cone.
struct PickTile {
    vec3 center;
    float radius;           // negative: there are none
    vec3 axis;
    float cos_spread;       // -1: all directions
};
MYRIAD_ARRAY(PickTiles, PickTile, 16)

// Bounds of receivers: begun from their box and the sum of their normals, then with each of them, then rounded outward.
MYRIAD_FN PickTile pick_tile_begin(vec3 low, vec3 high, vec3 normals) {
    PickTile tile;
    tile.center = 0.5f * low + 0.5f * high;
    tile.radius = -1.0f;
    const float length2 = dot(normals, normals);
    tile.axis = length2 > 1e-6f ? normals / sqrt(length2) : vec3(1.0f, 0.0f, 0.0f);
    tile.cos_spread = length2 > 1e-6f ? 1.0f : -1.0f;
    return tile;
}
MYRIAD_FN PickTile pick_tile_add(PickTile tile, vec3 position, vec3 normal) {
    const vec3 d = position - tile.center;
    tile.radius = max(tile.radius, sqrt(dot(d, d)));
    tile.cos_spread = min(tile.cos_spread, dot(tile.axis, normal));
    return tile;
}
MYRIAD_FN PickTile pick_tile_end(PickTile tile) {
    if (tile.radius < 0.0f) return tile;
    // Of the distance from a far origin, too, whose rounding is the positions'.
    tile.radius = tile.radius * (1.0f + 1e-6f) + 1e-6f * max(max(abs(tile.center.x), abs(tile.center.y)), abs(tile.center.z));
    tile.cos_spread = max(tile.cos_spread - 1e-6f, -1.0f);
    return tile;
}

// A VPL that pixels gather, and what its light counts there: 0: nothing was there to pick. A tile has pick_sets(block) lists of `picks` each, in ascending
// order of VPLs.
struct Pick {
    uint vpl;
    float weight;
};
MYRIAD_ARRAY(Picks, Pick, 8)

// What cones and spheres leave of angles' cosines, floats included; cosines near 1 leave 3e-4 of sines.
const float pick_slack = 1e-3f;

// The cosine of what is left of an angle (its cosine) when it shrinks by another, and at most to 0.
MYRIAD_FN float pick_less(float cosine, float cos_by, float sin_by) {
    if (cosine >= cos_by) return 1.0f;
    return cosine * cos_by + sqrt(max(1.0f - cosine * cosine, 0.0f)) * sin_by;
}

// How a tile and a node of lights see each other: no cosine is larger for any receiver of the tile and any light below the node.
struct PickBounds {
    float distance;         // of the centres
    float nearest;          // that a receiver and a light may be
    float cos_receiver, cos_light;  // 0: all face away
};
MYRIAD_FN PickBounds pick_bounds(PickTile tile, LightNode node) {
    const vec3 d = node.position - tile.center;
    const float around = tile.radius + node.radius;
    PickBounds b;
    b.distance = sqrt(dot(d, d));
    b.nearest = max(b.distance - around * (1.0f + 1e-5f), 0.0f);
    b.cos_receiver = 1.0f;
    b.cos_light = 1.0f;
    if (!(b.nearest > 0.0f)) return b;
    const vec3 way = d / b.distance;
    // By how much the way between two points of the spheres may turn from that between the centres.
    const float sin_turn = min(around / b.distance, 1.0f);
    const float cos_turn = sqrt(max(1.0f - sin_turn * sin_turn, 0.0f));
    const float receiver = pick_less(dot(tile.axis, way), tile.cos_spread, sqrt(max(1.0f - tile.cos_spread * tile.cos_spread, 0.0f)));
    const float light = pick_less(-dot(unpack_direction(node.axis), way), node.cos_spread, sqrt(max(1.0f - node.cos_spread * node.cos_spread, 0.0f)));
    b.cos_receiver = max(pick_less(receiver, cos_turn, sin_turn) + pick_slack, 0.0f);
    b.cos_light = max(pick_less(light, cos_turn, sin_turn) + pick_slack, 0.0f);
    return b;
}
// Nothing below the node lights any receiver of the tile, or none within `reach` (metres).
MYRIAD_FN bool pick_culled(PickTile tile, LightNode node, float reach) {
    if (tile.radius < 0.0f || !(node.flux > 0.0f)) return true;
    const PickBounds b = pick_bounds(tile, node);
    return b.cos_receiver == 0.0f || b.cos_light == 0.0f || b.nearest > reach;
}
// About how much a tile's receivers get from a node: 0 only where it is nothing. `bound` as for gathers.
MYRIAD_FN float pick_importance(PickTile tile, LightNode node, float bound) {
    if (tile.radius < 0.0f || !(node.flux > 0.0f)) return 0.0f;
    const PickBounds b = pick_bounds(tile, node);
    const float cosines = b.cos_receiver * b.cos_light;
    if (!(cosines > 0.0f)) return 0.0f;
    // That of the centres, measured: by the nearest, nodes that reach around the tile would have most picks, ten times the error.
    const float typical = max(b.distance, 0.5f * (tile.radius + node.radius));
    const float g = min(cosines / max(typical * typical, 1e-30f), bound);
    return clamp(node.flux * min(g, 1e7f), 1e-37f, 1e30f);
}

// Pixels of a tile are in as many sets as there are in a block, as in passes/gather.
MYRIAD_FN uint pick_sets(uint block) { return block * block; }
// A tile makes `picks` for each set: numbers in the order of VPLs. Of each `sets` in a row every set gets one, and which it is depends on the dice,
// so that a set's picks stand for all VPLs.
MYRIAD_FN uint pick_set_of(uint number, uint sets, uint tile, uint seed) {
    const uint turn = hash_pair(number / sets, hash_pair(tile, seed)) % sets;  // sets are a power of two
    const uint set = number % sets + turn;
    return set < sets ? set : set - sets;
}
MYRIAD_FN uint pick_slot(uint number, uint sets, uint picks, uint tile, uint seed) {
    return (tile * sets + pick_set_of(number, sets, tile, seed)) * picks + number / sets;
}
// Of a node's `count` picks, how many the children before one get whose importances are `share` of all: its mean over the dice is count * share.
MYRIAD_FN uint pick_split(uint count, float share, float dice) { return min(uint(float(count) * share + dice), count); }
MYRIAD_FN float pick_dice(uint node, uint tile, uint seed) { return to_unit(hash_pair(node, hash_pair(tile, seed ^ 0x51ed270bu))); }

// Of `remain` VPLs in a row, the one that the pick of this number is, of `total` picks: evenly, a pick in each total-th part.
MYRIAD_FN uint pick_even(uint number, uint total, uint remain, uint tile, uint seed) {
    const uint whole = remain / total, rest = remain % total, part = number * rest;  // total and rest have 16 bits
    const float in_part = float(part % total) / float(total) + to_unit(hash_pair(number, hash_pair(tile, seed ^ 0x2545f491u))) * (float(remain) / float(total));
    return min(number * whole + part / total + uint(in_part), remain - 1u);
}
const uint pick_most = 4096u;         // a pixel
const uint pick_a_walk = 64u;         // picks that an invocation looks for
// VPLs that an invocation culls, at least and at most, and in how many parts they are for each tile, about.
const uint pick_part_least = 64u, pick_part_most = 4096u, pick_parts = 64u;
MYRIAD_FN uint pick_part(uint vpls) { return clamp((vpls + pick_parts - 1u) / pick_parts, pick_part_least, pick_part_most); }

// Of a tree's inner nodes, level by level from the root, the first ones have their importance from below: the sum of their children's, in place of an estimate
// for all that is below in one, which knows little of lights that face all ways. So many of each tile, as many as it makes picks, about.
const uint pick_weights_least = 64u, pick_weights_most = 1024u;
MYRIAD_FN uint pick_weights(uint sets, uint picks) { return clamp(sets * picks, pick_weights_least, pick_weights_most); }
// Whether all children of a node have theirs: then its own is the sum of these.
MYRIAD_FN bool pick_summed(LightNode node, uint capacity, uint weights) {
    return light_first_child(node) >= capacity && light_first_child(node) + light_child_count(node) - capacity <= weights;
}

struct PickShape {
    uint side;              // pixels of a tile, a multiple of `block`
    uint block;             // k: sets of pixels are k x k
    uint picks;             // K: a pixel's
    uint seed;
};
MYRIAD_FN uint pick_columns(uint width, uint side) { return (width + side - 1u) / side; }

// "pick/tiles": one invocation a tile.
struct PickTilesPush {
    GBufferRef gbuffer;
    PickTiles tiles;
    uint side;
};

// "pick/weigh": a workgroup a node, for as many tiles, `limit` of them before the next tiles. "pick/sum": an invocation a tile.
struct PickWeighPush {
    PickTiles tiles;
    LightNodes nodes;
    ViewLevels levels;
    Floats weights;         // by tile and inner node, the first `limit` of them
    uint tile_count, capacity, limit;
    float bound;
};

// "pick/tree": `parts` invocations a tile, each for pick_a_walk numbers.
struct PickTreePush {
    PickTiles tiles;
    LightNodes nodes;
    Uints count;            // of VPLs
    Picks picks;
    Floats weights;         // as PickWeighPush
    PickShape shape;
    uint tile_count, parts, capacity, limit;
    float bound;
};

// "pick/remain", then "pick/culled": `parts` invocations a tile, each for `part` VPLs.
struct PickCulledPush {
    PickTiles tiles;
    LightNodes nodes;
    ViewGroups groups;
    Uints count;            // of VPLs
    Uints remain;           // by tile and part: VPLs that are not culled
    Picks picks;
    PickShape shape;
    uint tile_count, parts, part, capacity;
    float reach;            // metres
};

// "pick/maps": a workgroup a set of a tile.
struct PickMapsPush {
    GBufferRef gbuffer;
    Vpls vpls;
    Picks picks;
    Uints atlas;            // of VPLs [first, ...)
    Uints failed;           // as GatherPush
    Float4s irradiance;
    uint first, end;        // VPLs [first, end)
    uint side_block;        // PickShape's: side << 8 | block
    uint count;             // picks
    uint map_size;
    uint has_failed;
    float bound, bias;
    float reach2;           // m^2
};
// "pick/rays": likewise, picks [first, end) of each pixel.
struct PickRaysPush {
    GBufferRef gbuffer;
    Vpls vpls;
    Picks picks;
    Float4s irradiance;
    BvhRef bvh;
    Uints status;
    uint side_block_count;  // side << 24 | block << 16 | picks
    uint first_end;         // first << 16 | end
    float bound, reach2;
};

// The pixel of a lane, of a workgroup of (side / block)^2.
MYRIAD_FN GatherPixel pick_pixel(uint workgroup, uint lane, uint side, uint block, uint width, uint height) {
    const uint sets = pick_sets(block);
    const uint tile = workgroup / sets, across = side / block, columns = pick_columns(width, side);
    GatherPixel p;
    p.set = workgroup % sets;
    p.x = (tile % columns) * side + (lane % across) * block + p.set % block;
    p.y = (tile / columns) * side + (lane / across) * block + p.set / block;
    p.inside = p.x < width && p.y < height && lane < across * across;
    return p;
}
MYRIAD_END

#ifdef __cplusplus
static_assert(sizeof(myriad::PickTile) == 32 && sizeof(myriad::PickMapsPush) <= 128 && sizeof(myriad::PickRaysPush) <= 128);
#endif

#endif
