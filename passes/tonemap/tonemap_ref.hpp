// The plain CPU twin of the tone map.
#pragma once
#include "engine/shared.h"
namespace myriad::passes {
// One channel in bytes, 0 to 255, before it is rounded.
double tonemap_ref(double radiance, double exposure);
}  // namespace myriad::passes
