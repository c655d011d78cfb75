#include "compute/raytrace/bvh_build.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <map>
#include <memory>
#include <numeric>
#include <set>
#include <string>
#include <tuple>

#include <embree3/rtcore.h>

#include "compute/common/radix_sort.hpp"
#include "engine/error.hpp"
#include "engine/parallel.hpp"

namespace myriad::compute {
namespace {

constexpr size_t grain = 1 << 14;  // triangles that a thread takes at a time

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
    const vec3 pad = bvh_padding(min(t.p0, min(t.p1, t.p2)), max(t.p0, max(t.p1, t.p2)));
    const vec3 lo(primitive->lower_x, primitive->lower_y, primitive->lower_z), hi(primitive->upper_x, primitive->upper_y, primitive->upper_z);
    RTCBounds* out[2] = {left, right};
    for (int i = 0; i < 2; ++i) {
        const vec3 l = max(side[i].lo - pad, lo), h = min(side[i].hi + pad, hi);
        *out[i] = {l.x, l.y, l.z, 0, h.x, h.y, h.z, 0};
    }
}

// Triangles worth a test, in the order of their indices, among stored ones [first, first + count), which get ids from first_id on.
// Of a shared mesh, needles without area stay: rounding gives them one in the world, now and then. So does all that moves.
void append_hittable(const WorldTriangles& world, uint first, uint count, uint first_id, bool shared, uint32_t threads,
                     std::vector<BvhTriangle>& kept) {
    size_t n = kept.size();
    const size_t before = n;
    kept.resize(before + count);
    std::vector<uint8_t> keep(count);
    engine::parallel_pieces(count, grain, [&](size_t begin, size_t end) {
        auto finite = [](vec3 p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); };
        for (size_t i = begin; i < end; ++i) {
            const auto [p0, p1, p2] = world.stored(first + uint(i));
            const glm::dvec3 area = cross(glm::dvec3(p1) - glm::dvec3(p0), glm::dvec3(p2) - glm::dvec3(p0));
            const Opacity::Kind kind = world.opacity.kind(first + uint(i));
            const bool somewhere = world.moves(first + uint(i)) || (shared ? p0 != p1 && p1 != p2 && p2 != p0 : area != glm::dvec3(0));
            keep[i] = kind != Opacity::Kind::nowhere && finite(p0) && finite(p1) && finite(p2) && somewhere;
            kept[before + i] = {p0, p1, p2, (first_id + uint(i)) | (kind == Opacity::Kind::asks ? bvh_asks : 0)};
        }
    }, threads);
    for (size_t i = 0; i < count; ++i)
        if (keep[i]) kept[n++] = kept[before + i];
    kept.resize(n);
}

// The same for triangles of the same three vertices, in whatever order; -0 is 0.
using Key = std::array<float, 9>;
Key key(const BvhTriangle& t) {
    std::array<vec3, 3> p{t.p0 + 0.0f, t.p1 + 0.0f, t.p2 + 0.0f};
    std::sort(p.begin(), p.end(), [](vec3 a, vec3 b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); });
    return {p[0].x, p[0].y, p[0].z, p[1].x, p[1].y, p[1].z, p[2].x, p[2].y, p[2].z};
}
uint32_t hash(const Key& key) {
    uint64_t h = 0;
    for (const float v : key) h = (h ^ std::bit_cast<uint32_t>(v)) * 0x9e3779b97f4a7c15u, h ^= h >> 32;
    return uint32_t(h * 0xd6e8feb86659fd93u >> 32);
}

