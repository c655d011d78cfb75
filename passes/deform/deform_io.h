// What the deform kernels and their host share; the formulae are scenes/deform.h's.
#ifndef MYRIAD_PASSES_DEFORM_IO_H
#define MYRIAD_PASSES_DEFORM_IO_H

#include "passes/geometry/geometry_io.h"
#include "scenes/deform.h"

MYRIAD_BEGIN
// "deform/deform": an invocation a moving vertex. Arrays of vertices start at the first that moves.
struct DeformPush {
    MovingVertices vertices;
    Influences influences;
    MorphDeltas deltas;
    Float4s tangents_at_rest;  // these two where has_tangents says so
    Float4s tangents;
    Affines matrices;          // of the moment
    Floats weights;
    Vec3s positions, normals;
    uint count;
    uint has_tangents;
};

// "deform/flat": an invocation a triangle whose three vertices, one after the other, have its own normal.
struct DeformFlatPush {
    Uints flat_triangles;      // their first vertices, counted from the first that moves
    Vec3s positions, normals;
    uint count;
};
MYRIAD_END

#ifdef __cplusplus
static_assert(sizeof(myriad::DeformPush) <= 128 && sizeof(myriad::DeformFlatPush) <= 128);
#endif

#endif
