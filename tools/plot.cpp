#include "tools/plot.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>

namespace myriad::tools {
namespace {

constexpr double width = 720, height = 360, left = 64, right = 16, top = 40, bottom = 48;

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value == 0 ? 0 : value);
    return text;
}

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '&') out += "&amp;";
        else if (c == '<') out += "&lt;";
        else if (c == '>') out += "&gt;";
        else if (c == '"') out += "&quot;";
        else out += c;
    }
    return out;
}

std::string text_at(double x, double y, const char* anchor, const std::string& text, const std::string& more = "") {
    return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + anchor + "\"" + more + ">" + escaped(text) + "</text>\n";
}

std::string stroke(double x0, double y0, double x1, double y1, const std::string& colour, double weight) {
    return "<path d=\"M" + number(x0) + " " + number(y0) + "L" + number(x1) + " " + number(y1) + "\" stroke=\"" + colour + "\" stroke-width=\"" +
           number(weight) + "\"/>\n";
}

// One axis: values to pixels.
struct Axis {
    std::vector<double> marks;
    double from, to;
    double operator()(double value) const { return from + (value - marks.front()) / (marks.back() - marks.front()) * (to - from); }
};

Axis axis(double low, double high, double from, double to, int count) {
    if (!(low < high)) low -= 0.5, high += 0.5;
    return {ticks(low, high, count), from, to};
}

}  // namespace

std::vector<double> ticks(double low, double high, int count) {
    assert(low < high && count > 0);
    const double raw = (high - low) / count, magnitude = std::pow(10, std::floor(std::log10(raw)));
    double step = 10 * magnitude;
    for (const double round : {5.0, 2.0, 1.0})
        if (raw <= round * magnitude) step = round * magnitude;
    std::vector<double> marks;
    const double first = std::floor(low / step), last = std::ceil(high / step);
    for (double i = first; i <= last; ++i) marks.push_back(i * step);
    return marks;
}

std::string to_svg(const Plot& plot) {
    double x_low = 0, x_high = 0, y_low = 0, y_high = 0;
    bool any = false;
    for (const Plot::Line& line : plot.lines)
        for (const Plot::Point& p : line.points) {
            x_low = any ? std::min(x_low, p.x) : p.x, x_high = any ? std::max(x_high, p.x) : p.x;
            y_low = std::min(y_low, p.y), y_high = std::max(y_high, p.y);
            any = true;
        }
    const Axis x = axis(x_low, x_high, left, width - right, 10), y = axis(y_low, y_high, height - bottom, top, 6);
    std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 720 360\" width=\"720\" height=\"360\" font-family=\"sans-serif\" "
                      "font-size=\"12\" fill=\"#222\">\n<rect width=\"720\" height=\"360\" fill=\"#fff\"/>\n";
    svg += text_at(left, 22, "start", plot.title, " font-size=\"14\"");
    for (const double mark : x.marks) {
        svg += stroke(x(mark), top, x(mark), height - bottom, "#eee", 1);
        svg += text_at(x(mark), height - bottom + 16, "middle", number(mark));
    }
    for (const double mark : y.marks) {
        svg += stroke(left, y(mark), width - right, y(mark), mark == 0 ? "#222" : "#ddd", 1);
        svg += text_at(left - 6, y(mark) + 4, "end", number(mark));
    }
    svg += text_at((left + width - right) / 2, height - 12, "middle", plot.x_label);
    svg += text_at(16, (top + height - bottom) / 2, "middle", plot.y_label, " transform=\"rotate(-90 16 " + number((top + height - bottom) / 2) + ")\"");
    double legend = width - right;
    for (auto line = plot.lines.rbegin(); line != plot.lines.rend(); ++line) {
        svg += text_at(legend, 22, "end", line->name);
        legend -= 8 * double(line->name.size()) + 8;
        svg += stroke(legend - 16, 18, legend, 18, line->colour, 2);
        legend -= 28;
    }
    for (const Plot::Line& line : plot.lines) {
        if (line.points.empty()) continue;
        svg += "<path fill=\"none\" stroke=\"" + line.colour + "\" stroke-width=\"1.5\" stroke-linejoin=\"round\" d=\"";
        for (size_t i = 0; i < line.points.size(); ++i) svg += (i ? "L" : "M") + number(x(line.points[i].x)) + " " + number(y(line.points[i].y));
        svg += "\"/>\n";
    }
    return svg + "</svg>\n";
}

}  // namespace myriad::tools
