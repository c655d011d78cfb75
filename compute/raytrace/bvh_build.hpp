// The tree on the host, before it goes to the device; see bvh.hpp.
#pragma once

#include <span>
#include <vector>

#include "compute/instances/world.hpp"
#include "compute/raytrace/bvh_pack.h"

namespace myriad::compute {

// How much the host spends on the tree: see README.md for when `best` pays.
enum class BvhQuality {
    quick,  // binned surface area heuristic
    best,   // and spatial splits: ~10 times the time, 30 % more triangles, occlusion rays up to 1.5 times as fast
};

struct BvhData {
    std::vector<BvhNode> nodes;           // nodes[0] is the root
    std::vector<BvhTriangle> triangles;   // in the order of leaves; spatial splits repeat some
    std::vector<Instance> instances;      // that nodes refer to: those that share, and one for all that is stored in world space
    uint depth = 0;                       // levels of nodes on the longest way down, at most bvh_max_depth; with instances bvh_max_stack
    uint dropped = 0;                     // stored triangles that no ray can hit: zero area, not finite, nowhere, or a copy of an earlier one
    bool asks = false;                    // some triangle does (bvh_asks)
};

// The same wherever it lies.
struct BvhParts {
    std::span<const BvhNode> nodes;
    std::span<const BvhTriangle> triangles;
    std::span<const Instance> instances;
    uint depth = 0, dropped = 0;
    bool asks = false;
    BvhParts() = default;
    BvhParts(const BvhData& data)
        : nodes(data.nodes), triangles(data.triangles), instances(data.instances), depth(data.depth), dropped(data.dropped), asks(data.asks) {}
};

// The same input gives the same bytes, whatever the number of threads (0: all there are). Fewer than 2^31 triangles.
BvhData build_bvh(const WorldTriangles& world, BvhQuality quality = BvhQuality::quick, uint32_t threads = 0);

BvhBox bvh_box(const BvhTriangle& triangle);

// What of a tree follows triangles that move (WorldTriangles::first_moving).
struct BvhMoving {
    std::vector<uvec2> triangles;         // their indices in the tree, and as stored
    std::vector<uint> nodes;              // above them, lowest level first
    std::vector<uint> level_ends;         // in `nodes`
    std::vector<BvhBox> boxes;            // by node: around its triangles; of instances that stand still, around what it is to the node above
};
BvhMoving bvh_moving(const WorldTriangles& world, const BvhParts& tree);

}  // namespace myriad::compute
