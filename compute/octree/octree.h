// Cells of an octree: where they are, and their Morton keys. For C++ and GLSL.
#ifndef MYRIAD_COMPUTE_OCTREE_H
#define MYRIAD_COMPUTE_OCTREE_H

#include "engine/shared.h"

MYRIAD_BEGIN
const uint octree_max_depth = 21u;  // levels below the root: three times 21 bits are a key of 63

// The cube of the root, cut into 2^depth cells a side.
struct OctreeCube {
    vec3 origin;
    float cells_per_length;  // 2^depth over the side; 0 for a cube without extent, all of which is one cell
};

// The cell that holds a point: borders belong to the cell above them, the cube's upper faces to the last, and what rounding or the caller puts
// outside to the nearest. A point that is no number has no cell: callers keep those out.
MYRIAD_FN uvec3 octree_cell(vec3 point, OctreeCube cube, uint depth) {
    const float last = float((1u << depth) - 1u);  // 2^21 - 1 is a float
    const vec3 at = (point - cube.origin) * cube.cells_per_length;
    return uvec3(clamp(at, vec3(0.0f), vec3(last)));
}

// Every third bit, from the lowest, of the low 10 bits of a number.
MYRIAD_FN uint octree_spread(uint v) {
    v &= 0x3ffu;
    v = (v | v << 16) & 0x030000ffu;
    v = (v | v << 8) & 0x0300f00fu;
    v = (v | v << 4) & 0x030c30c3u;
    v = (v | v << 2) & 0x09249249u;
    return v;
}
MYRIAD_FN uint octree_gather(uint v) {
    v &= 0x09249249u;
    v = (v | v >> 2) & 0x030c30c3u;
    v = (v | v >> 4) & 0x0300f00fu;
    v = (v | v >> 8) & 0x030000ffu;
    v = (v | v >> 16) & 0x3ffu;
    return v;
}

// Morton keys: bit 3 b + a is bit b of coordinate a; x of the key is the low word. In three pieces of 30, 30 and 3 bits.
MYRIAD_FN uvec2 octree_key(uvec3 cell) {
    const uint low = octree_spread(cell.x) | octree_spread(cell.y) << 1 | octree_spread(cell.z) << 2;
    const uint middle = octree_spread(cell.x >> 10) | octree_spread(cell.y >> 10) << 1 | octree_spread(cell.z >> 10) << 2;
    const uint high = (cell.x >> 20 & 1u) | (cell.y >> 20 & 1u) << 1 | (cell.z >> 20 & 1u) << 2;
    return uvec2(low | middle << 30, middle >> 2 | high << 28);
}
MYRIAD_FN uvec3 octree_cell_of(uvec2 key) {
    const uint middle = key.x >> 30 | key.y << 2, high = key.y >> 28;
    uvec3 cell;
    cell.x = octree_gather(key.x) | octree_gather(middle) << 10 | (high & 1u) << 20;
    cell.y = octree_gather(key.x >> 1) | octree_gather(middle >> 1) << 10 | (high >> 1 & 1u) << 20;
    cell.z = octree_gather(key.x >> 2) | octree_gather(middle >> 2) << 10 | (high >> 2 & 1u) << 20;
    return cell;
}

// The key of the ancestor that is `levels` above.
MYRIAD_FN uvec2 octree_ancestor(uvec2 key, uint levels) {
    const uint shift = 3u * levels;
    if (shift == 0u) return key;
    if (shift >= 32u) return uvec2(key.y >> (shift - 32u), 0u);
    return uvec2(key.x >> shift | key.y << (32u - shift), key.y >> shift);
}

// The highest level (0: the root) at which two keys of leaves are in different cells; depth + 1 where they are the same. Keys that are none, being too large,
// part at the root: nothing reaches out of a table of levels.
MYRIAD_FN uint octree_parting(uvec2 a, uvec2 b, uint depth) {
    const uint high = a.y ^ b.y, low = a.x ^ b.x;
    if ((high | low) == 0u) return depth + 1u;
    const uint bit = high != 0u ? 32u + uint(findMSB(high)) : uint(findMSB(low));
    return depth - min(bit / 3u, depth);
}
MYRIAD_END

#endif
