// What the kernels of point rendering, their host and their twin share.
#ifndef MYRIAD_PASSES_POINTS_IO_H
#define MYRIAD_PASSES_POINTS_IO_H

#include "compute/append/append_io.h"
#include "compute/bsh/bsh_build.h"
#include "compute/manylods/cut_io.h"
#include "compute/opacity/opacity_io.h"
#include "passes/gbuffer/gbuffer_io.h"

MYRIAD_BEGIN
// What leaves are made of. In a buffer of its own, because push constants are short.
struct PointsScene {
    SurfaceSamples samples;  // in leaf order
    Uint4s triangles;
    Positions positions;
    Instances instances;     // where triangles are shared
    OpacityRef opacity;      // where some surface is not everywhere
    Uints first;             // by leaf, and one more: where its cells begin
    Uint4s cells;            // see points_cell_steps
    uint instance_count;
    uint unused;
};
MYRIAD_ARRAY(PointsScenes, PointsScene, 8)

// "points/view": the camera as a view of the node-view kernel.
struct PointsViewPush {
    View view;
    Views views;
    Uints count;
};

// "points/splat", once for depths and once more for the nodes that they belong to.
struct PointsSplatPush {
    CameraPush camera;
    Uint2s groups;
    AppendStates state;      // how many groups; groups of lists that failed are not drawn
    PointsScenes scene;
    Uints pixels;            // depths, points_nothing where there is none; as many triangles or nodes (points_inner), ~0 where there is none; how many nodes were drawn
    BshRef tree;
    uint width, height;
};

// "points/resolve": the point of a triangle that each pixel sees.
struct PointsResolvePush {
    CameraPush camera;
    PointsScenes scene;
    Uints pixels;
    RayHitRecords hits;
    BshRef tree;
    uint width, height;
};

const uint points_nothing = 0x7f800000u;  // +infinity

// The second splat finds whose depth is a pixel's: among those that are as near but for so many units in the last place the lowest number, so that
// it does not matter if a compiler fuses operations in one of the two and not in the other.
const uint points_ulps = 8u;

// ---- Pixels and rays ----
//
// A ray has the direction w = forward + X right + Y up, so that p = eye + t w lies at the depth t. Anything that is linear in w is linear in the
// pixel's column and row: (c, a, b) stands for c + a x + b y.

MYRIAD_FN vec3 points_row(CameraPush camera, vec3 by, uint width, uint height) {
    const float a = dot(by, camera.right) * (2.0f / float(width));
    const float b = -dot(by, camera.up) * (2.0f / float(height));
    return vec3(dot(by, camera.forward) - dot(by, camera.right) + dot(by, camera.up) + 0.5f * (a + b), a, b);
}
MYRIAD_FN float points_at(vec3 row, float x, float y) {
    MYRIAD_PRECISE const float value = row.x + row.y * x + row.z * y;
    return value;
}
MYRIAD_FN vec3 points_ray(CameraPush camera, float x, float y, uint width, uint height) {
    const float across = 2.0f * (x + 0.5f) / float(width) - 1.0f;
    const float upward = 1.0f - 2.0f * (y + 0.5f) / float(height);
    return camera.forward + across * camera.right + upward * camera.up;
}

// The pixels whose middles a disc may cover: columns [x0, x1), rows [y0, y1); none where x0 = x1.
struct PointsRect {
    uint x0, x1, y0, y1;
};

