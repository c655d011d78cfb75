// What the gather kernels, their host and their twin share.
#ifndef MYRIAD_PASSES_GATHER_IO_H
#define MYRIAD_PASSES_GATHER_IO_H

#include "compute/views/paraboloid.h"
#include "compute/views/parallel.h"
#include "passes/fuse/shared_map.h"
#include "passes/gbuffer/gbuffer_io.h"
#include "passes/vpl/vpl_io.h"

MYRIAD_BEGIN
struct GatherPush {
    GBufferRef gbuffer;
    Vpls vpls;
    Uints count;              // how many VPLs there are
    Uints atlas;              // maps only: of VPLs [first_map, …)
    Uints failed;             // maps only, may be null: failed.at[0] != 0 says that the atlas is not complete, and nothing is added
    Views views;              // maps of far lights only: of all of them
    Float4s irradiance;       // glossy: then, pixel by pixel, what lobes reflect of the same light (radiance)
    uint first, limit;        // VPLs [first, min(first + limit, count)); first is a multiple of block^2
    uint sides;               // gather_sides
    uint first_map;           // maps only
    float bound;              // 1/m^2
    float bias;               // maps only, texels
    SharedMapArray asked;     // by map; where maps lack what their views share
    Uints listed;             // where VPLs are not in the order of their sets: set << gather_listed_bits | index of a VPL, in ascending order
};
// Specialisation constant: VPLs are listed.
const uint gather_listed_constant = 23u;
const uint gather_listed_bits = 20u;
// Specialisation constant: lights are omni_light()s.
const uint gather_omni_constant = 24u;
// Specialisation constant: maps lack what their views share.
const uint gather_asks_constant = 25u;

// k: sets of VPLs, and pixels of a block, are k x k; texels a side of a half map; and whether `failed` is given.
MYRIAD_FN uint gather_sides(uint block, uint map_size, bool has_failed) { return block | (has_failed ? 0x8000u : 0u) | (map_size << 16); }
MYRIAD_FN uint gather_block_of(uint sides) { return sides & 0x7fffu; }
MYRIAD_FN uint gather_map_size_of(uint sides) { return sides >> 16; }
MYRIAD_FN bool gather_may_fail(uint sides) { return (sides & 0x8000u) != 0u; }

// "rays": the same, with a BVH in place of the atlas.
struct GatherRaysPush {
    GBufferRef gbuffer;
    Vpls vpls;
    Uints count;
    Float4s irradiance;
    BvhRef bvh;               // with reach
    Uints status;             // status.at[0] is set when a traversal ran out of its loop budget
    uint first, limit, block;
    float bound;
};

// The part of the transfer that needs no visibility; all 0 where either side faces away. A VPL's flux / pi times `diffuse` is what
// counts as irradiance, and times brdf_fresnel(f0, power) * glossy it is radiance that the lobe reflects.
struct Transfer {
    float diffuse;            // 1/m^2
    float glossy;             // 1/(m^2 sr)
    float power;
};
// x is the receiver's position, n its normal.
MYRIAD_FN Transfer transfer_of(vec3 x, vec3 n, Lobe lobe, vec3 vpl_position, vec3 vpl_normal, float bound) {
    Transfer t;
    t.diffuse = 0.0f;
    t.glossy = 0.0f;
    t.power = 0.0f;
    const vec3 d = vpl_position - x;
    const float d2 = dot(d, d);
    const float cos_receiver = dot(n, d);        // times |d|
    const float cos_vpl = -dot(vpl_normal, d);   // times |d|
    if (!(d2 > 0.0f && cos_receiver > 0.0f && cos_vpl > 0.0f)) return t;
    // Divided one by one: d^4 would leave the range of floats at distances that are still fine.
    const float g = (cos_receiver / d2) * (cos_vpl / d2);
    t.diffuse = min(g, bound);
    if (lobe.alpha2 == 0.0f) return t;
    // The VPL stands for a patch, a disc of area pi / bound. Seen under a radius of 1 / sqrt(bound d^2), it moves the half-way vector by
    // half of that, and its neighbours as much again: so wide the lobe must be at least, or it would show VPLs and not what they stand for.
    const Reflectance r = reflectance_of(lobe, n, d / sqrt(d2), 1.0f / (bound * d2));
    t.diffuse *= r.diffuse;
    // A patch of radiance F / (pi a) is reflected as brightly at most: flux / pi * glossy <= F / (pi a), with a = pi / bound.
    t.glossy = min(r.glossy * g, bound * (1.0f / pi));
    t.power = r.power;
    return t;
}