// Copies of a triangle that is everywhere can only tie with it; a heap of them in one place would be a tree that prunes nothing.
// The first such stays, and what asks before it. Copies have one hash, so only what shares a hash is compared. What moves(id)
// is a copy of nothing: another moment may tell them apart.
template <class Moves>
void drop_copies(std::vector<BvhTriangle>& kept, Moves moves, uint32_t threads) {
    std::vector<uint64_t> hashed(kept.size());
    engine::parallel_pieces(hashed.size(), grain, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) hashed[i] = uint64_t(hash(key(kept[i]))) << 32 | i;
    }, threads);
    radix_sort(hashed, [](uint64_t h) { return h; }, 32, 64, threads);
    std::vector<uint8_t> copy(kept.size());
    std::vector<std::pair<Key, uint>> alike;
    for (size_t run = 0, next; run < hashed.size(); run = next) {
        for (next = run + 1; next < hashed.size() && hashed[next] >> 32 == hashed[run] >> 32;) ++next;
        if (next - run == 1) continue;
        alike.clear();
        for (size_t i = run; i < next; ++i) alike.emplace_back(key(kept[uint(hashed[i])]), uint(hashed[i]));
        std::sort(alike.begin(), alike.end());
        bool everywhere = false;  // one of those before
        for (size_t i = 0; i < alike.size(); ++i) {
            if (i > 0 && alike[i].first != alike[i - 1].first) everywhere = false;
            const uint id = kept[alike[i].second].id;
            if (moves(id & ~bvh_asks)) continue;
            copy[alike[i].second] = everywhere;
            everywhere = everywhere || (id & bvh_asks) == 0;
        }
    }
    size_t n = 0;
    for (size_t i = 0; i < kept.size(); ++i)
        if (!copy[i]) kept[n++] = kept[i];
    kept.resize(n);
}

struct Layout {
    std::span<const BvhTriangle> triangles;  // what leaves hold …
    std::span<const BvhNode> instances;      // … or, on top, the nodes that stand for them
    BvhData& out;

    // Children lie side by side; subtrees follow in depth-first order.
    void lay(Built& node, uint index, uint level) {
        deepest = std::max(deepest, level);
        // Inner nodes first, the larger ones first among them: occlusion rays take them in this order.
        std::array<uint, bvh_width> order;
        std::iota(order.begin(), order.end(), 0u);
        auto area = [&](uint i) { const vec3 e = node.box[i].hi - node.box[i].lo; return e.x * e.y + e.y * e.z + e.z * e.x; };
        std::stable_sort(order.begin(), order.begin() + node.count, [&](uint a, uint b) {
            if (instances.empty() && node.child[a]->leaf != node.child[b]->leaf) return node.child[b]->leaf;
            return area(a) > area(b);
        });
        Built sorted = node;
        for (uint i = 0; i < node.count; ++i) sorted.child[i] = node.child[order[i]], sorted.box[i] = node.box[order[i]];

        BvhChildren children;
        std::copy_n(sorted.box, sorted.count, children.box);
        BvhNode packed = bvh_pack({}, children, sorted.count);
        packed.first_child = uint(out.nodes.size());
        packed.first_triangle = uint(out.triangles.size());
        uint inner = 0;
        for (uint i = 0; i < sorted.count; ++i) {
            const Built& child = *sorted.child[i];
            if (!child.leaf || !instances.empty()) { ++inner; continue; }
            packed.child[i].x |= child.count << 24;
            packed.child[i].y |= (uint(out.triangles.size()) - packed.first_triangle) << 24;
            for (uint k = 0; k < child.count; ++k) out.triangles.push_back(triangles[child.triangle[k]]);
        }
        out.nodes[index] = packed;
        out.nodes.resize(out.nodes.size() + inner);
        for (uint i = 0; i < inner; ++i) {
            Built& child = *sorted.child[i];
            if (child.leaf) out.nodes[packed.first_child + i] = instances[child.triangle[0]];
            else lay(child, packed.first_child + i, level + 1);
        }
    }

    uint deepest = 0;
};

