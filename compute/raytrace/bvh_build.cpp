#include "compute/raytrace/bvh_build.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <memory>
#include <numeric>
#include <string>
#include <tuple>

#include <embree3/rtcore.h>

#include "engine/error.hpp"

namespace myriad::compute {
namespace {

// Boxes are enlarged by 2^-21 of the triangle's extent and of its coordinates (8 u each): the triangle test rounds its
// vertices by up to 3 u of their distances from the ray's origin, so that it accepts rays that pass the exact box by as
// much; the part that grows with the ray's length is in the box test's own slack. A box then also contains its triangle
// strictly, which rays in the plane of a box's face rely on.
vec3 padding(const BvhTriangle& t) {
    const vec3 lo = min(t.p0, min(t.p1, t.p2)), hi = max(t.p0, max(t.p1, t.p2)), extent = hi - lo;
    return (vec3(max(extent.x, max(extent.y, extent.z))) + max(abs(lo), abs(hi))) * 4.7683716e-7f;
}

// What Embree's builder makes: inner nodes of up to eight children, leaves of up to four triangles.
struct Built {
    uint count = 0;
    bool leaf = false;
    Built* child[bvh_width] = {};
    BvhBox box[bvh_width] = {};
    uint triangle[bvh_leaf_size] = {};
};

void* make_node(RTCThreadLocalAllocator allocator, unsigned count, void*) {
    assert(count <= bvh_width);
    auto* node = new (rtcThreadLocalAlloc(allocator, sizeof(Built), 16)) Built;
    node->count = count;
    return node;
}
void set_children(void* node, void** children, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i) static_cast<Built*>(node)->child[i] = static_cast<Built*>(children[i]);
}
void set_boxes(void* node, const RTCBounds** bounds, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i) {
        const RTCBounds& b = *bounds[i];
        static_cast<Built*>(node)->box[i] = {{b.lower_x, b.lower_y, b.lower_z}, {b.upper_x, b.upper_y, b.upper_z}};
    }
}
void* make_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, size_t count, void*) {
    assert(count <= bvh_leaf_size);
    auto* leaf = new (rtcThreadLocalAlloc(allocator, sizeof(Built), 16)) Built;
    leaf->leaf = true;
    leaf->count = uint(count);
    for (size_t i = 0; i < count; ++i) leaf->triangle[i] = primitives[i].primID;
    std::sort(leaf->triangle, leaf->triangle + count);  // threads may hand them over in any order
    return leaf;
}

// Bounds of the part of a triangle on either side of a plane, for spatial splits (Stich et al. 2009).
void split(const RTCBuildPrimitive* primitive, unsigned axis, float position, RTCBounds* left, RTCBounds* right, void* user) {
    const BvhTriangle& t = static_cast<const BvhTriangle*>(user)[primitive->primID];
    const vec3 p[3] = {t.p0, t.p1, t.p2};
    BvhBox side[2] = {{vec3(INFINITY), vec3(-INFINITY)}, {vec3(INFINITY), vec3(-INFINITY)}};
    auto grow = [](BvhBox& box, vec3 q) { box.lo = min(box.lo, q), box.hi = max(box.hi, q); };
    for (int i = 0; i < 3; ++i) {
        const vec3 a = p[i], b = p[(i + 1) % 3];
        if (a[axis] <= position) grow(side[0], a);
        if (a[axis] >= position) grow(side[1], a);
        if ((a[axis] < position) != (b[axis] < position)) {
            const glm::dvec3 from(a), along = glm::dvec3(b) - from;
            vec3 cut = vec3(from + along * ((double(position) - from[axis]) / along[axis]));
            cut[axis] = position;
            grow(side[0], cut), grow(side[1], cut);
        }
    }
    const vec3 pad = padding(t);
    const vec3 lo(primitive->lower_x, primitive->lower_y, primitive->lower_z), hi(primitive->upper_x, primitive->upper_y, primitive->upper_z);
    RTCBounds* out[2] = {left, right};
    for (int i = 0; i < 2; ++i) {
        const vec3 l = max(side[i].lo - pad, lo), h = min(side[i].hi + pad, hi);
        *out[i] = {l.x, l.y, l.z, 0, h.x, h.y, h.z, 0};
    }
}

