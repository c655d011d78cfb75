// Materials and textures.
#pragma once

#include "scenes/gltf/accessor.hpp"
#include "scenes/scene.hpp"

namespace myriad::scenes::gltf {

// Fills scene.materials and scene.textures: one texture for each glTF texture that a material uses as colour,
// metallic-roughness or emission (normal and occlusion maps are not rendered, and so not decoded).
void read_materials(const Place& place, Scene& scene);

}  // namespace myriad::scenes::gltf
