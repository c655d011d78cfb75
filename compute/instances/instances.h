// Where a mesh stands whose triangles are stored once for all its instances; see README.md.
#ifndef MYRIAD_COMPUTE_INSTANCES_H
#define MYRIAD_COMPUTE_INSTANCES_H

#include "engine/shared.h"

#ifdef __cplusplus
#define precise
#endif

MYRIAD_BEGIN
const uint instance_in_world = 1u;   // its vertices are stored in world space: the transform is not looked at
const uint instance_mirrored = 2u;   // the determinant is negative: corners are taken as 0, 2, 1

// The specialisation constant of kernels that read triangles of the world: whether there are instances that share them. The
// variant without pays nothing for them.
const uint instanced_constant = 17u;

// 64 bytes. A vertex p of the mesh is at p.x * x + p.y * y + p.z * z + at in the world.
struct Instance {
    vec3 x, y, z, at;
    uint first_id;        // its triangles in the world are first_id + i …
    uint first_triangle;  // … and stored at first_triangle + i
    uint count;           // i < count
    uint flags;
};
MYRIAD_ARRAY(Instances, Instance, 16)

// The order of roundings is that of glm's `to_world * vec4(p, 1)`: host and device, shared or written out, see the same floats.
MYRIAD_FN vec3 instance_point(Instance i, vec3 p) {
    precise const vec3 q = (i.x * p.x + i.y * p.y) + (i.z * p.z + i.at);
    return q;
}

// Along the normal in the world, not unit; not for what is stored in world space. Cofactors, so that there is no division.
MYRIAD_FN vec3 instance_normal(Instance i, vec3 n) {
    const vec3 m = cross(i.y, i.z) * n.x + cross(i.z, i.x) * n.y + cross(i.x, i.y) * n.z;
    return (i.flags & instance_mirrored) != 0u ? -m : m;
}

// Whether a triangle's last two corners change places between what is stored and the world.
MYRIAD_FN bool instance_swaps(Instance i) { return (i.flags & (instance_in_world | instance_mirrored)) == instance_mirrored; }

struct Corners {
    vec3 p0, p1, p2;
};
MYRIAD_ARRAY(Positions, vec3, 4)  // of vertices
// The corners in the world of a stored triangle.
MYRIAD_FN Corners instance_corners(Instance i, Corners c) {
    if ((i.flags & instance_in_world) != 0u) return c;
    const bool mirrored = (i.flags & instance_mirrored) != 0u;
    Corners w;
    w.p0 = instance_point(i, c.p0);
    w.p1 = instance_point(i, mirrored ? c.p2 : c.p1);
    w.p2 = instance_point(i, mirrored ? c.p1 : c.p2);
    return w;
}
MYRIAD_END

#ifdef __cplusplus
#undef precise
static_assert(sizeof(myriad::Instance) == 64);
#endif

#endif
