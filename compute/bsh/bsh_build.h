// How bounds are made: the formulae of the bottom-up pass, for the kernels and their twin.
//
// Everything is rounded outward: a sphere's centre is whatever the code decodes to, and its radius is an upper bound of
// what reaches out from there. Float errors are below 2^-21 relative; `bsh_reach` adds 2^-20.
#ifndef MYRIAD_COMPUTE_BSH_BUILD_H
#define MYRIAD_COMPUTE_BSH_BUILD_H

#include "compute/bsh/bsh_io.h"
#include "compute/instances/instances.h"
#include "compute/opacity/opacity_io.h"

MYRIAD_BEGIN
// A parent is larger than what its children need by this factor, so that criteria computed in floating point decrease
// from parent to child (spec, section 2).
const float bsh_slack = 1.0f + 1.0f / 65536.0f;
// Moves of the centre in bsh_merge; README.md has what fewer and more of them give.
const uint bsh_merge_moves = 8u;

// A block's children. Of one that has fewer, the last is repeated, which changes no bound; kernels look at no more than the arity.
#ifdef __cplusplus
const uint bsh_looked_at = bsh_most;
#else
const uint bsh_looked_at = bsh_arity;
#endif
struct BshSpheres { Sphere at[bsh_most]; };
struct BshCones { uint at[bsh_most]; };
struct BshBoxes {
    BshBox at[bsh_most];     // in world space
    uint missing[bsh_most];  // of each, as bsh_missing
};

// "bsh/leaves" and "bsh/inner": one invocation a block of the level whose nodes are slots [first_slot, first_slot + nodes), or one a
// block that is listed.
struct BshLevelPush {
    Float4s frames;            // by block
    Uint2s spheres;            // by slot
    Uints cones;               // by slot
    Float4s merged;            // by block: the sphere of the node that owns it, before it is encoded
    Uint2s boxes;              // by slot
    Float4s merged_boxes;      // by block, two each: low and high corner of the node that owns it
    SurfaceSamples samples;    // leaves only, with the three below
    Uint4s triangles;
    Positions positions;
    Instances instances;       // where triangles are shared
    OpacityRef opacity;        // where some blend
    Uints listed;              // blocks, counted from the level's first
    float leaf_radius;         // of the sphere around a sample
    float leaf_share;          // area of the surface over the number of samples
    uint nodes, first_slot;
    uint first_child_block;    // inner only: the block that the level's first node owns
    uint first_owner;          // slot of the node that owns the level's first block; 0: nobody owns it, it holds the root
    uint instance_count;       // leaves only
    uint listed_count;         // 0: all blocks of the level
};

// "bsh/quality"
const uint bsh_quality_sums = 4096u;
MYRIAD_ARRAY(BshSums, vec2, 8)
struct BshQualityPush {
    Float4s merged;            // by block
    Uint2s spheres;            // by slot
    BshSums sums;              // bsh_quality_sums, over inner nodes: children's volumes over the node's own; the square of its radius
    uint blocks;
};

// At least |s.center - c| + s.radius; the radius itself where the centres coincide.
MYRIAD_FN float bsh_reach(vec3 c, Sphere s) {
    const float x = s.center.x - c.x;
    const float y = s.center.y - c.y;
    const float z = s.center.z - c.z;
    if (x == 0.0f && y == 0.0f && z == 0.0f) return s.radius;
    // 2^-50 m covers squares that underflow, here and in the criterion of views as near as that: they are inside.
    return (sqrt(x * x + y * y + z * z) + s.radius) * (1.0f + 1.0f / 1048576.0f) + 8.8817842e-16f;
}

// The frame of a block: the least corner of its children's centres, and the least power of two as the step that spans
// them. With a power of two, decoding is the same with and without fused multiply-add, on every device.
MYRIAD_FN vec4 bsh_frame(BshSpheres children, uint count) {
    vec3 low = children.at[0].center;
    vec3 high = low;
    for (uint i = 1u; i < count; ++i) {
        low = min(low, children.at[i].center);
        high = max(high, children.at[i].center);
    }
    const float extent = max(max(high.x - low.x, high.y - low.y), high.z - low.z) / 65535.0f;
    return vec4(low, uintBitsToFloat((floatBitsToUint(extent) + 0x7fffffu) & 0x7f800000u));
}
MYRIAD_FN vec4 bsh_frame(BshSpheres children) { return bsh_frame(children, bsh_looked_at); }

