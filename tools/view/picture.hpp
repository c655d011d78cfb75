// What lies over and around the image: the image itself, what goes on, messages, help.
#pragma once

#include <imgui.h>

#include "tools/view/raster.hpp"
#include "tools/view/state.hpp"

namespace myriad::tools::view {

struct Area {
    ImVec2 low, high;
    ImVec2 size() const { return {high.x - low.x, high.y - low.y}; }
};

// What the panel leaves of the window.
Area picture_area(const State& state);

// Where an image of that size goes in it: as large as it can be, in the middle.
Area fitted(const Area& area, uint32_t width, uint32_t height);

void show_picture(const Area& area, const Texture& picture);
void show_status(const State& state, const Area& area, const Status& status, const Shown* shown);
void show_message(State& state, const Area& area, const Status& status);
void show_help(State& state);

}  // namespace myriad::tools::view
