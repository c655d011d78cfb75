// Line plots for reports, as SVG: numbers to look at. They are measured elsewhere.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace myriad::tools {

struct Plot {
    struct Point {
        double x = 0, y = 0;
    };
    struct Line {
        std::string name, colour;     // as SVG writes it
        std::vector<Point> points;    // finite, in the order they are joined
        size_t solid = ~size_t(0);    // so many points are joined by a line, those after them by dots: they were not measured
    };
    std::string title, x_label, y_label;
    std::vector<Line> lines;
    bool logarithmic = false;         // both axes; all values are positive
};

// 720 wide and 360 high, or more where names need lines of their own. Linear axes: y from 0 (or the least value, where that is negative).
// Same bytes for the same plot.
std::string to_svg(const Plot& plot);

// About `count` round numbers that span [low, high], one step beyond at most; low < high.
std::vector<double> ticks(double low, double high, int count);

// 1, 2 and 5 times powers of ten that span [low, high], or powers of ten alone where that is more than five decades; 0 < low < high.
std::vector<double> log_ticks(double low, double high);

}  // namespace myriad::tools