// Lays the tree that Embree makes of these boxes from node `index` on. Returns its levels.
uint lay_tree(Layout layout, std::span<const BvhBox> boxes, uint index, BvhQuality quality, uint max_depth, uint32_t threads) {
    std::vector<RTCBuildPrimitive> primitives(boxes.size());
    for (uint i = 0; i < boxes.size(); ++i)
        primitives[i] = {boxes[i].lo.x, boxes[i].lo.y, boxes[i].lo.z, 0, boxes[i].hi.x, boxes[i].hi.y, boxes[i].hi.z, i};
    const std::string config = "threads=" + std::to_string(threads ? threads : engine::host_threads());
    const std::unique_ptr<RTCDeviceTy, void (*)(RTCDevice)> device(rtcNewDevice(config.c_str()), rtcReleaseDevice);
    const std::unique_ptr<RTCBVHTy, void (*)(RTCBVH)> bvh(rtcNewBVH(device.get()), rtcReleaseBVH);
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    const bool best = quality == BvhQuality::best;
    const size_t count = primitives.size();
    if (best) primitives.resize(2 * count);  // room for the halves of split triangles
    arguments.buildQuality = best ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM;
    arguments.maxBranchingFactor = bvh_width;
    arguments.maxDepth = max_depth;
    arguments.maxLeafSize = layout.instances.empty() ? bvh_leaf_size : 1;
    arguments.traversalCost = 2;  // as measured: a node takes the time of two to three triangles
    arguments.bvh = bvh.get();
    arguments.primitives = primitives.data();
    arguments.primitiveCount = count;
    arguments.primitiveArrayCapacity = primitives.size();
    arguments.splitPrimitive = split;
    arguments.userPtr = const_cast<BvhTriangle*>(layout.triangles.data());
    arguments.createNode = make_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = set_boxes;
    arguments.createLeaf = make_leaf;
    auto* root = static_cast<Built*>(rtcBuildBVH(&arguments));
    if (!root) throw DeviceError("Embree could not build a tree over " + std::to_string(count) + " boxes: error " +
                                 std::to_string(rtcGetDeviceError(device.get())));
    Built above;  // a root that is a leaf gets a node of one child
    if (root->leaf) {
        above.count = 1;
        above.child[0] = root;
        above.box[0] = boxes[root->triangle[0]];
        for (uint i = 1; i < root->count; ++i) above.box[0] = bvh_united(above.box[0], boxes[root->triangle[i]]);
        root = &above;
    }
    layout.lay(*root, index, 1);
    assert(layout.deepest <= max_depth);
    return layout.deepest;
}

// Appends a tree over triangles. Returns its levels; nodes[index] is its root, which is there already.
uint append_tree(std::span<const BvhTriangle> triangles, uint index, BvhQuality quality, uint max_depth, uint32_t threads, BvhData& out) {
    if (triangles.empty()) return 1;
    std::vector<BvhBox> boxes(triangles.size());
    engine::parallel_pieces(boxes.size(), grain, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) boxes[i] = bvh_box(triangles[i]);
    }, threads);
    return lay_tree({triangles, {}, out}, boxes, index, quality, max_depth, threads);
}

// A mesh's tree, and what its instances' nodes and boxes are made from.
struct MeshTree {
    uint root = 0, depth = 0;
    size_t first = 0, count = 0;  // its triangles in BvhData
    vec3 most{0};                 // the largest magnitude of a coordinate, by axis
};

MeshTree append_mesh(std::span<const BvhTriangle> triangles, BvhQuality quality, uint32_t threads, BvhData& out) {
    MeshTree mesh{.root = uint(out.nodes.size()), .first = out.triangles.size()};
    out.nodes.push_back({});
    mesh.depth = append_tree(triangles, mesh.root, quality, bvh_max_mesh_depth, threads, out);
    mesh.count = out.triangles.size() - mesh.first;
    for (const BvhTriangle& t : triangles) mesh.most = max(mesh.most, max(abs(t.p0), max(abs(t.p1), abs(t.p2))));
    return mesh;
}

// The node that stands for an instance (bvh_is_instance in raytrace_io.h).
BvhNode instance_node(const MeshTree& mesh, const Instance& i, uint index) {
    BvhNode node{};
    node.frame = bvh_is_instance << 24;
    node.first_child = mesh.root;
    node.first_triangle = index;
    if ((i.flags & instance_in_world) != 0) return node;
    using glm::dvec3;
    const dvec3 far = abs(dvec3(i.x)) * double(mesh.most.x) + abs(dvec3(i.y)) * double(mesh.most.y) + abs(dvec3(i.z)) * double(mesh.most.z) + abs(dvec3(i.at));
    node.origin = vec3(far * (1 + 1e-6));
    const glm::dmat3 inverse = glm::inverse(glm::dmat3(i.x, i.y, i.z));
    const vec3 columns[4] = {vec3(inverse[0]), vec3(inverse[1]), vec3(inverse[2]), i.at};
    for (uint w = 0; w < 12; ++w) node.child[w / 2][int(w % 2)] = floatBitsToUint(columns[w / 3][int(w % 3)]);
    return node;
}

