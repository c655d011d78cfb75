// What the direct-light kernel and its host share.
#ifndef MYRIAD_PASSES_DIRECT_IO_H
#define MYRIAD_PASSES_DIRECT_IO_H

#include "passes/gbuffer/gbuffer_io.h"
#include "passes/geometry/light_io.h"

MYRIAD_BEGIN
// "direct/direct": adds lights [first, last) to what the lights before them gave.
struct DirectPush {
    GBufferRef gbuffer;
    BvhRef bvh;
    Lights lights;
    Float4s radiance;    // rgb
    Uints exhausted;     // exhausted.at[0] = 1: a walk ran out of its loop budget
    uint first, last;    // punctual lights; first == 0 overwrites instead of adding
};
MYRIAD_END

#ifdef __cplusplus
static_assert(sizeof(myriad::DirectPush) <= 128);
#endif

#endif
