// URIs in a file, which may name files beside it and nothing else.
#pragma once

#include <string>

#include "scenes/gltf/accessor.hpp"

namespace myriad::scenes::gltf {

// The bytes that a URI stands for: those of a data URI, or of a regular file in the scene's folder or below. Refused in
// one sentence: other schemes, absolute paths, paths and symbolic links that leave the folder, control characters.
// Percent-encoding is undone once; backslashes, which exporters on Windows write, are slashes.
Bytes read_uri(const Place& place, const std::string& uri);

// What read_uri() opens, in canonical form: two URIs are the same file when these are equal. "" for a data URI.
std::string file_of_uri(const Place& place, const std::string& uri);

}  // namespace myriad::scenes::gltf
