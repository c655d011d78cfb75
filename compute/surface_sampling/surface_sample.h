// One sample of the surface, as kernels see it.
#ifndef MYRIAD_COMPUTE_SURFACE_SAMPLE_H
#define MYRIAD_COMPUTE_SURFACE_SAMPLE_H

#include "engine/shared.h"

MYRIAD_BEGIN
// Its position follows the triangle when that deforms (ManyLoDs 4.1).
struct SurfaceSample {
    uint triangle;
    float u, v;                      // position = (1 - u - v) p0 + u p1 + v p2
};
MYRIAD_ARRAY(SurfaceSamples, SurfaceSample, 4)
MYRIAD_END

#endif
