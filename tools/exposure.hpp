// How bright to show a scene-referred image.
#pragma once

#include "tools/image.hpp"

namespace myriad::tools {

// The factor on radiance that brings the geometric mean of the luminance of all pixels that are not black to middle grey,
// 0.18, after the tone map's curve (passes/tonemap). 1 for a black image. Summed in double in row order.
double auto_exposure(const Image::Rgb& radiance);

}  // namespace myriad::tools
