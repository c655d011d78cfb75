#include "compute/svo/svo_ref.hpp"

#include <algorithm>
#include <cmath>

#include "compute/voxels/voxels_ref.hpp"
#include "engine/transfer.hpp"

namespace myriad::compute {

using glm::dvec3;

namespace {

struct Leaves {
    std::vector<Voxel> voxels;
    OctreeTwin octree;
};
Leaves leaves_of(const SvoInput& input) {
    Leaves found{voxels_ref(input.triangles, input.cube, input.depth), {}};
    std::vector<uint64_t> keys;
    for (const Voxel& v : found.voxels) keys.push_back(v.key);
    found.octree = octree_ref(keys, input.depth);
    return found;
}

uint missing_of(const SvoInput& input, uint triangle, const SvoPiece& piece, const SvoCell& cell) {
    if (input.opacity.everywhere()) return 0;
    const vec2 at = svo_barycentrics(input.triangles[triangle], cell.middle + piece.mean * cell.half_side);
    return input.opacity.missing({triangle}, at.x, at.y);
}

}  // namespace

SvoArrays svo_ref(const SvoInput& input) {
    const auto [voxels, octree] = leaves_of(input);
    SvoArrays svo;
    svo.depth = input.depth;
    const uint nodes = uint(octree.nodes());
    if (nodes == 0) return svo;
    const uint inner = octree.level_first[input.depth];
    svo.blocks.resize(inner + 1);
    svo.spheres.resize(nodes), svo.cones.resize(nodes), svo.boxes.resize(nodes);

    struct Merged {
        Sphere sphere;
        BshBox box;
        float weight;
        uint missing;
    };
    std::vector<Merged> merged(nodes);
    for (uint leaf = inner; leaf < nodes; ++leaf) {
        const SvoCell cell = svo_cell({uint(octree.keys[leaf]), uint(octree.keys[leaf] >> 32)}, input.cube, input.depth);
        SvoLeaf sum = svo_leaf();
        for (uint at = octree.first[leaf]; at < octree.first[leaf + 1]; ++at) {
            const uint triangle = voxels[octree.items[at - nodes]].triangle;
            const Corners& t = input.triangles[triangle];
            const SvoPiece piece = svo_piece(t, cell);
            svo_add(sum, piece, bsh_cone_of(t.p1 - t.p0, t.p2 - t.p0), missing_of(input, triangle, piece, cell));
        }
        merged[leaf] = {svo_sphere(sum, cell), svo_box(sum, cell), sum.weight, sum.missing};
        svo.cones[leaf] = sum.cone;
    }
    for (uint level = input.depth; level-- > 0;)
        for (uint node = octree.level_first[level]; node < octree.level_first[level + 1]; ++node) {
            const uint first = octree.first[node], count = octree.first[node + 1] - first;
            BshSpheres spheres;
            BshCones cones;
            SvoOwner owner = svo_owner();
            for (uint i = 0; i < count; ++i) {
                const Merged& child = merged[first + i];
                spheres.at[i] = child.sphere;
                cones.at[i] = svo.cones[first + i];
                svo_add(owner, spheres.at[0].center, child.sphere, child.box, child.weight, child.missing);
            }
            const vec4 frame = bsh_frame(spheres, count);
            svo.blocks[node + 1] = {vec3(frame), svo_bits(frame.w, count, input.depth - level - 1), first};
            const vec3 middle = svo_middle(owner, spheres.at[0].center);
            float radius = 0;
            for (uint i = 0; i < count; ++i) {
                svo.spheres[first + i] = bsh_encode(frame, spheres.at[i]);
                const Sphere decoded = bsh_decode(frame, svo.spheres[first + i]);
                svo.boxes[first + i] = bsh_encode_box(decoded, merged[first + i].box, merged[first + i].missing);
                radius = std::max(radius, bsh_reach(middle, decoded));
            }
            merged[node] = {{middle, radius * bsh_slack}, {owner.low, owner.high}, owner.weight, owner.missing};
            svo.cones[node] = bsh_cone_merge(cones, count);
        }
    svo.blocks[0] = {merged[0].sphere.center, svo_bits(0, 1, input.depth), 0};
    const vec4 frame(merged[0].sphere.center, 0);
    svo.spheres[0] = bsh_encode(frame, merged[0].sphere);
    svo.boxes[0] = bsh_encode_box(bsh_decode(frame, svo.spheres[0]), merged[0].box, merged[0].missing);
    return svo;
}

SvoArrays svo_download(engine::Device& device, const Svo& svo) {
    SvoArrays arrays;
    arrays.depth = svo.depth();
    if (svo.empty()) return arrays;
    const uint64_t nodes = svo.size().nodes;
    arrays.blocks = engine::download(device, svo.blocks(), svo.size().blocks());
    arrays.spheres = engine::download(device, svo.spheres(), nodes);
    arrays.cones = engine::download(device, svo.cones(), nodes);
    arrays.boxes = engine::download(device, svo.boxes(), nodes);
    return arrays;
}

BshArrays svo_slots(const SvoArrays& svo) {
    BshArrays out;
    out.leaves = out.blocks = uint(svo.blocks.size());
    for (const SvoBlock& block : svo.blocks) {
        out.frames.push_back(svo_frame(block));
        for (uint i = 0; i < 8; ++i) {
            const bool there = i < svo_children(block);
            out.spheres.push_back(there ? svo.spheres[block.first + i] : uvec2(0, bsh_absent << 16));
            out.cones.push_back(there ? svo.cones[block.first + i] : bsh_cone_all);
            out.boxes.push_back(there ? svo.boxes[block.first + i] : uvec2(0));
        }
    }
    return out;
}

HostTree svo_host_tree(const SvoArrays& svo) {
    BshArrays slots = svo_slots(svo);
    HostTree tree;
    tree.frames = std::move(slots.frames), tree.spheres = std::move(slots.spheres), tree.cones = std::move(slots.cones);
    tree.leaves = uint(tree.spheres.size());
    for (const SvoBlock& block : svo.blocks) {
        tree.heights.push_back(svo_height(block));
        for (uint i = 0; i < 8; ++i) tree.child_blocks.push_back(block.first + i + 1);
    }
    return tree;
}

namespace {

struct Cone {
    dvec3 axis;
    double angle;
};
Cone cone_of(uint code) {
    const dvec3 axis = glm::normalize(dvec3(bsh_cone_axis(code)));
    const double t = double(code >> 24) / 255;
    return {axis, std::acos(std::max(1 - t * t, 0.0))};
}
double between(const dvec3& a, const dvec3& b) { return std::atan2(glm::length(glm::cross(a, b)), std::abs(glm::dot(a, b))); }
bool holds(const Cone& outer, const Cone& inner) { return outer.angle >= std::acos(0.0) || between(outer.axis, inner.axis) + inner.angle <= outer.angle + 1e-9; }

struct Check {
    const SvoArrays& svo;
    const SvoInput& input;
    const Leaves& leaves;
    std::vector<uint> reached;
    std::string fault;

