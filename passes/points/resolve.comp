#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a pixel: the point of a triangle that it sees. From a node of the cut down to the leaf that is nearest to the pixel's ray, and
// from there to where the ray meets the leaf's triangle, or to the triangle's rim.
#include "engine/kernel.glsl"
#include "compute/raytrace/raytrace_io.h"
#include "passes/points/points.glsl"
layout(push_constant, scalar) uniform Push { PointsResolvePush push; };

void main() {
    const uint pixel = thread_index();
    if (pixel >= push.width * push.height) return;
    const uint seen = push.pixels.at[push.width * push.height + pixel];
    if (seen == ~0u) {
        push.hits.at[pixel] = RayHitRecord(0.0, ~0u, 0.0, 0.0, 0u);
        return;
    }
    const float x = float(pixel % push.width), y = float(pixel / push.width);
    const vec3 w = points_ray(push.camera, x, y, push.width, push.height);
    PointsScene scene = push.scene.at[0];
    uint triangle = seen;
    if ((seen & points_inner) != 0u) triangle = scene.samples.at[points_leaf_below(push.tree, seen & ~points_inner, push.camera.position, w)].triangle;
    const Corners at = points_corners(scene, triangle, push.camera.position);
    const PointsCell cell = points_cell(push.camera, at, vec2(0.0), vec2(1.0, 0.0), vec2(0.0, 1.0), push.width, push.height);
    const PointsHit hit = points_on(cell, x, y);
    const vec2 held = points_hold(hit.b, hit.c);
    push.hits.at[pixel] = RayHitRecord(uintBitsToFloat(push.pixels.at[pixel]) * sqrt(dot(w, w)), triangle, held.x, held.y,
                                       points_at(cell.d, x, y) > 0.0 ? 1u : 0u);
}
