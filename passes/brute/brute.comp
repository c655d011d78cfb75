#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a triangle, which it holds in registers while it goes through a slice of the views. In each view it asks the triangle's
// sphere first, whose disc most often holds no texel's middle; then it finds the bound of the triangle's texels. A few texels are the invocation's own work; those of a larger triangle are
// shared by the group, for else seven lanes would wait for the one with a wall.
#include "engine/group.glsl"
#include "compute/instances/instances.glsl"
#include "compute/opacity/opacity.glsl"
#include "passes/brute/brute_io.h"
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_EXT_buffer_reference_uvec2 : require

layout(constant_id = 2) const bool solid = true;       // surfaces have no holes and do not blend
layout(constant_id = 3) const uint own_texels = 16u;   // the most that an invocation draws by itself
layout(push_constant, scalar) uniform Push { BrutePush push; };

bool group_any(bool b) { return plain_groups ? b : subgroupAny(b); }
uvec4 group_ballot(bool b) { return plain_groups ? uvec4(b ? 1u : 0u, 0u, 0u, 0u) : subgroupBallot(b); }
vec3 group_of(vec3 v, uint lane) { return plain_groups ? v : subgroupBroadcast(v, lane); }
uvec4 group_of(uvec4 v, uint lane) { return plain_groups ? v : subgroupBroadcast(v, lane); }
uint group_of(uint v, uint lane) { return plain_groups ? v : subgroupBroadcast(v, lane); }

// Lanes read a word each and tell the others: all of them reading all eight would cost as much as half of what follows.
View view_of(uint i) {
    if (plain_groups || gl_SubgroupSize < 8u) return push.views.at[i];
    const float word = Floats(uvec2(push.views)).at[8u * i + (gl_SubgroupInvocationID & 7u)];
    View v;
    v.position = vec3(subgroupBroadcast(word, 0u), subgroupBroadcast(word, 1u), subgroupBroadcast(word, 2u));
    v.cos_phi = subgroupBroadcast(word, 3u);
    v.direction = vec3(subgroupBroadcast(word, 4u), subgroupBroadcast(word, 5u), subgroupBroadcast(word, 6u));
    v.sin_phi = subgroupBroadcast(word, 7u);
    return v;
}

void texel(BruteTriangle t, BruteEdges e, uint half_index, uint x, uint y, uint id, uint view, uint map) {
    const BruteHit hit = brute_hit(t, e, half_index, texel_middle(x, y, push.map_size), push.map_size);
    if (!(hit.depth > 0.0)) return;
    if (!solid && !opacity_in_view(opacity_missing_at(push.opacity, id, hit.u, hit.v), view)) return;
    atomicMin(push.atlas.at[map + texel_index(half_index, x, y, push.map_size)], floatBitsToUint(hit.depth));
}

void draw(bool seen, uint half_index, Corners p, BruteTriangle t, uint id, uint view, vec3 from, uint map) {
    const BruteBounds bounds = brute_bounds(half_index, t);
    BruteBox box = brute_box(bounds, push.map_size);
    if (bounds.wide && seen) box = brute_box(brute_wide_bounds(half_index, t, brute_edges(p, t)), push.map_size);
    const uint texels = seen ? brute_texels(box) : 0u;
    if (!group_any(texels > 0u)) return;

    if (texels > 0u && texels <= own_texels) {
        const BruteEdges e = brute_edges(p, t);
        uint x = box.x0;
        for (uint y = box.y0; y < box.y1;) {
            texel(t, e, half_index, x, y, id, view, map);
            if (++x == box.x1) {
                x = box.x0;
                ++y;
            }
        }
    }

    uvec4 large = group_ballot(texels > own_texels);
    for (uint word = 0u; word < 4u; ++word)
        for (uint left = large[word]; left != 0u; left &= left - 1u) {
            const uint lane = 32u * word + findLSB(left);
            const Corners its = Corners(group_of(p.p0, lane), group_of(p.p1, lane), group_of(p.p2, lane));
            const uvec4 at = group_of(uvec4(box.x0, box.y0, box.x1, box.y1), lane);
            const uint its_half = group_of(half_index, lane), its_id = group_of(id, lane);
            const BruteTriangle its_t = brute_around(from, its);
            const BruteEdges e = brute_edges(its, its_t);
            const uint width = at.z - at.x, n = width * (at.w - at.y);
            for (uint i = group_lane(); i < n; i += group_size()) {
                const uint row = uint((float(i) + 0.5) / float(width));  // exact below 2^20 texels
                texel(its_t, e, its_half, at.x + i - row * width, at.y + row, its_id, view, map);
            }
        }
}

void main() {
    const uint slice = push.first_slice + workgroup_index() / push.groups_a_slice;
    const uint id = (workgroup_index() % push.groups_a_slice) * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    const uint end = min(push.first_view + push.limit, push.count.at[0]);
    const bool exists = id < push.triangles;
    GeometryArrays g = push.geometry.at[0];
    Corners p = Corners(vec3(0.0), vec3(0.0), vec3(0.0));
    if (exists) p = world_corners(g.instances, g.instance_count, g.triangles, Positions(g.positions), id);
    const Sphere sphere = brute_sphere(p);
    for (uint i = push.first_view + slice * push.slice, last = min(i + push.slice, end); i < last; ++i) {
        const View view = view_of(i);
        const vec3 d = sphere.center - view.position;
        const uint near = half_of(d);
        bool in_near = exists && !outside_frustum(view, d, sphere.radius);
        bool in_far = in_near && brute_in_both(d, sphere.radius, push.map_size);
        in_near = in_near && !brute_misses(near, d, sphere.radius, push.map_size);
        in_far = in_far && !brute_misses(1u - near, d, sphere.radius, push.map_size);
        if (!group_any(in_near || in_far)) continue;
        const BruteTriangle t = brute_around(view.position, p);
        const bool seen = !brute_outside(view, t, sphere);
        const uint map = (i - push.first_view) * map_texels(push.map_size);
        if (group_any(in_near && seen)) draw(in_near && seen, near, p, t, id, i, view.position, map);
        if (group_any(in_far && seen)) draw(in_far && seen, 1u - near, p, t, id, i, view.position, map);
    }
}
