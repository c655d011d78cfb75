// What the viewer keeps from run to run, in $XDG_CONFIG_HOME/myriad/view.json.
#pragma once

#include <filesystem>

#include "tools/view/state.hpp"

namespace myriad::tools::view {

std::filesystem::path config_file();  // empty: there is no home for it
// What can be read of it; what cannot is as if it had never been kept.
Remembered recall(const std::filesystem::path& file);
void remember(const std::filesystem::path& file, const Remembered& kept);  // throws InputError

}  // namespace myriad::tools::view
