#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a light: its ball's disc, pixel by pixel, where no surface is nearer to the camera than the ball's middle.
#include "engine/kernel.glsl"
#include "passes/glow/glow_io.h"
layout(push_constant, scalar) uniform Push { GlowSplatPush push; };

void main() {
    if (thread_index() >= push.count) return;
    const Light light = push.lights.at[push.first + thread_index()];
    if (light.type != light_point) return;
    const float ball = light.extent.x;
    const GlowDisc disc = glow_disc(push.camera, light.position, ball, push.width, push.height);
    if (disc.radius == 0.0f) return;
    const vec3 radiance = vec3(glow_radiance(light.intensity.x, ball), glow_radiance(light.intensity.y, ball), glow_radiance(light.intensity.z, ball));
    const uint x0 = glow_first(disc.x, disc.radius, push.width), x1 = glow_end(disc.x, disc.radius, push.width);
    const uint y1 = glow_end(disc.y, disc.radius, push.height);
    if (x0 >= x1) return;
    uint x = x0;
    for (uint y = glow_first(disc.y, disc.radius, push.height); y < y1;) {
        const uint pixel = y * push.width + x;
        const float depth = push.positions.at[pixel].w;
        const float share = disc.share * glow_falloff(disc, float(x) + 0.5f - disc.x, float(y) + 0.5f - disc.y);
        if (share > 0.0f && (depth == 0.0f || depth >= disc.depth))
            for (uint c = 0u; c < 3u; ++c) {
                const uint units = glow_in_units(share * radiance[c], push.per_unit);
                if (units != 0u) atomicAdd(push.sums.at[3u * pixel + c], units);
            }
        ++x;
        if (x == x1) {
            x = x0;
            ++y;
        }
    }
}
