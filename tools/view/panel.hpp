// The panel beside the picture: everything that can be chosen.
#pragma once

#include <imgui.h>

#include "tools/view/state.hpp"

namespace myriad::tools::view {

float panel_width(const State& state);  // pixels; 0 while it is hidden

// The command line that makes this image, to the clipboard.
void copy_command(State& state, const ImVec2& image);

void show_panel(State& state, const Status& status, const std::shared_ptr<const Shown>& shown, const ImVec2& image);

}  // namespace myriad::tools::view