// Likewise of a far light: flux / pi is its irradiance. n_g is the receiver's geometric normal: light from behind the surface does not come
// through, whatever the shading normal says.
MYRIAD_FN Transfer far_transfer(vec3 n, vec3 n_g, Lobe lobe, Vpl light) {
    Transfer t;
    t.diffuse = 0.0f;
    t.glossy = 0.0f;
    t.power = 0.0f;
    const vec3 to_light = far_direction(light);
    const float cosine = dot(n, to_light);
    if (!(cosine > 0.0f && dot(n_g, to_light) > 0.0f)) return t;
    t.diffuse = cosine;
    if (lobe.alpha2 == 0.0f) return t;
    // As transfer_of: the light stands for a part of the sky, a disc of radius sqrt(solid angle / pi), which widens the lobe, and is
    // reflected no brighter than it is: irradiance * glossy <= irradiance / solid angle.
    const float solid_angle = far_solid_angle(light);
    const Reflectance r = reflectance_of(lobe, n, to_light, solid_angle * (1.0f / pi));
    t.diffuse *= r.diffuse;
    t.glossy = min(r.glossy * cosine, 1.0f / max(solid_angle, 1e-30f));
    t.power = r.power;
    return t;
}

// Likewise of a light that shines alike in all directions: flux / pi is its intensity. Like far light it does not come through the surface from behind.
MYRIAD_FN Transfer omni_transfer(vec3 x, vec3 n, vec3 n_g, Lobe lobe, Vpl light) {
    Transfer t;
    t.diffuse = 0.0f;
    t.glossy = 0.0f;
    t.power = 0.0f;
    const vec3 d = light.position - x;
    const float d2 = dot(d, d);
    const float cosine = dot(n, d);  // times |d|
    if (!(d2 > 1e-24f && cosine > 0.0f && dot(n_g, d) > 0.0f)) return t;  // in the light itself there is no direction
    // What it stands for is a ball: on its surface irradiance is intensity / radius^2, and no more than that where a receiver is inside.
    const float radius = omni_radius(light);
    const float bound = 1.0f / max(radius * radius, 1e-24f);
    const float g = min(1.0f / d2, bound) * (cosine / sqrt(d2));
    t.diffuse = g;
    if (lobe.alpha2 == 0.0f) return t;
    // As transfer_of: the ball widens the lobe, and is reflected no brighter than it is: intensity * glossy <= intensity / (pi radius^2).
    const Reflectance r = reflectance_of(lobe, n, d / sqrt(d2), min(radius * radius / d2, 1.0f));
    t.diffuse *= r.diffuse;
    t.glossy = min(r.glossy * g, bound * (1.0f / pi));
    t.power = r.power;
    return t;
}

// Irradiance that a VPL brings: flux * (diffuse * gather_scale). Scaled VPL by VPL, so that a sum may be continued.
MYRIAD_FN float gather_scale(uint block) { return float(block * block) / pi; }
// No pixel gets more, so that later sums stay finite whatever the flux (W/m^2; the sun brings 1e3); of radiance neither.
const float gather_most = 1e30f;

// How a VPL at `vpl_position` looks for the receiver x with geometric normal n_g in its map: four texels around x's direction,
// each asked whether it hides x, and their answers weighted bilinearly (percentage-closer filtering, Reeves et al. 1987). One texel
// alone would end shadows in steps as large as a texel's footprint.
struct MapQuery {
    vec3 n_g;
    float distance, along;    // |d| and d . n_g, with d = x - vpl_position
    float bias;               // metres
    uint half_index;
    int x, y;                 // the first texel: -1 at the border, where texels are repeated
    vec2 weight;              // of the second texel along u, and along v
};
// The whole part of t >= -0.5; what is not a number, of a receiver in the VPL itself, becomes some texel, too.
MYRIAD_FN int map_first(float t, uint size) { return t >= 0.0f ? int(min(t, float(size - 1u))) : -1; }
MYRIAD_FN MapQuery map_query(vec3 x, vec3 n_g, vec3 vpl_position, uint size, float bias) {
    const vec3 d = x - vpl_position;
    const vec2 uv = project(d);
    const vec2 texel = (uv + vec2(1.0f, 1.0f)) * (0.5f * float(size)) - vec2(0.5f, 0.5f);
    MapQuery q;
    q.n_g = n_g;
    q.distance = sqrt(dot(d, d));
    q.along = dot(d, n_g);
    q.bias = bias * q.distance * texel_angle(uv, size);
    q.half_index = half_of(d);
    q.x = map_first(texel.x, size);
    q.y = map_first(texel.y, size);
    q.weight = texel - vec2(float(q.x), float(q.y));
    return q;
}

