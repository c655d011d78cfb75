// The lights as kernels see them, and how they shine (KHR_lights_punctual; spec, section 5: 1:1 radiometric units).
#ifndef MYRIAD_PASSES_LIGHT_IO_H
#define MYRIAD_PASSES_LIGHT_IO_H

#include "passes/brdf/brdf.h"

MYRIAD_BEGIN
const uint light_point = 0u, light_spot = 1u, light_directional = 2u;  // as scenes::Light::Type
const uint light_triangle = 3u;                                        // an emissive triangle

// 64 bytes. The punctual lights come first, then the emissive triangles.
struct Light {
    vec3 position;       // point, spot; directional: the low corner of the scene's bounds
    uint type;
    vec3 direction;      // spot, directional: the way the light travels, unit
    float cdf;           // share of this light and all before it, by power where nothing else is said; the last is 1
    vec3 intensity;      // W/sr (point, spot), W/m^2 (directional), radiance (triangle; the mean over its texture)
    uint triangle;       // emissive triangle only
    vec3 extent;         // directional: the size of the scene's bounds; x alone: the width of a spot's falloff, a cosine; a point's radius
                         // in metres; the area of a triangle in m^2, both sides counted where it is double-sided
    float cos_outer;     // spot only
};
MYRIAD_ARRAY(Lights, Light, 16)

// An emissive triangle that moves.
struct Emitter {
    uint light;          // in the table
    uint triangle;       // as stored
    float sides;         // that shine
};
MYRIAD_ARRAY(Emitters, Emitter, 4)
MYRIAD_ARRAY(EmitterPositions, vec3, 4)

// "geometry/emitters"
struct EmittersPush {
    Emitters emitters;
    Uint4s triangles;
    EmitterPositions positions;
    Lights lights;
    uint count;
};

// The falloff goes from 0 at cos_outer to 1 at cos_outer + spot_width.
MYRIAD_FN float spot_width(Light light) { return light.extent.x; }

// As KHR_lights_punctual recommends: saturate((cos - cos_outer) / max(0.001, cos_inner - cos_outer))^2.
MYRIAD_FN float spot_falloff(Light light, float cos_angle) {
    const float t = clamp((cos_angle - light.cos_outer) / spot_width(light), 0.0f, 1.0f);
    return t * t;
}

// The integral of the falloff over the sphere, in steradians: 2 pi times that of t^2 over the cosine, the ramp ending at
// a cosine of 1 at the latest.
MYRIAD_FN float spot_solid_angle(Light light) {
    const float width = spot_width(light);
    const float room = 1.0f - light.cos_outer;
    if (room < width) return 2.0f * pi * room * room * room / (3.0f * width * width);
    return 2.0f * pi * (width / 3.0f + (room - width));
}

// What the bounds show to a directional light, in m^2, face by face: x, y, z.
MYRIAD_FN vec3 directional_areas(Light light) {
    const vec3 e = light.extent;
    return abs(light.direction) * vec3(e.y * e.z, e.z * e.x, e.x * e.y);
}

// A punctual light from a point: `irradiance` falls on a plane perpendicular to the unit direction `to_light`.
struct Incident {
    vec3 to_light;
    float distance;      // 1e30: infinitely far
    vec3 irradiance;
};
MYRIAD_FN Incident incident_from(Light light, vec3 p) {
    Incident incident;
    incident.to_light = -light.direction;
    incident.distance = 1e30f;
    incident.irradiance = light.intensity;
    if (light.type == light_directional) return incident;
    const vec3 d = light.position - p;
    const float squared = dot(d, d);
    if (!(squared > 1e-24f)) {           // in the light itself there is no direction
        incident.irradiance = vec3(0.0f);
        return incident;
    }
    incident.distance = sqrt(squared);
    incident.to_light = d / incident.distance;
    const float radius = light.type == light_point ? light.extent.x : 0.0f;  // within it, light grows no more
    incident.irradiance = light.intensity / max(squared, radius * radius);
    if (light.type == light_spot) incident.irradiance *= spot_falloff(light, -dot(incident.to_light, light.direction));
    return incident;
}
MYRIAD_END

#ifdef __cplusplus
static_assert(sizeof(myriad::Light) == 64 && sizeof(myriad::EmittersPush) <= 128);
#endif

#endif
