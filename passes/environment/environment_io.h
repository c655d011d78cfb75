// What the background kernel, its host and its twin share: an environment's picture, and where directions lie in it (scenes/environment.hpp).
#ifndef MYRIAD_PASSES_ENVIRONMENT_IO_H
#define MYRIAD_PASSES_ENVIRONMENT_IO_H

#include "passes/gbuffer/gbuffer_io.h"

MYRIAD_BEGIN
MYRIAD_ARRAY(EnvironmentTexels, vec3, 4)

// "environment/background": the picture, in emitted light, where the camera's rays leave the scene.
struct BackgroundPush {
    EnvironmentTexels texels;    // row after row, width x height
    Float4s positions;           // of the G-buffer: w is 0 where nothing is
    Float4s emitted;
    CameraPush camera;
    uint width, height;          // of the image
    uint columns, rows;          // of the picture
    float turn;                  // rotation about +y, in whole turns
};
MYRIAD_END

#ifdef __cplusplus
namespace myriad {
inline float angle_of(float y, float x) { return std::atan2(y, x); }
}  // namespace myriad
static_assert(sizeof(myriad::BackgroundPush) <= 128);
#else
float angle_of(float y, float x) { return atan(y, x); }
#endif

MYRIAD_BEGIN
// The place of a direction in the picture: 0 to 1 from left to right, and from top to bottom. By tangents: drivers' arc sines are bad.
MYRIAD_FN vec2 environment_place(vec3 d, float turn) {
    const float around = angle_of(d.z, d.x) * (0.5f / pi) + 0.5f + turn;
    const float down = angle_of(sqrt(d.x * d.x + d.z * d.z), d.y) * (1.0f / pi);
    return vec2(around - floor(around), down);
}

// The four texels around a place, and how far it is from the first one's middle to the second's along each axis. The picture closes
// around the axis; at the poles its edge rows end it.
struct EnvironmentQuad {
    uvec4 index;   // upper left, upper right, lower left, lower right
    vec2 weight;
};
MYRIAD_FN EnvironmentQuad environment_quad(vec2 place, uint columns, uint rows) {
    const vec2 at = vec2(place.x * float(columns), place.y * float(rows)) - vec2(0.5f, 0.5f);
    const vec2 whole = floor(at);
    const uint left = uint(int(whole.x) + int(columns)) % columns, right = (left + 1u) % columns;
    const uint upper = uint(clamp(int(whole.y), 0, int(rows) - 1)), lower = uint(clamp(int(whole.y) + 1, 0, int(rows) - 1));
    EnvironmentQuad q;
    q.index = uvec4(upper * columns + left, upper * columns + right, lower * columns + left, lower * columns + right);
    q.weight = at - whole;
    return q;
}
MYRIAD_END

#endif