// One of the four texels, right = 0 or 1, below = 0 or 1, and the distance up to which a surface in it hides x (metres).
struct MapTexel {
    uint index;
    float distance;
};
MYRIAD_FN MapTexel map_texel(MapQuery q, int right, int below, uint size) {
    const uint tx = uint(clamp(q.x + right, 0, int(size) - 1));
    const uint ty = uint(clamp(q.y + below, 0, int(size) - 1));
    // Where the texel's ray meets the receiver's plane; only nearer than the receiver itself counts, since elsewhere another
    // surface may have taken over.
    const float on_plane = q.along / dot(unproject(q.half_index, texel_middle(tx, ty, size)), q.n_g);
    MapTexel t;
    t.index = texel_index(q.half_index, tx, ty, size);
    t.distance = (on_plane > 0.0f && on_plane < q.distance ? on_plane : q.distance) - q.bias;
    return t;
}
// And the direction to its middle.
MYRIAD_FN vec3 map_texel_towards(MapQuery q, int right, int below, uint size) {
    return unproject(q.half_index, texel_middle(uint(clamp(q.x + right, 0, int(size) - 1)), uint(clamp(q.y + below, 0, int(size) - 1)), size));
}
MYRIAD_FN float map_seen(float stored_depth, MapTexel t) { return stored_depth < t.distance ? 0.0f : 1.0f; }
// The share of x that is seen, of the four answers in the order of rows.
MYRIAD_FN float map_blend(MapQuery q, vec4 seen) {
    const float above = mix(seen.x, seen.y, q.weight.x);
    const float below = mix(seen.z, seen.w, q.weight.x);
    return mix(above, below, q.weight.y);
}

// The same for the map of a far light, which is that of a parallel view: the plane's depth changes evenly from texel to texel.
struct ParallelQuery {
    float depth, across, down;  // metres: of x; how much deeper its plane is a texel further on
    float bias;
    uint columns, rows;
    int x, y;
    vec2 weight;                // as MapQuery; (x + weight.x, y + weight.y) is where x lies
};
MYRIAD_FN ParallelQuery parallel_query(vec3 x, vec3 n_g, View view, uint size, float bias) {
    const vec3 d = x - view.position;
    const ParallelFrame frame = parallel_frame(view.direction);
    const float texel = parallel_texel(view, size);
    const vec2 place = parallel_place(view, frame, d, size) - vec2(0.5f, 0.5f);
    const float slope = -texel / dot(view.direction, n_g);
    ParallelQuery q;
    q.columns = parallel_columns(view);
    q.rows = parallel_rows(view, size);
    q.depth = dot(d, view.direction);
    q.across = slope * dot(frame.across, n_g);
    q.down = slope * dot(frame.down, n_g);
    q.bias = bias * 0.70710678f * texel;
    q.x = map_first(place.x, q.columns);
    q.y = map_first(place.y, q.rows);
    q.weight = clamp(place - vec2(float(q.x), float(q.y)), vec2(0.0f), vec2(1.0f));
    return q;
}
MYRIAD_FN MapTexel parallel_map_texel(ParallelQuery q, int right, int below) {
    const int tx = clamp(q.x + right, 0, int(q.columns) - 1);
    const int ty = clamp(q.y + below, 0, int(q.rows) - 1);
    const float on_plane = q.depth + (float(tx - q.x) - q.weight.x) * q.across + (float(ty - q.y) - q.weight.y) * q.down;
    MapTexel t;
    t.index = uint(ty) * q.columns + uint(tx);
    t.distance = (on_plane > 0.0f && on_plane < q.depth ? on_plane : q.depth) - q.bias;
    return t;
}
MYRIAD_FN float parallel_blend(ParallelQuery q, vec4 seen) {
    return mix(mix(seen.x, seen.y, q.weight.x), mix(seen.z, seen.w, q.weight.x), q.weight.y);
}

// Which pixel a thread works on, so that the threads of a workgroup share their set: sets are laid out one after the other, each
// in whole workgroups. `set` is uniform over the workgroup.
struct GatherPixel {
    uint x, y, set;
    bool inside;
};
MYRIAD_FN uint gather_groups_a_set(uint width, uint height, uint block, uint workgroup_size) {
    const uint columns = (width + block - 1u) / block;
    const uint rows = (height + block - 1u) / block;
    return (columns * rows + workgroup_size - 1u) / workgroup_size;
}
MYRIAD_FN GatherPixel gather_pixel(uint workgroup, uint lane, uint workgroup_size, uint width, uint height, uint block) {
    const uint groups = gather_groups_a_set(width, height, block, workgroup_size);
    const uint columns = (width + block - 1u) / block;
    const uint index = (workgroup % groups) * workgroup_size + lane;
    GatherPixel p;
    p.set = workgroup / groups;
    p.x = (index % columns) * block + p.set % block;
    p.y = (index / columns) * block + p.set / block;
    p.inside = p.set < block * block && p.x < width && p.y < height;
    return p;
}
MYRIAD_END

#endif
