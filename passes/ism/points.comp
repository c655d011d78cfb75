#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a sample: where it stands.
#include "engine/kernel.glsl"
#include "compute/instances/instances.glsl"
#include "compute/opacity/opacity.glsl"
#include "passes/ism/ism_io.h"
layout(constant_id = 2) const bool blends = false;  // some surface does
layout(push_constant, scalar) uniform Push { IsmPointsPush push; };

void main() {
    const uint i = thread_index();
    if (i >= push.count) return;
    const SurfaceSample s = push.samples.at[i];
    GeometryArrays g = push.geometry.at[0];
    const Corners c = world_corners(g.instances, g.instance_count, g.triangles, Positions(g.positions), s.triangle);
    push.points.at[i] = ism_point(c, s.u, s.v, blends ? opacity_missing_at(push.opacity, s.triangle, s.u, s.v) : 0u);
}
