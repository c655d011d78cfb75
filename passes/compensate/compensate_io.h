// What the kernel that gives back what the VPLs' bound cuts off, and its host, share.
#ifndef MYRIAD_PASSES_COMPENSATE_IO_H
#define MYRIAD_PASSES_COMPENSATE_IO_H

#include "compute/common/hash.h"
#include "passes/gbuffer/gbuffer_io.h"
#include "passes/geometry/light_io.h"

MYRIAD_BEGIN
// "compensate/compensate": adds ray `ray` of each pixel to those before it.
struct CompensatePush {
    GBufferRef gbuffer;
    GeometryRef geometry;
    BvhRef bvh;
    Lights lights;
    Float4s irradiance;  // of the receiver's diffuse part, W/m^2
    Uints exhausted;     // exhausted.at[0] = 1: a walk ran out of its loop budget
    uint light_count;
    float bound;         // of the geometry term, 1/m^2: what VPLs were gathered with
    uint seed;
    uint counts;         // compensate_counts
};
const uint compensate_most_rays = 255u;
const float compensate_most = 1e30f;  // as gather_most: later sums stay finite
MYRIAD_FN uint compensate_counts(uint ray, uint rays, uint bounces) { return ray | (rays << 8) | (bounces << 16); }
MYRIAD_FN uint compensate_ray(uint counts) { return counts & 255u; }
MYRIAD_FN uint compensate_rays(uint counts) { return counts >> 8 & 255u; }
MYRIAD_FN uint compensate_bounces(uint counts) { return counts >> 16; }

// Pixels of a block share one low-discrepancy set, which other blocks scramble in their own way: what the filter averages is well spread.
const uint compensate_block = 4u;
MYRIAD_FN uint compensate_index(uint x, uint y, uint ray) {
    return (ray * compensate_block + y % compensate_block) * compensate_block + x % compensate_block;
}
MYRIAD_FN uint compensate_seed(uint x, uint y, uint seed) {
    return hash_pair(hash_pair(seed, x / compensate_block), y / compensate_block);
}

// No surface farther away than this has a geometry term above the bound, cosines being 1 at most (metres).
MYRIAD_FN float compensate_reach(float bound) { return 1.0f / sqrt(bound); }

// The share of the light of a surface, met at distance t under these cosines, that the bound cuts off: (G - min(G, bound)) / G.
MYRIAD_FN float compensate_share(float cos_receiver, float cos_surface, float t, float bound) {
    const float g = cos_receiver * cos_surface;
    return g > 0.0f ? max(1.0f - bound * (t * t) / g, 0.0f) : 0.0f;
}
MYRIAD_END

#ifdef __cplusplus
static_assert(sizeof(myriad::CompensatePush) <= 128);
#endif

#endif
