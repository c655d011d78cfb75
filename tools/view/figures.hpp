// What an image took, in numbers and bars.
#pragma once

#include "tools/view/state.hpp"

namespace myriad::tools::view {

void show_figures(const State& state, const Shown& shown, const Status& status);

}  // namespace myriad::tools::view
