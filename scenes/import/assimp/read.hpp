// Wavefront OBJ, STL, FBX and Collada through assimp, which reads them in a process of its own (apart.hpp).
#pragma once

#include "scenes/import/import.hpp"

namespace myriad::scenes::importing {

Imported read_assimp(const std::string& path, const ImportOptions& options);

}  // namespace myriad::scenes::importing