MYRIAD_FN uint bsh_quantise(float v, float origin, float step) {
    return step > 0.0f ? uint(clamp(floor((v - origin) / step + 0.5f), 0.0f, 65535.0f)) : 0u;
}
MYRIAD_FN uvec2 bsh_encode(vec4 frame, Sphere s) {
    const uint x = bsh_quantise(s.center.x, frame.x, frame.w);
    const uint y = bsh_quantise(s.center.y, frame.y, frame.w);
    const uint z = bsh_quantise(s.center.z, frame.z, frame.w);
    const Sphere decoded = bsh_decode(frame, uvec2(x | (y << 16), z));
    return uvec2(x | (y << 16), z | (bsh_radius_code(bsh_reach(decoded.center, s)) << 16));
}

// A small sphere around them: from the centre of their box, a few moves towards the farthest (Badoiu and Clarkson 2003),
// and the best centre seen.
MYRIAD_FN Sphere bsh_merge(BshSpheres children) {
    vec3 low = children.at[0].center - children.at[0].radius;
    vec3 high = children.at[0].center + children.at[0].radius;
    for (uint i = 1u; i < bsh_looked_at; ++i) {
        low = min(low, children.at[i].center - children.at[i].radius);
        high = max(high, children.at[i].center + children.at[i].radius);
    }
    Sphere best;
    best.radius = -1.0f;
    vec3 center = 0.5f * low + 0.5f * high;
    for (uint move = 0u; move <= bsh_merge_moves; ++move) {
        float radius = 0.0f;
        vec3 farthest = center;
        for (uint i = 0u; i < bsh_looked_at; ++i) {
            const float reach = bsh_reach(center, children.at[i]);
            if (reach > radius) {
                radius = reach;
                farthest = children.at[i].center;
            }
        }
        if (best.radius < 0.0f || radius < best.radius) {
            best.center = center;
            best.radius = radius;
        }
        center = center + (farthest - center) * (1.0f / float(move + 8u));
    }
    best.radius = best.radius * bsh_slack;
    return best;
}

// ---- Boxes ----

// How far a sample's patch reaches in its plane, in units of the leaf's radius. On a triangle that holds several samples it
// reaches as far as the leaf, and ends where the triangle's own box ends; a triangle smaller than a sample's share of the area
// has to stand for its neighbours, and reaches this far beyond itself: further, and it sticks out at every edge of the surface; less, and it
// leaves holes. Measured against exact rays, Sponza and atrium, 2^20 samples, 1024 VPLs, maps of 64: relMSE 0.0083 and 0.0118 at 0.42,
// 0.0096 and 0.0131 at 0.6, 0.038 and 0.021 at 1.
const float bsh_patch_small = 0.42f;

// `share`: the surface's area over the number of samples.
MYRIAD_FN BshBox bsh_patch_box(vec3 p, vec3 a, vec3 b, vec3 c, uint cone, float radius, float share) {
    const vec3 n = bsh_cone_axis(cone);
    const bool ball = (cone >> 24) == 255u;
    const vec3 e = cross(b - a, c - a);
    const float area = 0.5f * sqrt(dot(e, e));
    const float standing = share > 0.0f ? clamp(2.0f - area / share, 0.0f, 1.0f) : 1.0f;
    const vec3 unit = ball ? vec3(1.0f, 1.0f, 1.0f)
                           : vec3(sqrt(max(1.0f - n.x * n.x, 0.0f)), sqrt(max(1.0f - n.y * n.y, 0.0f)), sqrt(max(1.0f - n.z * n.z, 0.0f)));
    const vec3 reach = unit * (radius * mix(1.0f, bsh_patch_small, standing));
    BshBox box;
    box.low = max(p - reach, min(a, min(b, c)) - standing * reach);
    box.high = min(p + reach, max(a, max(b, c)) + standing * reach);
    return box;
}
MYRIAD_FN uint bsh_box_code(float v, float radius, float round_up) {
    return radius > 0.0f ? uint(clamp(floor((v / radius + 1.0f) * 511.0f + round_up), 0.0f, 1023.0f)) : 511u;
}
MYRIAD_FN uvec2 bsh_encode_box(Sphere s, BshBox box, uint missing) {
    const vec3 low = box.low - s.center;
    const vec3 high = box.high - s.center;
    const float up = 0.99999f;
    return uvec2(bsh_box_code(low.x, s.radius, 0.0f) | (bsh_box_code(low.y, s.radius, 0.0f) << 10) | (bsh_box_code(low.z, s.radius, 0.0f) << 20) | (missing << 30),
                 bsh_box_code(high.x, s.radius, up) | (bsh_box_code(high.y, s.radius, up) << 10) | (bsh_box_code(high.z, s.radius, up) << 20) | ((missing >> 2) << 30));
}
MYRIAD_FN BshBox bsh_merge_boxes(BshBoxes children) {
    BshBox box = children.at[0];
    for (uint i = 1u; i < bsh_looked_at; ++i) {
        box.low = min(box.low, children.at[i].low);
        box.high = max(box.high, children.at[i].high);
    }
    return box;
}