// Triangles worth a test, in the order of their indices.
std::vector<BvhTriangle> hittable(std::span<const glm::vec3> positions, std::span<const glm::uvec4> indices) {
    std::vector<BvhTriangle> kept;
    kept.reserve(indices.size());
    auto finite = [](vec3 p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); };
    for (uint i = 0; i < indices.size(); ++i) {
        const vec3 p0 = positions[indices[i].x], p1 = positions[indices[i].y], p2 = positions[indices[i].z];
        if (!finite(p0) || !finite(p1) || !finite(p2)) continue;
        const glm::dvec3 area = cross(glm::dvec3(p1) - glm::dvec3(p0), glm::dvec3(p2) - glm::dvec3(p0));
        if (area != glm::dvec3(0)) kept.push_back({p0, p1, p2, i});
    }
    // Copies of a triangle can only tie with it; a heap of them in one place would be a tree that prunes nothing.
    using Key = std::array<float, 9>;
    auto key = [&](uint i) {
        std::array<vec3, 3> p{kept[i].p0, kept[i].p1, kept[i].p2};
        std::sort(p.begin(), p.end(), [](vec3 a, vec3 b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); });
        return Key{p[0].x, p[0].y, p[0].z, p[1].x, p[1].y, p[1].z, p[2].x, p[2].y, p[2].z};
    };
    std::vector<std::pair<Key, uint>> order(kept.size());
    for (uint i = 0; i < order.size(); ++i) order[i] = {key(i), i};
    std::sort(order.begin(), order.end());
    std::vector<bool> copy(kept.size());
    for (size_t i = 1; i < order.size(); ++i) copy[order[i].second] = order[i].first == order[i - 1].first;
    size_t n = 0;
    for (size_t i = 0; i < kept.size(); ++i)
        if (!copy[i]) kept[n++] = kept[i];
    kept.resize(n);
    return kept;
}

// Rounds the boxes of a node's children to its frame, outward.
void quantise(const Built& from, BvhNode& to) {
    BvhBox all = from.box[0];
    for (uint i = 1; i < from.count; ++i) all = {min(all.lo, from.box[i].lo), max(all.hi, from.box[i].hi)};
    to.origin = all.lo;
    to.frame = from.count << 24;
    for (int axis = 0; axis < 3; ++axis) {
        int exponent = 0;
        std::frexp((all.hi[axis] - all.lo[axis]) / 255, &exponent);  // 2^exponent > extent / 255
        for (uint e = uint(clamp(exponent + 127, 1, 254));; ++e) {
            const float scale = uintBitsToFloat(e << 23), origin = all.lo[axis];
            auto bound = [&](int byte) { return origin + float(byte) * scale; };
            bool fits = true;
            uint bytes[bvh_width][2];
            for (uint i = 0; i < from.count; ++i) {
                int lo = clamp(int((from.box[i].lo[axis] - origin) / scale), 0, 255), hi = lo;
                while (lo > 0 && bound(lo) > from.box[i].lo[axis]) --lo;
                hi = clamp(int((from.box[i].hi[axis] - origin) / scale), lo, 255);
                while (hi < 255 && bound(hi) < from.box[i].hi[axis]) ++hi;
                fits = fits && bound(hi) >= from.box[i].hi[axis];
                bytes[i][0] = uint(lo), bytes[i][1] = uint(hi);
            }
            if (!fits) continue;
            to.frame |= e << (8 * axis);
            for (uint i = 0; i < from.count; ++i)
                for (int end = 0; end < 2; ++end) to.child[i][end] |= bytes[i][end] << (8 * axis);
            break;
        }
    }
}

struct Layout {
    const std::vector<BvhTriangle>& triangles;
    BvhData& out;

