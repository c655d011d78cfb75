#version 460
#extension GL_GOOGLE_include_directive : require
// Gathers with exact visibility: a shadow ray from each pixel to each VPL of its set. The same-VPL reference of the spec.
#include "engine/kernel.glsl"
#include "compute/raytrace/trace.glsl"
#include "passes/gather/gather_io.h"
layout(push_constant, scalar) uniform Push { GatherRaysPush push; };

void main() {
    const GatherPixel pixel = gather_pixel(workgroup_index(), gl_LocalInvocationIndex, gl_WorkGroupSize.x, push.gbuffer.width,
                                           push.gbuffer.height, push.block);
    if (!pixel.inside) return;
    const uint p = pixel.y * push.gbuffer.width + pixel.x;
    const vec4 position = push.gbuffer.positions.at[p];
    if (position.w == 0.0f) return;
    const vec3 x = position.xyz;
    const uvec2 normals = push.gbuffer.normals.at[p];
    const vec3 n = unpack_direction(normals.x);
    const vec3 origin = ray_origin(x, unpack_direction(normals.y), push.reach);

    const uint sets = push.block * push.block;
    const uint end = min(push.first + push.limit, push.count.at[0]);
    vec3 sum = vec3(0.0f);
    for (uint i = push.first + pixel.set; i < end; i += sets) {
        const Vpl vpl = push.vpls.at[i];
        const float g = bounded_geometry(x, n, vpl.position, unpack_direction(vpl.normal), push.bound);
        if (g > 0.0f && !trace_occluded(push.bvh, origin, vpl.position - origin, 0.0f, 1.0f)) sum += vpl.flux * g;
    }
    push.irradiance.at[p] += vec4(sum * (float(sets) / 3.14159265f), 0.0f);
    if (trace_exhausted) push.status.at[0] = 1u;
}
