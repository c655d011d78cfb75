// How the octree's bounds are made: the formulae of its kernels, for them and their twin.
//
// Everything is rounded outward, as in compute/bsh/bsh_build.h. What a triangle has in a cell is bounded by a box: the cell's, cut to the triangle's own box and
// to what its plane has of it, along each axis. Nothing is clipped against edges: those are missed where a large triangle ends within a cell, which a box
// around it bounds all the same. Lengths are in half sides of a leaf's cell, from its middle.
#ifndef MYRIAD_COMPUTE_SVO_BUILD_H
#define MYRIAD_COMPUTE_SVO_BUILD_H

#include "compute/bsh/bsh_build.h"
#include "compute/octree/octree_io.h"
#include "compute/svo/svo_io.h"

MYRIAD_BEGIN
// "svo/leaves": one invocation a parent of leaves: the leaves, their block, and what the parent bounds.
struct SvoLeavesPush {
    SvoBlocks blocks;
    Uint2s spheres;          // by node
    Uints cones;             // by node
    Uint2s boxes;            // by node
    Float4s merged;          // by inner node, three each: sphere; low corner and weight; high corner and what is missing
    OctreeRef octree;        // its items are triangles
    Uint4s triangles;
    Positions positions;
    Instances instances;
    OpacityRef opacity;
    OctreeCube cube;
    uint instance_count;
    uint shape;              // depth << 28 | room for inner nodes: where there is too little nothing is written
};
// "svo/inner": one invocation a node of a level above, from the lowest up.
struct SvoInnerPush {
    SvoBlocks blocks;
    Uint2s spheres;
    Uints cones;
    Uint2s boxes;
    Float4s merged;
    OctreeRef octree;
    uint level;
    uint shape;
};

// A leaf's cell in the world.
struct SvoCell {
    vec3 middle;
    float half_side, scale;  // scale: 1 / half_side; both 0 where all is one place
    float slack;             // m: by how much its middle, or a point that is reckoned from it, may be off
};
MYRIAD_FN SvoCell svo_cell(uvec2 key, OctreeCube cube, uint depth) {
    const float side = cube.cells_per_length > 0.0f ? 1.0f / cube.cells_per_length : 0.0f;
    MYRIAD_PRECISE const vec3 middle = cube.origin + (vec3(octree_cell_of(key)) + 0.5f) * side;
    SvoCell cell;
    cell.middle = middle;
    cell.half_side = 0.5f * side;
    cell.scale = 2.0f * cube.cells_per_length;
    cell.slack = (max(abs(cube.origin.x), max(abs(cube.origin.y), abs(cube.origin.z))) + side * float(1u << depth)) * 4.76837158e-7f + 1e-34f;  // 2^-21
    return cell;
}

// What a triangle has in a cell.
struct SvoPiece {
    vec3 low, high;
    vec3 mean;       // of its surface there, about; on its plane
    float weight;    // area, about
};

// As a sum in this order, everywhere.
MYRIAD_FN float svo_dot(vec3 a, vec3 b) {
    MYRIAD_PRECISE const float sum = a.x * b.x + a.y * b.y + a.z * b.z;
    return sum;
}

const float svo_error = 9.5367431640625e-7f;  // 2^-20

// One axis of a box, cut to where the plane n x = d +- error runs, of which the other axes' part lies in [rest_low, rest_high].
MYRIAD_FN void svo_tighten(MYRIAD_INOUT(float) low, MYRIAD_INOUT(float) high, float n, float rest_low, float rest_high, float d, float error) {
    MYRIAD_PRECISE const float p = (d - rest_high - error) / n;
    MYRIAD_PRECISE const float q = (d - rest_low + error) / n;
    const float least = min(p, q);
    const float most = max(p, q);
    if (!(abs(n) > 1e-3f)) return;  // runs along the axis
    if (least > low) low = least;
    if (most < high) high = most;
    if (low > high) {  // there by no more than the error
        low = 0.5f * low + 0.5f * high;
        high = low;
    }
}

