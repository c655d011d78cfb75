// One image beside another, or how far apart they are; and the lights over the picture.
#pragma once

#include "tools/view/picture.hpp"

namespace myriad::tools::view {

// What the panel says of it.
void compare_part(State& state, const std::shared_ptr<const Shown>& shown);
// Over the picture: what is kept, left of the wipe, or the heat map.
void show_comparison(State& state, const Area& area, const std::shared_ptr<const Shown>& shown);

// How far pixels are off: the root of relMSE's terms, of the channel where that is largest. Of images of one size.
std::vector<float> relative_errors(const Image& reference, const Image& test);

// Discs where VPLs are, as large as their flux, of its colour; rings where something is before them.
void show_lights(const Area& area, const Shown& shown);

}  // namespace myriad::tools::view