// Around all the mesh's triangles in the world, enlarged as a triangle's box is.
BvhBox instance_box(std::span<const BvhTriangle> triangles, const Instance& i) {
    BvhBox box{vec3(INFINITY), vec3(-INFINITY)};
    for (const BvhTriangle& t : triangles) {
        const Corners c = instance_corners(i, {t.p0, t.p1, t.p2});
        box = bvh_united(box, {min(c.p0, min(c.p1, c.p2)), max(c.p0, max(c.p1, c.p2))});
    }
    return bvh_padded(box.lo, box.hi);
}

// Trees of meshes, and one over instances. Everything that is stored in world space is one mesh.
BvhData build_levels(const WorldTriangles& world, BvhQuality quality, uint32_t threads) {
    BvhData out;
    out.nodes.push_back({});
    std::map<uint, MeshTree> meshes;  // by their first stored triangle
    std::vector<BvhTriangle> triangles, in_world;
    uint mesh_depth = 0;
    std::vector<MeshTree> tree_of;    // of out.instances
    // Where a mesh stands twice in the very same place, the second can only tie with the first.
    std::set<std::pair<uint, std::array<float, 12>>> places;
    const auto use = [&](const MeshTree& mesh, const Instance& instance) {
        mesh_depth = std::max(mesh_depth, mesh.depth);
        if (mesh.count > 0) out.instances.push_back(instance), tree_of.push_back(mesh);
    };
    for (const Instance& i : world.instances) {
        if ((i.flags & instance_in_world) != 0) {
            append_hittable(world, i.first_triangle, i.count, i.first_id, false, threads, in_world);
            out.dropped += i.count;
            continue;
        }
        const std::array<float, 12> place{i.x.x, i.x.y, i.x.z, i.y.x, i.y.y, i.y.z, i.z.x, i.z.y, i.z.z, i.at.x, i.at.y, i.at.z};
        if (!places.insert({i.first_triangle, place}).second) continue;
        const auto [mesh, is_new] = meshes.try_emplace(i.first_triangle);
        if (is_new) {
            triangles.clear();
            append_hittable(world, i.first_triangle, i.count, 0, true, threads, triangles);
            drop_copies(triangles, [](uint) { return false; }, threads);
            out.dropped += i.count - uint(triangles.size());
            mesh->second = append_mesh(triangles, quality, threads, out);
        }
        use(mesh->second, i);
    }
    drop_copies(in_world, [&](uint id) { return world.moves() && world.moves(world.place(id).triangle); }, threads);
    out.dropped -= uint(in_world.size());
    Instance all{};
    all.flags = instance_in_world;
    use(append_mesh(in_world, quality, threads, out), all);

    std::vector<BvhNode> nodes(out.instances.size());
    std::vector<BvhBox> boxes(nodes.size());
    engine::parallel_pieces(nodes.size(), 1, [&](size_t i, size_t) {
        nodes[i] = instance_node(tree_of[i], out.instances[i], uint(i));
        boxes[i] = instance_box(std::span(out.triangles).subspan(tree_of[i].first, tree_of[i].count), out.instances[i]);
    }, threads);
    out.depth = 1;
    if (!nodes.empty()) out.depth = lay_tree({{}, nodes, out}, boxes, 0, BvhQuality::quick, bvh_max_top_depth, threads) + mesh_depth;
    return out;
}

BvhData build_tree(const WorldTriangles& world, BvhQuality quality, uint32_t threads) {
    BvhData out;
    std::vector<BvhTriangle> triangles;
    append_hittable(world, 0, world.count(), 0, false, threads, triangles);
    drop_copies(triangles, [&](uint id) { return world.moves(id); }, threads);
    out.dropped = uint(world.triangles.size() - triangles.size());
    out.nodes.push_back({});
    out.triangles.reserve(triangles.size());
    out.depth = append_tree(triangles, 0, quality, bvh_max_depth, threads, out);
    return out;
}

}  // namespace

BvhBox bvh_box(const BvhTriangle& t) { return bvh_box_of(t.p0, t.p1, t.p2); }

BvhData build_bvh(const WorldTriangles& world, BvhQuality quality, uint32_t threads) {
    assert(world.count() <= bvh_asks);
    BvhData out = world.shared() ? build_levels(world, quality, threads) : build_tree(world, quality, threads);
    out.asks = std::any_of(out.triangles.begin(), out.triangles.end(), [](const BvhTriangle& t) { return (t.id & bvh_asks) != 0; });
    return out;
}

}  // namespace myriad::compute
