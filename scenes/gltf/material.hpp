// Materials.
#pragma once

#include "scenes/gltf/accessor.hpp"
#include "scenes/scene.hpp"

namespace myriad::scenes::gltf {

// Fills scene.materials, and scene.textures with those that a material of scene.meshes uses. Adds glTF's default material
// where a primitive has none. Occlusion maps are not read: occlusion is what is rendered.
void read_materials(const Place& place, Scene& scene);

}  // namespace myriad::scenes::gltf
