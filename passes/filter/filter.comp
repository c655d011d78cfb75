#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a pixel.
#include "engine/kernel.glsl"
#include "passes/filter/filter_io.h"
layout(constant_id = glossy_constant) const bool glossy = false;
layout(push_constant, scalar) uniform Push { FilterPush push; };

void main() {
    const uint width = push.gbuffer.width, height = push.gbuffer.height;
    const uint pixel = thread_index();
    if (pixel >= width * height) return;
    const vec4 position = push.gbuffer.positions.at[pixel];
    vec3 sum = vec3(0.0f);
    vec3 mirrored = vec3(0.0f);
    if (position.w != 0.0f) {
        const uvec2 normals = push.gbuffer.normals.at[pixel];
        const vec3 n = unpack_direction(normals.x), n_g = unpack_direction(normals.y);
        const float scale = position.w * push.pixel_angle * float(push.block);
        const int x = int(pixel % width), y = int(pixel / width), reach = filter_reach(push.block);
        float total = 0.0f;
        Gloss gloss = Gloss(0u, 0u, 0u);
        vec3 view = vec3(0.0f);
        float mirrored_total = 0.0f;
        if (glossy) {
            gloss = push.gbuffer.gloss.at[pixel];
            view = unpack_direction(gloss.view);
        }
        for (int dy = max(-reach, -y); dy <= min(reach, int(height) - 1 - y); ++dy)
            for (int dx = max(-reach, -x); dx <= min(reach, int(width) - 1 - x); ++dx) {
                const uint i = uint(y + dy) * width + uint(x + dx);
                const vec4 q = push.gbuffer.positions.at[i];
                if (q.w == 0.0f) continue;
                const float w = filter_tap(dx, push.block) * filter_tap(dy, push.block) *
                                filter_alike(position.xyz, n, n_g, q.xyz, unpack_direction(push.gbuffer.normals.at[i].x), scale);
                sum += w * push.irradiance.at[i].xyz;
                total += w;
                if (!glossy) continue;
                const Gloss other = push.gbuffer.gloss.at[i];
                const float l = w * filter_alike_lobes(gloss, other);
                if (l == 0.0f) continue;
                mirrored += l * push.irradiance.at[width * height + i].xyz / filter_share(other, n, view);
                mirrored_total += l;
            }
        sum /= total;  // never 0: the pixel itself has weight 1
        if (mirrored_total > 0.0f) mirrored *= filter_share(gloss, n, view) / mirrored_total;
    }
    push.filtered.at[pixel] = vec4(sum, 0.0f);
    if (glossy) push.filtered.at[width * height + pixel] = vec4(mirrored, 0.0f);
}
