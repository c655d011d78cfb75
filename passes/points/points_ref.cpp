#include "passes/points/points_ref.hpp"

#include <cmath>

namespace myriad::passes {
namespace {

Corners corners_of(const PointsSceneRef& scene, uint triangle, const vec3& eye) {
    const Corners at = scene.world.corners(triangle);
    return {at.p0 - eye, at.p1 - eye, at.p2 - eye};
}

uint leaf_below(const PointsSceneRef& scene, uint slot, const CameraPush& camera, const vec3& w) {
    while (slot >= scene.tree.leaves) {
        const uint block = bsh_block_of(slot, scene.tree);
        const auto beside = [&](uint child) { return points_beside(scene.tree.sphere(child).center - camera.position, w); };
        slot = scene.tree.arity() * block;
        for (uint child = slot; child < scene.tree.arity() * (block + 1); ++child)
            if (!bsh_is_absent(scene.tree.spheres[child]) && beside(child) < beside(slot)) slot = child;
    }
    return slot;
}

// What a node gives to each pixel: a depth, or nothing. visit(pixel, bits of the depth, what).
template <class Visit>
void draw(const PointsSceneRef& scene, uint slot, const CameraPush& camera, uint width, uint height, Visit visit) {
    const auto all = [&](uint what, const PointsRect& rect, auto depth_at) {
        for (uint y = 0; y < height; ++y)
            for (uint x = 0; x < width; ++x) {
                if (x < rect.x0 || x >= rect.x1 || y < rect.y0 || y >= rect.y1) continue;
                const float depth = depth_at(x, y);
                if (depth > 0) visit(size_t(y) * width + x, floatBitsToUint(depth), what);
            }
    };
    if (slot < scene.tree.leaves) {
        for (uint i = scene.cells.first[slot]; i < scene.cells.first[slot + 1]; ++i) {
            const uvec4 code = scene.cells.cells[i];
            const vec2 a = points_corner(code.y), b = points_corner(code.z), c = points_corner(code.w);
            const Corners at = corners_of(scene, code.x, camera.position);
            const PointsCell cell = points_cell(camera, at, a, b, c, width, height);
            all(code.x, points_triangle_rect(camera, points_cell_corners(at, a, b, c), width, height), [&](uint x, uint y) {
                const PointsHit hit = points_on(cell, float(x), float(y));
                if (!points_covered(hit)) return -1.0f;
                const vec2 uv = points_barycentrics(cell, hit), held = points_hold(uv.x, uv.y);
                return scene.world.is_there(code.x, held.x, held.y, opacity_pixel(x, y)) ? hit.t : -1.0f;
            });
        }
        return;
    }
    const Sphere sphere = scene.tree.sphere(slot);
    const vec3 d = sphere.center - camera.position;
    const uvec2 box = scene.tree.boxes[slot];
    const PointsNode node = points_node(d, sphere.radius, scene.tree.cones[slot], box);
    all(points_inner | slot, points_rect(camera, d, sphere.radius, vec3(0), width, height), [&](uint x, uint y) {
        const vec3 w = points_ray(camera, float(x), float(y), width, height);
        const float depth = points_node_depth(node, w);
        if (!(depth > 0) || bsh_missing(box) == 0) return depth;
        const SurfaceSample& s = scene.samples[leaf_below(scene, slot, camera, w)];
        return scene.world.is_there(s.triangle, s.u, s.v, opacity_pixel(x, y)) ? depth : -1.0f;
    });
}

}  // namespace

std::vector<uint> points_ref(const PointsSceneRef& scene, std::span<const uvec2> groups, const CameraPush& camera, uint width, uint height) {
    const size_t count = size_t(width) * height;
    std::vector<uint> pixels(2 * count, ~0u);
    std::fill(pixels.begin(), pixels.begin() + ptrdiff_t(count), points_nothing);
    const auto every = [&](auto visit) {
        for (const uvec2& code : groups) {
            const CutGroup g = cut_unpack(code);
            for (uint i = 0; i < scene.tree.arity(); ++i)
                if (g.drawn >> i & 1) draw(scene, scene.tree.arity() * g.block + i, camera, width, height, visit);
        }
    };
    every([&](size_t pixel, uint bits, uint) { pixels[pixel] = std::min(pixels[pixel], bits); });
    every([&](size_t pixel, uint bits, uint what) {
        if (bits <= pixels[pixel] + points_ulps) pixels[count + pixel] = std::min(pixels[count + pixel], what);
    });
    return pixels;
}

std::vector<RayHitRecord> points_hits_ref(const PointsSceneRef& scene, const std::vector<uint>& pixels, const CameraPush& camera, uint width, uint height) {
    const size_t count = size_t(width) * height;
    std::vector<RayHitRecord> hits;
    for (size_t pixel = 0; pixel < count; ++pixel) {
        uint triangle = pixels[count + pixel];
        if (triangle == ~0u) {
            hits.push_back({0, ~0u, 0, 0, 0});
            continue;
        }
        const float x = float(pixel % width), y = float(pixel / width);
        const vec3 w = points_ray(camera, x, y, width, height);
        if (triangle & points_inner) triangle = scene.samples[leaf_below(scene, triangle & ~points_inner, camera, w)].triangle;
        const PointsCell cell = points_cell(camera, corners_of(scene, triangle, camera.position), vec2(0), vec2(1, 0), vec2(0, 1), width, height);
        const PointsHit hit = points_on(cell, x, y);
        const vec2 held = points_hold(hit.b, hit.c);
        hits.push_back({uintBitsToFloat(pixels[pixel]) * std::sqrt(dot(w, w)), triangle, held.x, held.y, points_at(cell.d, x, y) > 0});
    }
    return hits;
}

}  // namespace myriad::passes
