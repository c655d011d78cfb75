// Sums of samples, pixel by pixel, and the image that they make.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/image.hpp"
#include "tools/reference/paths.hpp"

namespace myriad::reference {

// A sum in two floats, good to 48 bits: what a file can keep to the bit, so that a sum that was interrupted is the same as one that was not.
struct Sum {
    float high = 0, low = 0;
    double value() const { return double(high) + double(low); }
    void add(double x) {
        const double sum = value() + x;
        high = float(sum);
        low = float(sum - double(high));
    }
};

class Film {
public:
    Film(uint32_t width, uint32_t height) : width_(width), height_(height), sums_(size_t(width) * height) {}
    // Of an image() that kept its sums. InputError where it has none.
    explicit Film(const tools::Image& image);

    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }
    uint32_t samples() const { return samples_; }       // a pixel
    uint64_t dropped() const { return dropped_; }       // samples that were no number, counted as black: 0 unless the scene is extreme

    // One more sample of every pixel: add() them all, each once, from any thread, then end_pass().
    void add(size_t pixel, const Radiance& sample);
    void end_pass(uint64_t dropped) { ++samples_, dropped_ += dropped; }
    static bool finite(const Radiance& sample);

    // Means: R,G,B, direct and indirect; variance: that of the mean, from the samples' own, which is more than there is, for they are no
    // independent ones but well spread; 0 with one sample, of which it cannot be known. With the sums where `keep_sums`. Metadata say how many samples.
    tools::Image image(bool keep_sums) const;

private:
    static constexpr int planes = 12;  // R,G,B of the whole, direct, indirect, and squares of the whole
    static const std::array<std::string, planes>& names();

    uint32_t width_, height_, samples_ = 0;
    uint64_t dropped_ = 0;
    std::vector<std::array<Sum, planes>> sums_;
};

}  // namespace myriad::reference
