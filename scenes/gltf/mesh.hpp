// Meshes.
#pragma once

#include "scenes/gltf/accessor.hpp"
#include "scenes/scene.hpp"

namespace myriad::scenes::gltf {

// Fills scene.meshes, one for each mesh of the file, however many nodes show it; primitives of points and lines are left
// out. Needs scene.materials, and adds glTF's default material where a primitive has none.
void read_meshes(const Place& place, Scene& scene);

}  // namespace myriad::scenes::gltf
