// KHR_draco_mesh_compression, decoded here because Debian builds tinygltf without Draco.
#pragma once

#include "scenes/gltf/skin.hpp"
#include "scenes/gltf/value.hpp"
#include "scenes/scene.hpp"

namespace myriad::scenes::gltf {

inline constexpr const char* draco_extension = "KHR_draco_mesh_compression";

// Attributes and indices of a Draco primitive; indices may still be out of range. `joints`: those are wanted too.
Primitive decode_draco(const Place& place, const tinygltf::Primitive& primitive, const tinygltf::Value& extension, JointSets* joints = nullptr);

}  // namespace myriad::scenes::gltf
