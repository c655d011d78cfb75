// A view, its map, and the exact geometry of spheres in it (spec, sections 1 and 2).
//
// Every map has the same global orientation: the axis is +x. A direction d goes to (u, v) = (d.y, d.z) / (1 + |d.x|), in
// the front half where d.x >= 0 and in the back half elsewhere; both halves fill the unit disc. This is the stereographic
// projection, which maps circles to circles: the footprint of a sphere is an exact disc.
#ifndef MYRIAD_COMPUTE_VIEW_IO_H
#define MYRIAD_COMPUTE_VIEW_IO_H

#include "engine/shared.h"

MYRIAD_BEGIN
// 32 bytes, two 16-byte loads. The frustum is the cone of half-angle phi around `direction` with its apex in `position`:
// phi = pi/2 for a VPL, pi for an omnidirectional light, which sees everything.
struct View {
    vec3 position;
    float cos_phi;
    vec3 direction;  // unit
    float sin_phi;
};
MYRIAD_ARRAY(Views, View, 16)

// A view that sees nothing: a hemisphere that looks away from everything, from far beyond what scenes may hold (1e9 m). The root is
// culled, so its cut costs one node-view, and its map stays clear.
MYRIAD_FN View view_of_nothing() {
    View view;
    view.position = vec3(1e15f, 0.0f, 0.0f);
    view.cos_phi = 0.0f;
    view.direction = vec3(1.0f, 0.0f, 0.0f);
    view.sin_phi = 1.0f;
    return view;
}

// A sphere around a node, in world space.
struct Sphere {
    vec3 center;
    float radius;
};
MYRIAD_ARRAY(Spheres, Sphere, 16)

// Texels: a map is two halves, front then back, each `size` x `size` texels over [-1, 1]^2, row after row.
MYRIAD_FN uint map_texels(uint size) { return 2u * size * size; }
MYRIAD_END

#endif
