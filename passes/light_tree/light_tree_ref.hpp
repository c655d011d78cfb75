// The plain CPU twin of the light tree, and what must hold of any.
#pragma once

#include <string>
#include <vector>

#include "compute/view_tree/view_tree_ref.hpp"
#include "passes/light_tree/light_tree_io.h"

namespace myriad::passes {

struct HostLightTree {
    compute::HostViewTree views;
    std::vector<Vpl> lights;        // in the tree's order
    std::vector<LightNode> nodes;   // by number; those of no view and no inner node are undefined
};

// Views as the VPLs' own: hemispheres around their normals; of those that are dead, of nothing.
std::vector<View> light_views(const std::vector<Vpl>& lights);
HostLightTree light_tree_ref(const std::vector<Vpl>& lights, uint32_t capacity, vec3 low, vec3 high);

// The first thing that is wrong: spheres hold lights, cones hold normals, flux is the sum of what is below. Empty: nothing.
std::string light_tree_violation(const HostLightTree& tree);

}  // namespace myriad::passes