    void fail(uint node, const std::string& what) {
        if (fault.empty()) fault = "node " + std::to_string(node) + ": " + what;
    }

    // The box of what is below, in the world.
    void visit(uint block, uint child, uint level) {
        const SvoBlock& b = svo.blocks[block];
        const uint node = b.first + child;
        if (node >= reached.size() || reached[node]++) return fail(node, "does not exist, or is reached twice");
        const Sphere s = svo.sphere(block, child);
        if (svo_height(b) != input.depth - level) return fail(node, "has another height than its level");
        if (!std::isfinite(s.center.x + s.center.y + s.center.z) || !std::isfinite(s.radius) || s.radius < 0) return fail(node, "has no sphere");
        if (bsh_is_absent(svo.spheres[node])) return fail(node, "is marked absent");
        if (level == input.depth) return leaf(node, s);
        const SvoBlock& own = svo.blocks[node + 1];
        const uint first = leaves.octree.first[node], count = leaves.octree.first[node + 1] - first;
        if (own.first != first || svo_children(own) != count) return fail(node, "has not the children of its cell");
        const BshBox box = bsh_decode_box(svo.boxes[node], s.radius);
        uint missing = opacity_nothing;
        for (uint i = 0; i < count && fault.empty(); ++i) {
            visit(node + 1, i, level + 1);
            if (!fault.empty()) return;
            const Sphere c = svo.sphere(node + 1, i);
            if (glm::length(dvec3(c.center) - dvec3(s.center)) + double(c.radius) > double(s.radius)) return fail(node, "its sphere does not hold its children's");
            if (!holds(cone_of(svo.cones[node]), cone_of(svo.cones[first + i]))) return fail(node, "its cone does not hold its children's");
            // A child's box is its content's rounded outward by its own steps.
            const BshBox part = bsh_decode_box(svo.boxes[first + i], c.radius);
            const double step = double(c.radius + s.radius) / 511 + 1e-6 * (glm::length(dvec3(s.center)) + double(s.radius));
            for (int axis = 0; axis < 3; ++axis)
                if (double(s.center[axis]) + double(box.low[axis]) > double(c.center[axis]) + double(part.low[axis]) + step ||
                    double(s.center[axis]) + double(box.high[axis]) < double(c.center[axis]) + double(part.high[axis]) - step)
                    return fail(node, "its box does not hold its children's");
            missing = std::min(missing, bsh_missing(svo.boxes[first + i]));
        }
        if (missing != bsh_missing(svo.boxes[node])) fail(node, "is not as whole as the most whole child");
    }

