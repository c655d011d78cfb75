// Animations: clips, their channels and keys.
#pragma once

#include "scenes/gltf/nodes.hpp"

namespace myriad::scenes::gltf {

// Fills scene.clips, one for each of the file's animations. A channel that moves no node of the scene is left out, and so is one
// that moves what Myriad does not know. Needs the nodes' weights.
void read_animations(const Place& place, const Hierarchy& hierarchy, Scene& scene);

// Keeps of scene.nodes those that something hangs from which can move or is skinned or morphed, or that a clip moves; what stands
// still forgets its node. In a scene where nothing can move none is left.
void prune_nodes(Scene& scene);

}  // namespace myriad::scenes::gltf
