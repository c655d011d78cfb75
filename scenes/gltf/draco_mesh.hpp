// Draco's decoders, kept from taking more memory than the file may ask for.
#pragma once

#include <memory>

#include <draco/mesh/mesh.h>

#include "scenes/gltf/accessor.hpp"

namespace myriad::scenes::gltf {

// The mesh in a Draco stream of version 2.2, which is glTF's. Throws InputError where it is damaged or out of proportion.
std::unique_ptr<draco::Mesh> decode_draco_mesh(const Place& place, Range bytes);

}  // namespace myriad::scenes::gltf
