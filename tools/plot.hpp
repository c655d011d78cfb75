// Line plots for reports, as SVG: numbers to look at. They are measured elsewhere.
#pragma once

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
    };
    std::string title, x_label, y_label;
    std::vector<Line> lines;
};

// 720 x 360, both axes linear, y from 0 (or the least value, where that is negative). Same bytes for the same plot.
std::string to_svg(const Plot& plot);

// About `count` round numbers that span [low, high], one step beyond at most; low < high.
std::vector<double> ticks(double low, double high, int count);

}  // namespace myriad::tools
