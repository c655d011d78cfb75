// Environment maps from files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/environment.hpp"

namespace myriad::tools {

// Reads an equirectangular picture, OpenEXR or Radiance as its first bytes say, and multiplies it by `strength`. Texels that are not a
// number, negative or beyond 1e9 become 0, 0 and 1e9; a warning counts them. InputError as of read_exr and read_rgbe, where there is no colour, or
// where the picture is not twice as wide as high.
scenes::Environment read_environment(const std::filesystem::path& path, float strength, double rotation, std::vector<std::string>& warnings);

}  // namespace myriad::tools
