// What the glow kernels, their host and their twin share.
#ifndef MYRIAD_PASSES_GLOW_IO_H
#define MYRIAD_PASSES_GLOW_IO_H

#include "passes/gbuffer/gbuffer_io.h"
#include "passes/geometry/light_io.h"

MYRIAD_BEGIN
// Pixels that a ball may be drawn over, from its middle: 2 * glow_reach + 1 a side, fewer than the least loop limit of drivers (65535).
const float glow_reach = 100.0f;
// The least radius of a disc, in pixels: no pixel's middle between four of them is missed, and discs that move do not flicker.
const float glow_least = 1.25f;
// Ball by ball sums are integers, so that their order does not matter: units of the largest value that a ball adds, times their number, over this.
const float glow_units = 4294000000.0f;  // below 2^32 by more than what rounding adds of a million balls

// "glow/splat": an invocation a light of [first, first + count).
struct GlowSplatPush {
    Lights lights;
    Float4s positions;   // of the G-buffer
    Uints sums;          // three a pixel; cleared before
    CameraPush camera;
    uint width, height;
    uint first, count;
    float per_unit;      // units a W/(m^2 sr)
};

// "glow/resolve": an invocation a pixel.
struct GlowResolvePush {
    Uints sums;
    Float4s emitted;     // of the G-buffer, which it is added to
    uint pixels;
    float unit;          // W/(m^2 sr)
};

// What a ball of radius r and intensity I looks like: everywhere of radiance I / (pi r^2). It is drawn as a disc that fades out, (1 - s^2)^2 at
// the share s of its radius, whose integral is a third of the disc's: of sqrt(3) times the radius and as bright in its middle; and where that is
// less than glow_least pixels as large as they are, and darker by as much, so that what reaches the camera stays.
struct GlowDisc {
    float x, y;          // of the middle, in pixels: (0.5, 0.5) is the middle of the first
    float radius;        // pixels; 0: not seen
    float depth;         // along the camera's axis
    float share;         // of the radiance, in the middle
};
MYRIAD_FN GlowDisc glow_disc(CameraPush camera, vec3 position, float ball, uint width, uint height) {
    GlowDisc disc;
    disc.radius = 0.0f;
    disc.x = 0.0f;
    disc.y = 0.0f;
    disc.share = 0.0f;
    const vec3 d = position - camera.position;
    disc.depth = dot(d, camera.forward);
    // From within a ball, and beside the eye, nothing of it is seen.
    if (!(ball > 0.0f && disc.depth > max(ball, 1e-9f))) return disc;
    const float half_height = 0.5f * float(height);
    const float right2 = dot(camera.right, camera.right);
    const float up2 = dot(camera.up, camera.up);
    disc.x = (dot(d, camera.right) / (right2 * disc.depth) + 1.0f) * (0.5f * float(width));
    disc.y = (1.0f - dot(d, camera.up) / (up2 * disc.depth)) * half_height;
    const float true_radius = ball / (sqrt(up2) * disc.depth) * half_height;
    disc.radius = clamp(1.7320508f * true_radius, glow_least, glow_reach);
    disc.share = min(3.0f * true_radius * true_radius / (disc.radius * disc.radius), 1.0f);
    return disc;
}
// Of the share in the middle, what a pixel has at (dx, dy) pixels from it.
MYRIAD_FN float glow_falloff(GlowDisc disc, float dx, float dy) {
    const float s = 1.0f - (dx * dx + dy * dy) / (disc.radius * disc.radius);
    return s > 0.0f ? s * s : 0.0f;
}
// The pixels of an axis that a disc may reach, first and one past the last.
MYRIAD_FN uint glow_first(float middle, float radius, uint size) { return uint(clamp(-floor(0.5f + radius - middle), 0.0f, float(size))); }
MYRIAD_FN uint glow_end(float middle, float radius, uint size) { return uint(clamp(floor(middle + radius - 0.5f) + 1.0f, 0.0f, float(size))); }

MYRIAD_FN float glow_radiance(float intensity, float ball) { return min(intensity / (pi * max(ball * ball, 1e-24f)), 1e30f); }
MYRIAD_FN uint glow_in_units(float radiance, float per_unit) { return uint(min(radiance * per_unit, glow_units) + 0.5f); }
MYRIAD_END

#ifdef __cplusplus
static_assert(sizeof(myriad::GlowSplatPush) <= 128 && sizeof(myriad::GlowResolvePush) <= 128);
#endif

#endif
