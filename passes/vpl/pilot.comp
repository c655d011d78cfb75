#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a pilot path: from a place in its cell to the surface, and on from there by cosine. Tallies are sums of
// integers, so they do not depend on the order. A walk that runs out of its loop budget counts as a miss: whatever the
// tallies say, light paths stay unbiased. Lanes stay together for the rays: those of a cell go the same way.
#include "engine/kernel.glsl"
#include "passes/vpl/vpl_io.h"
layout(push_constant, scalar) uniform Push { VplPilotPush push; };
#include "compute/raytrace/trace.glsl"
#include "passes/geometry/surface.glsl"
#include "passes/vpl/vpl_sampling.h"

bool shines(vec3 flux) { return max(flux.x, max(flux.y, flux.z)) > 0.0; }

void main() {
    const uint path = min(thread_index(), push.paths - 1u);
    const uint cell = path / push.samples;
    const uvec2 place = uvec2(cell % guide_cells / guide_side, cell % guide_side);
    const vec2 x = (vec2(place) + path_emission_point(path, push.seed).xy) / float(guide_side);
    Emission e = emit_punctual(push.lights.at[cell / guide_cells], x);
    bool alive = thread_index() < push.paths && shines(e.flux);
    if (!alive) e = Emission(vec3(0.0), vec3(0.0, 0.0, 1.0), vec3(0.0));

    RayHit hit = trace_closest(push.bvh, e.origin, e.direction, 0.0, alive ? 1e30 : -1.0);
    alive = alive && hit.triangle != no_triangle;
    vec3 origin = vec3(0.0);
    vec3 direction = vec3(0.0, 0.0, 1.0);
    if (alive) {
        const Surface s = face_towards(surface_at(push.geometry, hit.triangle, hit.u, hit.v), e.direction);
        e.flux *= s.albedo;
        alive = shines(e.flux);
        origin = ray_origin(s.position, s.geometric_normal, s.reach);
        direction = cosine_direction(path_bounce_point(path, 1u, push.seed), s.geometric_normal);
    }
    if (alive) atomicAdd(push.tallies.at[cell].first, 1u);

    hit = trace_closest(push.bvh, origin, direction, 0.0, alive ? 1e30 : -1.0);
    if (!alive || hit.triangle == no_triangle) return;
    const Surface s = surface_at(push.geometry, hit.triangle, hit.u, hit.v);
    if (shines(e.flux * s.albedo)) atomicAdd(push.tallies.at[cell].second, 1u);
}
