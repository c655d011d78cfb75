// Meshes.
#pragma once

#include "scenes/gltf/accessor.hpp"
#include "scenes/scene.hpp"

namespace myriad::scenes::gltf {

// Fills scene.meshes, one for each mesh of the file, however many instances show it; one that none of scene.instances shows
// stays empty. Primitives of points and lines are left out; `material` is none where a primitive has none.
void read_meshes(const Place& place, Scene& scene);

}  // namespace myriad::scenes::gltf
