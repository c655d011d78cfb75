// Which nodes a refit visits, found once.
#include <algorithm>

#include "compute/raytrace/bvh_build.hpp"

namespace myriad::compute {
namespace {

struct Search {
    const WorldTriangles& world;
    const BvhParts& tree;
    BvhMoving& found;
    std::vector<std::vector<uint>> levels;  // from the root down

    bool moving_leaf(uint first, uint count, BvhBox& box) {
        bool any = false;
        for (uint k = first; k < first + count; ++k) {
            const BvhTriangle& t = tree.triangles[k];
            box = k == first ? bvh_box(t) : bvh_united(box, bvh_box(t));
            // What moves stands in the world, so its id does, too.
            const uint id = t.id & ~bvh_asks, stored = world.shared() ? world.place(id).triangle : id;
            if (!world.moves(stored)) continue;
            found.triangles.emplace_back(k, stored);
            any = true;
        }
        return any;
    }

    // Whether anything below moves. Meshes that instances share are not entered.
    bool visit(uint index, uint level) {
        const BvhNode& node = tree.nodes[index];
        bool moves = false;
        if (bvh_children(node.frame) == bvh_is_instance) {
            if ((tree.instances[node.first_triangle].flags & instance_in_world) == 0) return false;
            moves = visit(node.first_child, level + 1);
        }
        else for (uint i = 0; i < bvh_children(node.frame); ++i) {
            const uint count = node.child[i].x >> 24;
            const vec3 scale = bvh_scale(node.frame);
            BvhBox box{bvh_corner(node.origin, scale, node.child[i].x), bvh_corner(node.origin, scale, node.child[i].y)};
            if (count > 0) {
                moves = moving_leaf(node.first_triangle + (node.child[i].y >> 24), count, box) || moves;
            } else {
                const uint child = node.first_child + i;
                found.boxes[child] = box;  // for instances
                moves = visit(child, level + 1) || moves;
                box = found.boxes[child];
            }
            found.boxes[index] = i == 0 ? box : bvh_united(found.boxes[index], box);
        }
        if (!moves) return false;
        levels.resize(std::max<size_t>(levels.size(), level + 1));
        levels[level].push_back(index);
        return true;
    }
};

}  // namespace

BvhMoving bvh_moving(const WorldTriangles& world, const BvhParts& tree) {
    BvhMoving found;
    found.boxes.resize(tree.nodes.size());
    Search search{world, tree, found, {}};
    search.visit(0, 0);
    for (size_t level = search.levels.size(); level-- > 0;) {
        // Neighbours in memory are neighbours in time.
        std::sort(search.levels[level].begin(), search.levels[level].end());
        found.nodes.insert(found.nodes.end(), search.levels[level].begin(), search.levels[level].end());
        found.level_ends.push_back(uint(found.nodes.size()));
    }
    return found;
}

}  // namespace myriad::compute