    void leaf(uint node, const Sphere& s) {
        const auto& octree = leaves.octree;
        const uint64_t key = octree.keys[node];
        const uvec3 at = octree_cell_of({uint(key), uint(key >> 32)});
        const BshBox box = bsh_decode_box(svo.boxes[node], s.radius);
        const SvoCell cell = svo_cell({uint(key), uint(key >> 32)}, input.cube, input.depth);
        uint missing = opacity_nothing;
        for (uint item = octree.first[node]; item < octree.first[node + 1]; ++item) {
            const uint triangle = leaves.voxels[octree.items[item - octree.nodes()]].triangle;
            const Corners& t = input.triangles[triangle];
            missing = std::min(missing, missing_of(input, triangle, svo_piece(t, cell), cell));
            const dvec3 normal = glm::cross(dvec3(t.p1) - dvec3(t.p0), dvec3(t.p2) - dvec3(t.p0));
            if (!(glm::length(normal) > 0) && svo.cones[node] >> 24 != 255) return fail(node, "a normal that does not exist has a cone");
            if (glm::length(normal) > 0 && !holds(cone_of(svo.cones[node]), {glm::normalize(normal), 0})) return fail(node, "its cone does not hold a normal");
            if (!(input.cube.cells_per_length > 0)) continue;
            for (const dvec3& corner : clipped_to_cell(t, input.cube, at, 0)) {
                const dvec3 p = dvec3(input.cube.origin) + (corner + dvec3(at)) / double(input.cube.cells_per_length);
                const dvec3 d = p - dvec3(s.center);
                if (glm::length(d) > double(s.radius)) return fail(node, "its sphere does not hold all of triangle " + std::to_string(triangle));
                const double step = 1e-6 * (glm::length(dvec3(s.center)) + double(s.radius));
                for (int axis = 0; axis < 3; ++axis)
                    if (d[axis] < double(box.low[axis]) - step || d[axis] > double(box.high[axis]) + step)
                        return fail(node, "its box does not hold all of triangle " + std::to_string(triangle));
            }
        }
        if (missing != bsh_missing(svo.boxes[node])) fail(node, "is not as whole as the most whole triangle");
    }
};

}  // namespace

std::string svo_check(const SvoArrays& svo, const SvoInput& input) {
    const Leaves leaves = leaves_of(input);
    const size_t nodes = leaves.octree.nodes();
    if (nodes == 0) return svo.blocks.empty() ? "" : "there is something where nothing is";
    const size_t inner = leaves.octree.level_first[input.depth];
    if (svo.depth != input.depth || svo.blocks.size() != inner + 1 || svo.spheres.size() != nodes || svo.cones.size() != nodes || svo.boxes.size() != nodes)
        return "not as many nodes as cells that are met";
    if (svo_children(svo.blocks[0]) != 1 || svo.blocks[0].first != 0) return "the root is not alone in its block";
    Check check{svo, input, leaves, std::vector<uint>(nodes), {}};
    check.visit(0, 0, 0);
    if (check.fault.empty() && std::ranges::count(check.reached, 1u) != int64_t(nodes)) return "not all nodes are reached";
    return check.fault;
}

}  // namespace myriad::compute