// Where lines of sight s = x / z touch a disc along one axis of the image. With the disc's middle at (x, z), and its unit normal's
// parts (n_x, n_z) on that axis and on the camera's, they satisfy (x - s z)^2 = r^2 ((1 + s^2) - (n_x - s n_z)^2). A normal of 0
// makes it a sphere. `whole`: it reaches the plane through the eye, and there is no bound.
struct PointsSpan {
    float low, high;
    bool whole;
};
MYRIAD_FN PointsSpan points_span(float x, float z, float nx, float nz, float r) {
    PointsSpan span;
    const float a = z * z - r * r * (1.0f - nz * nz);
    const float b = x * z + r * r * nx * nz;
    const float c = x * x - r * r * (1.0f - nx * nx);
    const float root = sqrt(max(b * b - a * c, 0.0f));
    span.whole = !(z > 0.0f) || !(a > 1e-6f * z * z);
    span.low = span.whole ? 0.0f : (b - root) / a;
    span.high = span.whole ? 0.0f : (b + root) / a;
    return span;
}
// Of `count` pixels along an axis where s = tangent (2 (i + 1/2) / count - 1): the first whose middle is not below, and one past the last that is not
// above, with a hundredth of a pixel for what rounding may have cost.
MYRIAD_FN uint points_first(float s, float tangent, uint count) {
    return uint(clamp(-floor(0.51f - 0.5f * float(count) * (s / tangent + 1.0f)), 0.0f, float(count)));
}
MYRIAD_FN uint points_end(float s, float tangent, uint count) {
    return uint(clamp(floor(0.5f * float(count) * (s / tangent + 1.0f) + 0.51f), 0.0f, float(count)));
}
// Of a disc around `d` from the eye. `normal` 0: of a sphere.
MYRIAD_FN PointsRect points_rect(CameraPush camera, vec3 d, float r, vec3 normal, uint width, uint height) {
    const float tan_x = sqrt(dot(camera.right, camera.right));
    const float tan_y = sqrt(dot(camera.up, camera.up));
    const float z = dot(d, camera.forward);
    const float nz = dot(normal, camera.forward);
    const PointsSpan across = points_span(dot(d, camera.right) / tan_x, z, dot(normal, camera.right) / tan_x, nz, r);
    const PointsSpan upward = points_span(dot(d, camera.up) / tan_y, z, dot(normal, camera.up) / tan_y, nz, r);
    PointsRect rect;
    rect.x0 = across.whole ? 0u : points_first(across.low, tan_x, width);
    rect.x1 = across.whole ? width : points_end(across.high, tan_x, width);
    rect.y0 = upward.whole ? 0u : points_first(-upward.high, tan_y, height);
    rect.y1 = upward.whole ? height : points_end(-upward.low, tan_y, height);
    if (rect.x0 >= rect.x1 || rect.y0 >= rect.y1 || z < -r) rect.x1 = rect.x0;
    return rect;
}

// ---- Leaves: cells of triangles ----
//
// A leaf stands for the part of the surface that is nearest to its sample: whole triangles, and parts of those that hold several samples. All of that
// is drawn as it is, so leaves are exact whatever their size in pixels: nothing reaches beyond an edge of the surface, and nothing is drawn twice.
//
// A cell is a part of a triangle: the triangle's number, then three corners in barycentrics, u | v << 16 in units of 1 / points_cell_steps.
const uint points_cell_steps = 32768u;

// How far outside the picture a node is still looked at, in leaf radii: what a leaf stands for may reach beyond its sphere.
const float points_margin = 2.0f;

// What a pixel sees is the number of a triangle, or this and the slot of an inner node.
const uint points_inner = 0x80000000u;

struct PointsCell {
    vec3 d, b, c;        // rows: of the denominator, and of the weights of the second and third corner times it
    float t;             // depth times the denominator
    vec2 origin, to_b, to_c;  // barycentrics in the triangle of the first corner, and the way to the others
};
MYRIAD_FN vec2 points_corner(uint code) { return vec2(float(code & 0xffffu), float(code >> 16)) / float(points_cell_steps); }
MYRIAD_FN vec3 points_place(Corners at, vec2 uv) { return at.p0 + uv.x * (at.p1 - at.p0) + uv.y * (at.p2 - at.p0); }
// `at`: the triangle's corners, from the eye.
MYRIAD_FN PointsCell points_cell(CameraPush camera, Corners at, vec2 a, vec2 b, vec2 c, uint width, uint height) {
    PointsCell cell;
    cell.origin = a;
    cell.to_b = b - a;
    cell.to_c = c - a;
    const vec3 e1 = at.p1 - at.p0;
    const vec3 e2 = at.p2 - at.p0;
    const vec3 n = cross(e2, e1);
    const vec3 u = cross(at.p0, e2);  // w . u / w . n is the barycentric
    const vec3 v = cross(e1, at.p0);
    cell.t = dot(at.p0, n);
    // Weights of the cell's corners: linear in u and v, so rows, too.
    const float det = cell.to_b.x * cell.to_c.y - cell.to_b.y * cell.to_c.x;
    const vec3 from_u = u - a.x * n;
    const vec3 from_v = v - a.y * n;
    cell.d = points_row(camera, n, width, height);
    cell.b = points_row(camera, (cell.to_c.y * from_u - cell.to_c.x * from_v) / det, width, height);
    cell.c = points_row(camera, (cell.to_b.x * from_v - cell.to_b.y * from_u) / det, width, height);
    return cell;
}
// Where a pixel's ray meets the plane of a cell.
struct PointsHit {
    float t, b, c;       // depth; weights of the second and third corner
};
MYRIAD_FN PointsHit points_on(PointsCell cell, float x, float y) {
    PointsHit hit;
    const float scale = 1.0f / points_at(cell.d, x, y);
    MYRIAD_PRECISE const float t = cell.t * scale;
    hit.t = t;
    hit.b = points_at(cell.b, x, y) * scale;
    hit.c = points_at(cell.c, x, y) * scale;
    return hit;
}
// Cells reach over their edges by a hair, so that none of the pixels between two is lost.
const float points_hair = 1e-5f;
MYRIAD_FN bool points_covered(PointsHit hit) {
    return hit.t > 0.0f && hit.t < 1e30f && hit.b >= -points_hair && hit.c >= -points_hair && hit.b + hit.c <= 1.0f + points_hair;
}
MYRIAD_FN vec2 points_barycentrics(PointsCell cell, PointsHit hit) { return cell.origin + hit.b * cell.to_b + hit.c * cell.to_c; }

