// What the G-buffer kernels, their host and the G-buffer's readers share.
#ifndef MYRIAD_PASSES_GBUFFER_IO_H
#define MYRIAD_PASSES_GBUFFER_IO_H

#include "compute/common/packing.h"
#include "passes/geometry/geometry_io.h"

MYRIAD_BEGIN
// The G-buffer as other kernels read it; pixel (x, y) is element y * width + x, and row 0 is the top. What is seen of
// emitters is an array apart (GBuffer::emitted), for only the sum of the image needs it.
struct GBufferRef {
    Float4s positions;   // world; w: depth along the camera's axis in metres, 0 where there is nothing
    Uint2s normals;      // pack_direction of the shading normal, then of the geometric; both face the camera
    Float4s albedo;      // rgb; w: ray_reach of the triangle, so that rays can leave from here
    Glosses gloss;       // where the G-buffer has it: for kernels that are told so (their constant `glossy`)
    uint width, height;
};
// The specialisation constant of kernels that light glossy surfaces, too.
const uint glossy_constant = 18u;

// A pinhole camera. The ray through image point (x, y), from (-1, -1) at the lower left to (1, 1), has the direction
// forward + x * right + y * up, where `right` and `up` are as long as the tangents of half the angles of view.
struct CameraPush {
    vec3 position;
    vec3 forward;        // unit
    vec3 right;
    vec3 up;
};

// Unit direction through a pixel's centre.
MYRIAD_FN vec3 camera_direction(CameraPush camera, uint x, uint y, uint width, uint height) {
    const float across = 2.0f * (float(x) + 0.5f) / float(width) - 1.0f;
    const float upward = 1.0f - 2.0f * (float(y) + 0.5f) / float(height);
    return normalize(camera.forward + across * camera.right + upward * camera.up);
}

// "gbuffer/trace": the closest hit of each pixel.
struct GBufferTracePush {
    BvhRef bvh;
    CameraPush camera;
    RayHitRecords hits;
    Uints exhausted;     // exhausted.at[0] = 1: a walk ran out of its loop budget
    uint width, height;
};

// "gbuffer/shade": what the rays hit. Apart from tracing because both together need more push constants than there are.
struct GBufferShadePush {
    GeometryRef geometry;
    RayHitRecords hits;
    Float4s positions;
    Uint2s normals;
    Float4s albedo;
    Glosses gloss;       // with has_gloss
    Float4s emitted;     // radiance that the surface itself sends to the camera, or what is behind everything
    vec3 eye;
    vec3 forward;
    vec3 background;     // radiance
    uint count;
    uint has_gloss;
};
MYRIAD_END

#ifdef __cplusplus
static_assert(sizeof(myriad::GBufferRef) == 40 && sizeof(myriad::GBufferTracePush) <= 128 && sizeof(myriad::GBufferShadePush) <= 128);
#endif

#endif
