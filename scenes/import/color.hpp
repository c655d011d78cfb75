#pragma once

#include <cmath>

namespace myriad::scenes::importing {

// IEC 61966-2-1, from 0 to 1.
inline float linear_of_srgb(float v) { return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f); }

}  // namespace myriad::scenes::importing
