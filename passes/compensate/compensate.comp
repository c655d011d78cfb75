#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a pixel: a short ray by cosine, and the light that leaves where it ends, as far as the bound cuts it off. Lanes stay together for
// the rays; who has nothing to ask takes an empty one along.
#include "engine/kernel.glsl"
#include "passes/compensate/compensate_io.h"
layout(constant_id = glossy_constant) const bool glossy = false;
layout(push_constant, scalar) uniform Push { CompensatePush push; };
#include "compute/raytrace/trace.glsl"
#include "passes/geometry/surface.glsl"
#include "passes/vpl/vpl_sampling.h"

float share_end(uint light) { return push.lights.at[light].cdf; }
#include "passes/vpl/choose_light.glsl"

// A pair of dimensions apart for each choice on a path: three a vertex.
uint index_, seed_;
vec2 choice(uint vertex, uint which) { return path_bounce_point(index_, 3u * vertex + which, seed_); }

// Where nothing is met, it is some surface all the same: rays that do not ask have numbers, too.
Surface surface_met(RayHit hit, bool asks, vec3 direction) {
    return face_towards(surface_at(push.geometry, asks ? hit.triangle : 0u, asks ? hit.u : 0.0, asks ? hit.v : 0.0), direction);
}

// Irradiance on y, over pi, of one light that is chosen by its share; 0 for who does not ask.
vec3 light_on(Surface y, bool asks, uint vertex) {
    const float selection = min(choice(vertex, 1u).x, 0.99999994);
    const uint chosen = light_for(selection, push.light_count);
    const Light light = push.lights.at[chosen];
    const float share = light.cdf - (chosen > 0u ? share_end(chosen - 1u) : 0.0);
    const vec3 origin = ray_origin(y.position, y.geometric_normal, y.reach);
    vec3 way;           // to the light, in units of `far`
    float far = 1.0;
    vec3 across;        // irradiance on a plane across the way
    if (light.type == light_triangle) {
        const vec2 place = triangle_point(choice(vertex, 2u));
        Surface s = surface_at(push.geometry, light.triangle, place.x, place.y);
        s = face_towards(s, unit_or(s.position - y.position, y.geometric_normal));
        way = ray_origin(s.position, s.geometric_normal, s.reach) - origin;
        const float squared = dot(way, way);
        const float cosine = squared > 1e-24 ? max(-dot(s.geometric_normal, way), 0.0) / sqrt(squared) : 0.0;
        const float area = light.extent.x * (s.double_sided ? 0.5 : 1.0);
        across = s.emission * (area * cosine / max(squared, 1e-24));
        if (trace_asks && !opacity_is_there(push.bvh.opacity, light.triangle, place.x, place.y, trace_dice)) across = vec3(0.0);
    } else {
        const Incident incident = incident_from(light, y.position);
        way = incident.to_light;
        far = 0.9999 * incident.distance;  // as passes/direct: a lamp that touches a surface is not hidden by it
        across = incident.irradiance;
    }
    const float cosine = dot(y.geometric_normal, way) * inversesqrt(max(dot(way, way), 1e-30));
    asks = asks && cosine > 0.0 && any(greaterThan(across, vec3(0.0)));
    const bool hidden = trace_occluded(push.bvh, origin, way, 0.0, asks ? far : -1.0);
    return asks && !hidden ? across * (cosine / (pi * share)) : vec3(0.0);
}

void main() {
    const uint pixels = push.gbuffer.width * push.gbuffer.height;
    const uint pixel = min(thread_index(), pixels - 1u);
    const vec4 position = push.gbuffer.positions.at[pixel];
    const bool receives = thread_index() < pixels && position.w > 0.0;
    const uint x = pixel % push.gbuffer.width, y = pixel / push.gbuffer.width;
    const uint ray = compensate_ray(push.counts);
    index_ = compensate_index(x, y, ray);
    seed_ = compensate_seed(x, y, push.seed);
    const uvec2 packed = push.gbuffer.normals.at[pixel];
    const vec3 n = unpack_direction(packed.x);
    const vec3 n_g = unpack_direction(packed.y);
    vec3 direction = cosine_direction(choice(0u, 0u), n);
    const bool above = dot(direction, n_g) > 0.0;
    RayHit hit = trace_closest(push.bvh, ray_origin(position.xyz, n_g, push.gbuffer.albedo.at[pixel].w), direction, 0.0,
                               receives && above ? compensate_reach(push.bound) : -1.0);
    bool asks = receives && above && hit.triangle != no_triangle;
    Surface s = surface_met(hit, asks, direction);
    float share = 0.0;
    if (asks) share = compensate_share(dot(n, direction), -dot(s.geometric_normal, direction), hit.t, push.bound);
    asks = asks && share > 0.0;
    vec3 radiance = asks ? s.emission : vec3(0.0);
    vec3 carried = s.albedo;
    for (uint bounce = 1u; bounce <= compensate_bounces(push.counts); ++bounce) {
        radiance += carried * light_on(s, asks, bounce);
        if (bounce == compensate_bounces(push.counts)) break;
        const vec3 on = cosine_direction(choice(bounce, 0u), s.geometric_normal);
        hit = trace_closest(push.bvh, ray_origin(s.position, s.geometric_normal, s.reach), on, 0.0, asks ? 1e30 : -1.0);
        asks = asks && hit.triangle != no_triangle;
        s = surface_met(hit, asks, on);
        carried *= s.albedo;
    }
    if (trace_exhausted) push.exhausted.at[0] = 1u;
    if (thread_index() >= pixels) return;
    Lobe lobe = matte_lobe();
    if (glossy) lobe = lobe_of(push.gbuffer.gloss.at[pixel], n);
    const vec3 mean = radiance * (pi * share * reflectance_of(lobe, n, direction, 0.0).diffuse / float(compensate_rays(push.counts)));
    const vec3 before = ray == 0u ? vec3(0.0) : push.irradiance.at[pixel].xyz;
    push.irradiance.at[pixel] = vec4(receives ? min(before + mean, vec3(compensate_most)) : vec3(0.0), 0.0);
}
