// The plain CPU twin of sharing: maps of all view nodes in, maps of views out.
#pragma once

#include <vector>

#include "compute/view_tree/view_tree_ref.hpp"
#include "passes/fuse/fuse_io.h"

namespace myriad::passes {

// `maps`: of every node of the tree, map_texels(map_size) words each; what is drawn for a node is in its own. A node without any has an empty one.
// Returns the maps of the views, in the tree's order.
std::vector<uint> fuse_ref(const compute::HostViewTree& tree, std::vector<uint> maps, const std::vector<bool>& has_map, uint map_size);

}  // namespace myriad::passes
