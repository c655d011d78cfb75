// FLIP: how visible the difference of two images is to a person who flips between them.
//   LDR: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild: "FLIP: A Difference Evaluator for Alternating Images" (2020)
//   HDR: Andersson, Nilsson, Shirley, Akenine-Möller: "Visualizing Errors in Rendered High Dynamic Range Images" (2021)
// A pixel's error is in [0, 1]: 0 is not to be seen, 1 is green against blue. Symmetric but for the exposures of HDR-FLIP, which
// are the reference's.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/image.hpp"

namespace myriad::tools {

// Pixels per degree of the papers' observer: 0.7 m before a monitor that is 0.7 m wide and has 3840 pixels across.
constexpr double flip_ppd = 3840 * 3.14159265358979323846 / 180;
constexpr float flip_least_ppd = 1, flip_most_ppd = 1000;

// Of images clamped to [0, 1] as a display shows them. Values are linear: that they are encoded as sRGB for the display and
// decoded in the eye cancels out. NaN counts as 0, and is the caller's to refuse.
std::vector<float> ldr_flip(const Image::Rgb& reference, const Image::Rgb& test, uint32_t width, uint32_t height, double ppd = flip_ppd);

// The exposures, in stops, at which HDR-FLIP looks, evenly spaced: from the one that tone maps the reference's greatest luminance to
// 0.85 to the one that does so with its median, at least 2 where those differ. Where the median is 0 it is taken of luminances above 0
// instead; a black reference is looked at as it is.
struct FlipExposures {
    double first = 0, last = 0;
    uint32_t count = 1;
};
FlipExposures flip_exposures(const Image::Rgb& reference);

// A pixel's greatest LDR-FLIP over those exposures, after the ACES tone map (Narkowicz's fit, with its exposure of 0.6). Infinite
// and negative values count as the brightest and as black.
std::vector<float> hdr_flip(const Image::Rgb& reference, const Image::Rgb& test, uint32_t width, uint32_t height, double ppd = flip_ppd);

}  // namespace myriad::tools
