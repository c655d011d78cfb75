#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a pixel: each light's irradiance, if its shadow ray gets through, reflected to the eye.
#include "engine/kernel.glsl"
#include "compute/raytrace/trace.glsl"
#include "passes/direct/direct_io.h"
layout(constant_id = glossy_constant) const bool glossy = false;
layout(push_constant, scalar) uniform Push { DirectPush push; };

void main() {
    const uint pixel = thread_index();
    if (pixel >= push.gbuffer.width * push.gbuffer.height) return;
    const vec4 position = push.gbuffer.positions.at[pixel];
    const vec4 albedo = push.gbuffer.albedo.at[pixel];
    vec3 irradiance = vec3(0.0);        // what the diffuse part reflects of it
    vec3 mirrored = vec3(0.0);          // radiance
    if (position.w > 0.0) {
        const uvec2 packed = push.gbuffer.normals.at[pixel];
        const vec3 shading_normal = unpack_direction(packed.x);
        const vec3 geometric_normal = unpack_direction(packed.y);
        Lobe lobe = matte_lobe();
        if (glossy) lobe = lobe_of(push.gbuffer.gloss.at[pixel], shading_normal);
        const vec3 origin = ray_origin(position.xyz, geometric_normal, albedo.w);
        for (uint i = push.first; i < push.last; ++i) {
            const Incident incident = incident_from(push.lights.at[i], position.xyz);
            const float cosine = dot(shading_normal, incident.to_light);
            // Light from behind the triangle does not come through, whatever the interpolated normal says.
            const bool lit = cosine > 0.0 && dot(geometric_normal, incident.to_light) > 0.0 &&
                             any(greaterThan(incident.irradiance, vec3(0.0)));
            // An unlit pixel takes an empty ray along instead of leaving its subgroup, whose rays are traced as a packet.
            // The others end a little early, so that a lamp that touches a surface is not hidden by it.
            const float t_max = lit ? 0.9999 * incident.distance : -1.0;
            const bool occluded = trace_occluded(push.bvh, origin, incident.to_light, 0.0, t_max);
            if (!lit || occluded) continue;
            const Reflectance r = reflectance_of(lobe, shading_normal, incident.to_light, 0.0);
            irradiance += r.diffuse * cosine * incident.irradiance;
            if (glossy) mirrored += r.glossy * cosine * incident.irradiance * brdf_fresnel(lobe.f0, r.power);
        }
    }
    const vec3 radiance = albedo.rgb * (1.0 / pi) * irradiance + mirrored;
    const vec3 before = push.first == 0u ? vec3(0.0) : push.radiance.at[pixel].rgb;
    push.radiance.at[pixel] = vec4(before + radiance, 0.0);
    if (trace_exhausted) push.exhausted.at[0] = 1u;
}
