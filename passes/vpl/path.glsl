// What the kernels that extend light paths have in common. Include it after declaring `push`, whose `on` is a VplPaths.
#include "compute/raytrace/trace.glsl"
#include "passes/geometry/surface.glsl"
#include "passes/vpl/vpl_sampling.h"

// Leaves a VPL of this flux on the side of the surface that its normal is on; nothing where there is no flux. The
// geometric normal is what the VPL keeps: its hemisphere is then the one that its map covers and that light can reach,
// and no path goes on behind the surface.
void leave_vpl(uint layer, uint path, Surface s, vec3 flux, uint bounce) {
    if (!(max(flux.x, max(flux.y, flux.z)) > 0.0)) return;
    const uint slot = layer * push.on.paths + path;
    push.on.slots.at[slot] = Vpl(ray_origin(s.position, s.geometric_normal, s.reach), pack_direction(s.geometric_normal), flux, bounce);
    push.on.alive.at[slot] = 1u;
}

// Follows a ray to the surface that reflects it.
void follow_ray(uint path, vec3 origin, vec3 direction, vec3 flux, uint bounce) {
    const RayHit hit = trace_closest(push.on.bvh, origin, direction, 0.0, 1e30);
    if (trace_exhausted) push.on.exhausted.at[0] = 1u;
    if (hit.triangle == no_triangle) return;
    const Surface s = face_towards(surface_at(push.on.geometry, hit.triangle, hit.u, hit.v), direction);
    leave_vpl(push.on.layer, path, s, flux * s.albedo, bounce);
}