MYRIAD_FN SvoPiece svo_piece(Corners t, SvoCell cell) {
    MYRIAD_PRECISE const vec3 a = (t.p0 - cell.middle) * cell.scale;
    MYRIAD_PRECISE const vec3 b = (t.p1 - cell.middle) * cell.scale;
    MYRIAD_PRECISE const vec3 c = (t.p2 - cell.middle) * cell.scale;
    const vec3 least = min(a, min(b, c));
    const vec3 most = max(a, max(b, c));
    MYRIAD_PRECISE const float reach = 1.0f + cell.slack * cell.scale + svo_error;
    SvoPiece piece;
    piece.low = clamp(least - svo_error, vec3(-reach), vec3(reach));
    piece.high = clamp(most + svo_error, vec3(-reach), vec3(reach));
    piece.mean = 0.5f * (piece.low + piece.high);
    piece.weight = 0.0f;
    const vec3 e = b - a;
    const vec3 f = c - a;
    vec3 n = cross(e, f);
    const float largest = max(abs(n.x), max(abs(n.y), abs(n.z)));
    if (!(largest > 0.0f && largest < 1e30f)) return piece;
    n = n / largest;
    const float norm = sqrt(svo_dot(n, n));
    const float area = 0.5f * largest * norm;
    if (min(least.x, min(least.y, least.z)) >= -1.0f && max(most.x, max(most.y, most.z)) <= 1.0f) {  // all of it
        piece.mean = (a + b + c) * (1.0f / 3.0f);
        piece.weight = area;
    }
    const float d = svo_dot(n, a);
    // Of the normal, of d, and of corners that are rounded.
    MYRIAD_PRECISE const float error = svo_error * ((abs(e.x) + abs(e.y) + abs(e.z)) * (abs(f.x) + abs(f.y) + abs(f.z)) / largest + 2.0f) * (abs(a.x) + abs(a.y) + abs(a.z) + 3.0f);
    vec3 u = min(n * piece.low, n * piece.high);
    vec3 v = max(n * piece.low, n * piece.high);
    svo_tighten(piece.low.x, piece.high.x, n.x, u.y + u.z, v.y + v.z, d, error);
    svo_tighten(piece.low.y, piece.high.y, n.y, u.x + u.z, v.x + v.z, d, error);
    svo_tighten(piece.low.z, piece.high.z, n.z, u.x + u.y, v.x + v.y, d, error);
    if (piece.weight > 0.0f) return piece;
    const vec3 m = 0.5f * (piece.low + piece.high);
    const vec3 extent = piece.high - piece.low;
    vec3 on = m;
    float rectangle = extent.x * extent.y;
    if (abs(n.x) == 1.0f) {
        on.x = (d - n.y * m.y - n.z * m.z) / n.x;
        rectangle = extent.y * extent.z;
    } else if (abs(n.y) == 1.0f) {
        on.y = (d - n.x * m.x - n.z * m.z) / n.y;
        rectangle = extent.x * extent.z;
    } else {
        on.z = (d - n.x * m.x - n.y * m.y) / n.z;
    }
    piece.mean = on;  // on the plane, be it beside the box
    piece.weight = min(rectangle * norm, area);
    return piece;
}

// Barycentrics (u, v) of a place near a triangle, in the units of its corners; within it.
MYRIAD_FN vec2 svo_barycentrics(Corners t, vec3 place) {
    const vec3 e = t.p1 - t.p0;
    const vec3 f = t.p2 - t.p0;
    const vec3 g = place - t.p0;
    const float ee = svo_dot(e, e);
    const float ef = svo_dot(e, f);
    const float ff = svo_dot(f, f);
    const float ge = svo_dot(g, e);
    const float gf = svo_dot(g, f);
    const float det = ee * ff - ef * ef;
    if (!(det > 0.0f)) return vec2(0.0f);
    const float u = clamp((ff * ge - ef * gf) / det, 0.0f, 1.0f);
    const float v = clamp((ee * gf - ef * ge) / det, 0.0f, 1.0f);
    const float sum = max(u + v, 1.0f);
    return vec2(u / sum, v / sum);
}

