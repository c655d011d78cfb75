// Which images are made of a wish, one after the other: something soon, and in the end what `render` makes.
#pragma once

#include "tools/view/wishes.hpp"

namespace myriad::tools::view {

// How much smaller than the wish the picture is that is shown while things move, found by measuring: each rung of `divisors` is one.
class Pace {
public:
    static constexpr double most_ms = 60;   // to render; the window, and the input, take the rest of 100 ms
    static constexpr uint32_t divisors[] = {1, 2, 3, 4, 5, 6, 8, 10, 12, 16};

    explicit Pace(uint32_t divisor = 6);
    uint32_t divisor() const { return divisors[rung_]; }
    // What a picture of that divisor has taken. Whether another divisor should be used from now on.
    bool measured(uint32_t divisor, double ms);

private:
    size_t rung_ = 0;
};

// The wish, cheaper: few VPLs, small maps that stay as long as only the camera moves, few of them a pixel.
Texts preview(const std::string& scene, const Texts& texts, uint32_t width, uint32_t height, uint32_t divisor);
// The wish itself, divisor times smaller a side.
Texts sized(const Texts& texts, uint32_t width, uint32_t height, uint32_t divisor);

// The images of a wish, in order. `last_ms`: what the last of them took last time, 0: not known.
std::vector<Texts> ladder(const std::string& scene, const Texts& texts, uint32_t width, uint32_t height, bool moving, uint32_t divisor, double last_ms);

}  // namespace myriad::tools::view
