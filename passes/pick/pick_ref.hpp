// The plain CPU twin of the picks: bounds of tiles, and with what probability each VPL is picked.
#pragma once

#include <vector>

#include "passes/gather/host_gbuffer.hpp"
#include "passes/light_tree/light_tree_ref.hpp"
#include "passes/pick/pick.hpp"

namespace myriad::passes {

std::vector<PickTile> pick_tiles_ref(const HostGBuffer& gbuffer, uint side);

// Of a tile. `vpl`, in the tree's order: the probability of each pick to be it, by recursion from the root. `none`: to end at a node whose children, unlike
// itself, are sure to bring nothing.
struct PickChances {
    std::vector<double> vpl;
    double none = 0;
};
PickChances pick_tree_ref(const HostLightTree& tree, const PickTile& tile, float bound, uint weights);
PickChances pick_culled_ref(const HostLightTree& tree, const PickTile& tile, float reach);

}  // namespace myriad::passes