// The position of a sample.
MYRIAD_FN vec3 bsh_position(vec3 a, vec3 b, vec3 c, float u, float v) { return (1.0f - u - v) * a + u * b + v * c; }

MYRIAD_FN uint bsh_merge_missing(BshBoxes children) {
    uint least = children.missing[0];
    for (uint i = 1u; i < bsh_looked_at; ++i) least = min(least, children.missing[i]);
    return least;
}

// ---- Cones of lines ----

MYRIAD_FN uint bsh_cone_pack_axis(vec3 d) {
    const vec2 p = oct_fold(d);
    return uint(int(floor(p.x * 2047.0f + 0.5f)) + 0x800) | (uint(int(floor(p.y * 2047.0f + 0.5f)) + 0x800) << 12);
}

// The least cone around `axis` that holds angles of cosine `least_cos`, less what rounding may have cost.
MYRIAD_FN uint bsh_cone_code(uint axis, float least_cos) {
    const float t = sqrt(clamp(1.0f - least_cos + 1.0f / 1048576.0f, 0.0f, 1.0f));
    return axis | (min(uint(t * 255.0f) + 1u, 255u) << 24);
}

// Of the triangle with these edges. The normal of a needle is uncertain, so its cone is wider; at the end it is all.
MYRIAD_FN uint bsh_cone_of(vec3 e, vec3 f) {
    const float size = max(max(max(abs(e.x), abs(e.y)), abs(e.z)), max(max(abs(f.x), abs(f.y)), abs(f.z)));
    if (!(size > 0.0f)) return bsh_cone_all;
    const vec3 n = cross(e / size, f / size);
    const float norm = sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
    const float sin_error = 1.9073486e-6f / norm;  // 2^-19: the error of n, whose edges are of length 1
    if (!(sin_error < 0.5f)) return bsh_cone_all;
    const uint axis = bsh_cone_pack_axis(n);
    const vec3 a = bsh_cone_axis(axis);
    const vec3 s = cross(a, n / norm);
    const float sin_axis = sqrt(s.x * s.x + s.y * s.y + s.z * s.z);
    const float sine = sin_axis + sin_error;  // at least the sine of the sum
    return sine < 1.0f ? bsh_cone_code(axis, sqrt(1.0f - sine * sine)) : bsh_cone_all;
}

// The cone around them. Each axis is flipped into the hemisphere of the first; the owner's is between their extremes.
MYRIAD_FN uint bsh_cone_merge(BshCones children, uint count) {
    const vec3 first = bsh_cone_axis(children.at[0]);
    vec3 low = first;
    vec3 high = first;
    for (uint i = 1u; i < count; ++i) {
        vec3 a = bsh_cone_axis(children.at[i]);
        if (a.x * first.x + a.y * first.y + a.z * first.z < 0.0f) a = -a;
        low = min(low, a);
        high = max(high, a);
    }
    const vec3 between = low + high;
    if (!(abs(between.x) + abs(between.y) + abs(between.z) > 0.0f)) return bsh_cone_all;
    const uint axis = bsh_cone_pack_axis(between);
    const vec3 to = bsh_cone_axis(axis);
    float least_cos = 1.0f;
    uint least_code = 0u;
    for (uint i = 0u; i < count; ++i) {
        const uint cone = children.at[i];
        // A cone around the very axis adds its angle as it is: flat surfaces stay as flat as their triangles.
        if ((cone & 0xffffffu) == axis) {
            least_code = max(least_code, cone >> 24);
            continue;
        }
        const vec3 a = bsh_cone_axis(cone);
        const vec3 s = cross(a, to);
        const float ca = abs(a.x * to.x + a.y * to.y + a.z * to.z);
        const float sa = sqrt(s.x * s.x + s.y * s.y + s.z * s.z);
        const vec2 cs = bsh_cone_cos_sin(cone);
        least_cos = min(least_cos, ca * cs.x - sa * cs.y);
    }
    const uint code = least_cos < 1.0f ? bsh_cone_code(axis, least_cos) >> 24 : 0u;
    return axis | (max(code, least_code) << 24);
}
MYRIAD_FN uint bsh_cone_merge(BshCones children) { return bsh_cone_merge(children, bsh_looked_at); }
MYRIAD_END

#endif