// The pixels of a triangle, corners from the eye; all where it reaches behind the eye.
MYRIAD_FN PointsRect points_triangle_rect(CameraPush camera, Corners at, uint width, uint height) {
    const float tan_x = sqrt(dot(camera.right, camera.right));
    const float tan_y = sqrt(dot(camera.up, camera.up));
    const vec3 z = vec3(dot(at.p0, camera.forward), dot(at.p1, camera.forward), dot(at.p2, camera.forward));
    const vec3 x = vec3(dot(at.p0, camera.right), dot(at.p1, camera.right), dot(at.p2, camera.right)) / (tan_x * z);
    const vec3 y = vec3(dot(at.p0, camera.up), dot(at.p1, camera.up), dot(at.p2, camera.up)) / (tan_y * z);
    const bool whole = !(min(z.x, min(z.y, z.z)) > 0.0f);
    PointsRect rect;
    rect.x0 = whole ? 0u : points_first(min(x.x, min(x.y, x.z)), tan_x, width);
    rect.x1 = whole ? width : points_end(max(x.x, max(x.y, x.z)), tan_x, width);
    rect.y0 = whole ? 0u : points_first(-max(y.x, max(y.y, y.z)), tan_y, height);
    rect.y1 = whole ? height : points_end(-min(y.x, min(y.y, y.z)), tan_y, height);
    if (rect.y0 >= rect.y1 || max(z.x, max(z.y, z.z)) <= 0.0f) rect.x1 = rect.x0;
    return rect;
}
MYRIAD_FN Corners points_cell_corners(Corners at, vec2 a, vec2 b, vec2 c) {
    Corners corners;
    corners.p0 = points_place(at, a);
    corners.p1 = points_place(at, b);
    corners.p2 = points_place(at, c);
    return corners;
}

// ---- Inner nodes ----
//
// A node of the cut that is no leaf is smaller than c pixels. It covers the pixels whose rays meet its plane inside its box; a node whose cone says
// nothing faces the eye.

struct PointsNode {
    vec3 d;              // centre - eye
    vec3 normal;
    float off;           // d . normal
    vec3 low, high;      // the box, around the centre
};
MYRIAD_FN PointsNode points_node(vec3 d, float radius, uint cone, uvec2 box_code) {
    PointsNode node;
    node.d = d;
    node.normal = (cone >> 24) == 255u ? d / sqrt(dot(d, d)) : bsh_cone_axis(cone);
    node.off = dot(d, node.normal);
    const BshBox box = bsh_decode_box(box_code, radius);
    const float margin = radius * (1.0f / 128.0f);  // as maps have it (splat_margin)
    node.low = box.low - margin;
    node.high = box.high + margin;
    return node;
}
// The depth at a ray; negative where it is not covered.
MYRIAD_FN float points_node_depth(PointsNode node, vec3 w) {
    MYRIAD_PRECISE const float t = node.off / dot(w, node.normal);
    const vec3 q = t * w - node.d;
    const bool inside = q.x >= node.low.x && q.y >= node.low.y && q.z >= node.low.z && q.x <= node.high.x && q.y <= node.high.y && q.z <= node.high.z;
    return t > 0.0f && inside ? t : -1.0f;
}

// Which of a node's children a pixel sees of it: that whose middle is nearest to the ray. This is the square of that distance, but for a factor
// that all share.
MYRIAD_FN float points_beside(vec3 d, vec3 w) {
    const vec3 c = cross(d, w);
    return dot(c, c);
}

// The barycentrics of a triangle's point near (u, v), which may lie outside: held to the triangle, edge by edge.
MYRIAD_FN vec2 points_hold(float u, float v) {
    vec2 p = vec2(clamp(u, 0.0f, 1.0f), clamp(v, 0.0f, 1.0f));
    const float over = p.x + p.y;
    if (over > 1.0f) p = p / over;
    if (!(p.x >= 0.0f && p.y >= 0.0f)) p = vec2(1.0f / 3.0f, 1.0f / 3.0f);  // a ray along the plane
    return p;
}
MYRIAD_END

#ifdef __cplusplus
static_assert(sizeof(myriad::PointsScene) == 64 && sizeof(myriad::PointsSplatPush) <= 128 && sizeof(myriad::PointsResolvePush) <= 128);
#endif

#endif