// A leaf, piece by piece.
struct SvoLeaf {
    vec3 low, high, sum;
    float weight;
    uint cone, missing;
    uint pieces;
};
MYRIAD_FN SvoLeaf svo_leaf() {
    SvoLeaf leaf;
    leaf.low = vec3(1e30f);
    leaf.high = vec3(-1e30f);
    leaf.sum = vec3(0.0f);
    leaf.weight = 0.0f;
    leaf.cone = bsh_cone_all;
    leaf.missing = opacity_nothing;
    leaf.pieces = 0u;
    return leaf;
}
MYRIAD_FN uint svo_cone_join(uint a, uint b) {
    if (a == b || (a >> 24) == 255u) return a;
    BshCones both;
    both.at[0] = a;
    both.at[1] = b;
    return (b >> 24) == 255u ? b : bsh_cone_merge(both, 2u);
}
MYRIAD_FN void svo_add(MYRIAD_INOUT(SvoLeaf) leaf, SvoPiece piece, uint cone, uint missing) {
    leaf.low = min(leaf.low, piece.low);
    leaf.high = max(leaf.high, piece.high);
    // What is not there counts as little as lets a leaf of nothing else still have a middle.
    const float weight = missing == opacity_nothing ? piece.weight * 1e-6f : piece.weight;
    leaf.sum = leaf.sum + piece.mean * weight;
    leaf.weight = leaf.weight + weight;
    leaf.cone = leaf.pieces == 0u ? cone : svo_cone_join(leaf.cone, cone);
    leaf.missing = min(leaf.missing, missing);
    leaf.pieces = leaf.pieces + 1u;
}
// Where it is in the world: a sphere around its middle that holds the box.
MYRIAD_FN Sphere svo_sphere(SvoLeaf leaf, SvoCell cell) {
    MYRIAD_PRECISE const vec3 mean = leaf.weight > 0.0f ? leaf.sum / leaf.weight : 0.5f * (leaf.low + leaf.high);
    MYRIAD_PRECISE const vec3 far = max(leaf.high - mean, mean - leaf.low);
    MYRIAD_PRECISE const vec3 center = cell.middle + mean * cell.half_side;
    MYRIAD_PRECISE const float radius = sqrt(svo_dot(far, far)) * cell.half_side * (1.0f + svo_error) + 2.0f * cell.slack;
    Sphere s;
    s.center = center;
    s.radius = radius;
    return s;
}
MYRIAD_FN BshBox svo_box(SvoLeaf leaf, SvoCell cell) {
    MYRIAD_PRECISE const vec3 low = cell.middle + leaf.low * cell.half_side - cell.slack;
    MYRIAD_PRECISE const vec3 high = cell.middle + leaf.high * cell.half_side + cell.slack;
    BshBox box;
    box.low = low;
    box.high = high;
    return box;
}

// The node that owns a block, of whose children these are the sums: in the middle of the surface below it, around the children as they are decoded.
struct SvoOwner {
    vec3 sum, low, high;
    float weight;
    uint missing;
};
MYRIAD_FN SvoOwner svo_owner() {
    SvoOwner owner;
    owner.sum = vec3(0.0f);
    owner.low = vec3(3e38f);
    owner.high = vec3(-3e38f);
    owner.weight = 0.0f;
    owner.missing = opacity_nothing;
    return owner;
}
// `origin`: what the mean is reckoned from, the first child's middle, since scenes may be far from everything.
MYRIAD_FN void svo_add(MYRIAD_INOUT(SvoOwner) owner, vec3 origin, Sphere s, BshBox box, float weight, uint missing) {
    owner.sum = owner.sum + (s.center - origin) * weight;
    owner.weight = owner.weight + weight;
    owner.low = min(owner.low, box.low);
    owner.high = max(owner.high, box.high);
    owner.missing = min(owner.missing, missing);
}
MYRIAD_FN vec3 svo_middle(SvoOwner owner, vec3 origin) {
    return owner.weight > 0.0f ? origin + owner.sum / owner.weight : 0.5f * owner.low + 0.5f * owner.high;
}
MYRIAD_END

#endif
