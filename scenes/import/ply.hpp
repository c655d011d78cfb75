// PLY, the Stanford triangle format: what scanners and tools for meshes write. ASCII or binary, of either byte order.
//
// Read are vertices (positions, normals, colours, texture coordinates), faces of any number of corners, and triangle strips;
// other elements and properties are passed over. assimp reads PLY too, but loops forever on a third of truncated files.
#pragma once

#include <span>

#include "scenes/import/import.hpp"

namespace myriad::scenes::importing {

// The file may be compressed by gzip.
Imported import_ply(const std::string& path, const ImportOptions& options);

// The same from memory. Throws InputError that begins with `name`.
Imported read_ply(std::span<const uint8_t> bytes, const std::string& name, const ImportOptions& options);

}  // namespace myriad::scenes::importing