    // Children lie side by side; subtrees follow in depth-first order.
    void lay(Built& node, uint index, uint level) {
        out.depth = std::max(out.depth, level);
        // Inner nodes first, the larger ones first among them: occlusion rays take them in this order.
        std::array<uint, bvh_width> order;
        std::iota(order.begin(), order.end(), 0u);
        auto area = [&](uint i) { const vec3 e = node.box[i].hi - node.box[i].lo; return e.x * e.y + e.y * e.z + e.z * e.x; };
        std::stable_sort(order.begin(), order.begin() + node.count, [&](uint a, uint b) {
            if (node.child[a]->leaf != node.child[b]->leaf) return node.child[b]->leaf;
            return area(a) > area(b);
        });
        Built sorted = node;
        for (uint i = 0; i < node.count; ++i) sorted.child[i] = node.child[order[i]], sorted.box[i] = node.box[order[i]];

        BvhNode packed{};
        quantise(sorted, packed);
        packed.first_child = uint(out.nodes.size());
        packed.first_triangle = uint(out.triangles.size());
        uint inner = 0;
        for (uint i = 0; i < sorted.count; ++i) {
            const Built& child = *sorted.child[i];
            if (!child.leaf) { ++inner; continue; }
            packed.child[i].x |= child.count << 24;
            packed.child[i].y |= (uint(out.triangles.size()) - packed.first_triangle) << 24;
            for (uint k = 0; k < child.count; ++k) out.triangles.push_back(triangles[child.triangle[k]]);
        }
        out.nodes[index] = packed;
        out.nodes.resize(out.nodes.size() + inner);
        for (uint i = 0; i < inner; ++i) lay(*sorted.child[i], packed.first_child + i, level + 1);
    }
};

}  // namespace

BvhBox bvh_box(const BvhTriangle& t) {
    const vec3 lo = min(t.p0, min(t.p1, t.p2)), hi = max(t.p0, max(t.p1, t.p2)), pad = padding(t);
    return {lo - pad, hi + pad};
}

BvhData build_bvh(std::span<const glm::vec3> positions, std::span<const glm::uvec4> indices, BvhQuality quality) {
    const std::vector<BvhTriangle> triangles = hittable(positions, indices);
    BvhData out;
    out.dropped = uint(indices.size() - triangles.size());
    out.nodes.push_back({});
    out.depth = 1;
    if (triangles.empty()) return out;

    std::vector<RTCBuildPrimitive> primitives(triangles.size());
    for (uint i = 0; i < triangles.size(); ++i) {
        const BvhBox box = bvh_box(triangles[i]);
        primitives[i] = {box.lo.x, box.lo.y, box.lo.z, 0, box.hi.x, box.hi.y, box.hi.z, i};
    }
    const std::unique_ptr<RTCDeviceTy, void (*)(RTCDevice)> device(rtcNewDevice(nullptr), rtcReleaseDevice);
    const std::unique_ptr<RTCBVHTy, void (*)(RTCBVH)> bvh(rtcNewBVH(device.get()), rtcReleaseBVH);
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    const bool best = quality == BvhQuality::best;
    const size_t count = primitives.size();
    if (best) primitives.resize(2 * count);  // room for the halves of split triangles
    arguments.buildQuality = best ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM;
    arguments.maxBranchingFactor = bvh_width;
    arguments.maxDepth = bvh_max_depth;
    arguments.maxLeafSize = bvh_leaf_size;
    arguments.traversalCost = 2;  // as measured: a node takes the time of two to three triangles
    arguments.bvh = bvh.get();
    arguments.primitives = primitives.data();
    arguments.primitiveCount = count;
    arguments.primitiveArrayCapacity = primitives.size();
    arguments.splitPrimitive = split;
    arguments.userPtr = const_cast<BvhTriangle*>(triangles.data());
    arguments.createNode = make_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = set_boxes;
    arguments.createLeaf = make_leaf;
    auto* root = static_cast<Built*>(rtcBuildBVH(&arguments));
    if (!root) throw DeviceError("Embree could not build a tree over " + std::to_string(triangles.size()) + " triangles: error " +
                                 std::to_string(rtcGetDeviceError(device.get())));
    Built above;  // a root that is a leaf gets a node of one child
    if (root->leaf) {
        above.count = 1;
        above.child[0] = root;
        above.box[0] = bvh_box(triangles[root->triangle[0]]);
        for (uint i = 1; i < root->count; ++i) {
            const BvhBox box = bvh_box(triangles[root->triangle[i]]);
            above.box[0] = {min(above.box[0].lo, box.lo), max(above.box[0].hi, box.hi)};
        }
        root = &above;
    }
    out.triangles.reserve(triangles.size());
    Layout{triangles, out}.lay(*root, 0, 1);
    assert(out.depth <= bvh_max_depth);
    return out;
}

}  // namespace myriad::compute
