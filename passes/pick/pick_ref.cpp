#include "passes/pick/pick_ref.hpp"

#include <functional>

namespace myriad::passes {

std::vector<PickTile> pick_tiles_ref(const HostGBuffer& g, uint side) {
    std::vector<PickTile> tiles;
    for (uint y0 = 0; y0 < g.height; y0 += side)
        for (uint x0 = 0; x0 < g.width; x0 += side) {
            std::vector<size_t> receivers;
            for (uint y = y0; y < std::min(y0 + side, g.height); ++y)
                for (uint x = x0; x < std::min(x0 + side, g.width); ++x)
                    if (g.hit(size_t(y) * g.width + x)) receivers.push_back(size_t(y) * g.width + x);
            vec3 low(3e38f), high(-3e38f), sum(0);
            for (size_t i : receivers) low = min(low, g.position(i)), high = max(high, g.position(i)), sum += g.shading(i);
            PickTile tile = pick_tile_begin(low, high, sum);
            for (size_t i : receivers) tile = pick_tile_add(tile, g.position(i), g.shading(i));
            tiles.push_back(pick_tile_end(tile));
        }
    return tiles;
}

PickChances pick_tree_ref(const HostLightTree& tree, const PickTile& tile, float bound, uint weights) {
    PickChances chances{std::vector<double>(tree.lights.size(), 0)};
    // Of inner nodes that are weighed from below, what their children may bring, who may be such nodes only where they all are.
    const std::function<double(uint)> importance = [&](uint number) {
        const auto estimate = [&](uint n) { return double(pick_importance(tile, tree.nodes[n], bound)); };
        if (tree.views.is_view(number) || number - tree.views.capacity >= weights) return estimate(number);
        const ViewGroup& group = tree.views.group(number);
        const uint end = group.first_child + group.children;
        const bool summed = !tree.views.is_view(group.first_child) && end - tree.views.capacity <= weights;
        double sum = 0;
        for (uint child = group.first_child; child < end; ++child) sum += summed ? importance(child) : estimate(child);
        return sum;
    };
    const std::function<void(uint, double)> walk = [&](uint number, double probability) {
        if (tree.views.is_view(number)) return void(chances.vpl[number] = probability);
        const ViewGroup& group = tree.views.group(number);
        std::vector<double> each;
        double sum = 0;
        for (uint i = 0; i < group.children; ++i) each.push_back(importance(group.first_child + i)), sum += each.back();
        if (sum == 0) return void(chances.none += probability);
        for (uint i = 0; i < group.children; ++i) walk(group.first_child + i, probability * each[i] / sum);
    };
    if (!chances.vpl.empty() && tile.radius >= 0) walk(tree.views.capacity, 1);
    else chances.none = 1;
    return chances;
}

PickChances pick_culled_ref(const HostLightTree& tree, const PickTile& tile, float reach) {
    PickChances chances{std::vector<double>(tree.lights.size(), 0)};
    double remain = 0;
    const std::function<void(uint)> walk = [&](uint number) {
        const ViewGroup& group = tree.views.group(number);
        if (pick_culled(tile, tree.nodes[number], reach)) return;
        for (uint i = 0; i < group.children; ++i)
            if (tree.views.is_view(group.first_child + i)) chances.vpl[group.first_child + i] = 1, ++remain;
            else walk(group.first_child + i);
    };
    if (!chances.vpl.empty()) walk(tree.views.capacity);
    for (double& v : chances.vpl) v = remain > 0 ? v / remain : 0;
    chances.none = remain == 0;
    return chances;
}

}  // namespace myriad::passes
