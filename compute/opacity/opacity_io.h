// Where a triangle is: whether there is a surface at a point of it. The formulae for kernels, the host and the twins, which
// agree to the bit; see README.md.
#ifndef MYRIAD_COMPUTE_OPACITY_IO_H
#define MYRIAD_COMPUTE_OPACITY_IO_H

#include "compute/common/hash.h"
#include "compute/common/texture.h"
#include "compute/instances/instances.h"

#ifdef __cplusplus
#define precise
#endif

MYRIAD_BEGIN
// The alpha of a material, and what it does.
struct OpacityMaterial {
    TextureRef texture;  // its alpha; width 0: none
    float alpha;         // factor
    float cutoff;        // masked: is there where alpha is at least that; opacity_blended: with the probability of its alpha
};
MYRIAD_ARRAY(OpacityMaterials, OpacityMaterial, 4)

const float opacity_blended = -1.0f;

// What kernels read, in a buffer of its own because push constants are short. Arrays that no material needs are empty.
struct OpacityArrays {
    Uint4s triangles;         // as stored: three vertices, then the material
    Vec2s texcoords, texcoords1;
    Float4s colors;           // only if has_colors
    OpacityMaterials materials;
    Uints texels;
    Instances instances;      // if triangles are shared
    uint instance_count;
    uint has_colors;
};
MYRIAD_ARRAY(OpacityRef, OpacityArrays, 8)

MYRIAD_FN float opacity_mix(float a, float b, float weight) {
    precise const float mixed = a + (b - a) * weight;
    return mixed;
}
// Barycentrics (u, v): the values of three vertices at a point.
MYRIAD_FN float opacity_at_point(float a, float b, float c, float u, float v) {
    precise const float at = a + (b - a) * u + (c - a) * v;
    return at;
}
// The filtered alpha of four texels.
MYRIAD_FN float opacity_of_texels(uvec4 texel, vec2 weight) {
    const float top = opacity_mix(float(texel.x >> 24), float(texel.y >> 24), weight.x);
    const float bottom = opacity_mix(float(texel.z >> 24), float(texel.w >> 24), weight.x);
    return opacity_mix(top, bottom, weight.y) / 255.0f;
}

// ---- Blended surfaces ----
//
// A blended surface is there with the probability of its alpha (stochastic transparency: Enderton et al. 2010), so that all
// that asks once finds a surface or none, and the mean is what blending gives. Who asks says which dice are thrown:
//   opacity_alone      the point's own: rays that differ are independent
//   opacity_pixel(…)   a pixel's: over each aligned 4 x 4 pixels, a triangle's 16 thresholds are in the 16 sixteenths of
//                      [0, 1), so that a pane of alpha 1/4 shows in four of them; triangles and blocks are independent
const uint opacity_alone = 0xffffffffu;

MYRIAD_FN uint opacity_pixel(uint x, uint y) {
    const uint a = x ^ y;  // Bayer's order: each quarter of the block holds a pixel of each quarter of the thresholds
    const uint place = ((a & 1u) << 3) | ((x & 1u) << 2) | (a & 2u) | ((x & 2u) >> 1);
    return (((y >> 2) & 0x3fffu) << 18) | (((x >> 2) & 0x3fffu) << 4) | place;
}

// Of the triangle of the world with this id, in [0, 1). Points are told apart up to 2^-16 of the triangle, so that the last bits of u and v do not matter.
MYRIAD_FN float opacity_threshold(uint id, float u, float v, uint dice) {
    if (dice == opacity_alone) return to_unit(hash_pair(hash_pair(id, uint(u * 65536.0f)), uint(v * 65536.0f)));
    return to_unit(owen_scramble((dice & 15u) << 28, hash_pair(id, dice >> 4)));
}

// A view's maps show a blended surface whole or not at all, so that it is there in its share of the views, however coarse the
// node is that stands for it. Trees keep what is missing of a node's surface in fifteenths; of 15 there is nothing to keep.
const uint opacity_nothing = 15u;
MYRIAD_FN uint opacity_missing(float alpha) { return uint(clamp(floor((1.0f - alpha) * 15.0f + 0.5f), 0.0f, 15.0f)); }
// Views at any stride have thresholds that fill [0, 1) evenly: multiples of the golden section.
MYRIAD_FN bool opacity_in_view(uint missing, uint view) { return to_unit(view * 0x9e3779b9u) * 15.0f >= float(missing); }

MYRIAD_FN bool opacity_decides(float alpha, float cutoff, uint id, float u, float v, uint dice) {
    return cutoff >= 0.0f ? alpha >= cutoff : alpha > opacity_threshold(id, u, v, dice);
}
MYRIAD_END

#ifdef __cplusplus
#undef precise
static_assert(sizeof(myriad::OpacityMaterial) == 48 && sizeof(myriad::OpacityArrays) == 64);
#endif

#endif
