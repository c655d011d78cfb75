// EXT_meshopt_compression: buffer views whose bytes are decoded when they are first asked for.
#pragma once

#include "scenes/gltf/value.hpp"

namespace myriad::scenes::gltf {

inline constexpr const char* meshopt_extension = "EXT_meshopt_compression";

// The bytes of buffer view `index`, which `extension` says how to decode; decoded once a document, and paid from its
// budget. `place` is the buffer view.
Range decode_meshopt(const Place& place, int index, const tinygltf::Value& extension);

}  // namespace myriad::scenes::gltf
