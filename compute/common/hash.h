// Scrambling of integers, and numbers in [0, 1) from them, the same in both languages.
#ifndef MYRIAD_COMPUTE_HASH_H
#define MYRIAD_COMPUTE_HASH_H

#include "engine/shared.h"

MYRIAD_BEGIN
MYRIAD_FN uint reverse_bits(uint v) {
    v = (v >> 16) | (v << 16);
    v = ((v >> 8) & 0x00ff00ffu) | ((v & 0x00ff00ffu) << 8);
    v = ((v >> 4) & 0x0f0f0f0fu) | ((v & 0x0f0f0f0fu) << 4);
    v = ((v >> 2) & 0x33333333u) | ((v & 0x33333333u) << 2);
    return ((v >> 1) & 0x55555555u) | ((v & 0x55555555u) << 1);
}

// A permutation of 32-bit words without visible pattern (lowbias32, Wellons 2018).
MYRIAD_FN uint hash(uint v) {
    v ^= v >> 16;
    v *= 0x7feb352du;
    v ^= v >> 15;
    v *= 0x846ca68bu;
    return v ^ (v >> 16);
}
MYRIAD_FN uint hash_pair(uint a, uint b) { return hash(a ^ hash(b + 0x9e3779b9u)); }

// Each bit is flipped or not depending on the bits above it: aligned blocks of size 2^k go to aligned blocks (Owen 1995; by
// hash: Laine and Karras 2011, Burley 2020).
MYRIAD_FN uint owen_scramble(uint v, uint seed) {
    v = reverse_bits(v);
    v ^= v * 0x3d20adeau;
    v += seed;
    v *= (seed >> 16) | 1u;
    v ^= v * 0x05526c56u;
    v ^= v * 0x53a22864u;
    return reverse_bits(v);
}

MYRIAD_FN float to_unit(uint v) { return float(v >> 8) * (1.0f / 16777216.0f); }  // [0, 1)
MYRIAD_END

#endif
