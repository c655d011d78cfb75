#include "tools/plot.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>

#include "tools/xml.hpp"

namespace myriad::tools {
namespace {

constexpr double width = 720, left = 64, right = 16, bottom = 48, plot_height = 272, legend_line = 18;

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value == 0 ? 0 : value);
    return text;
}

// Of a logarithmic axis, whose numbers are long: 20k, 5M.
std::string mark_number(double value, bool logarithmic) {
    if (logarithmic && value >= 1e6) return number(value / 1e6) + "M";
    if (logarithmic && value >= 1e3) return number(value / 1e3) + "k";
    return number(value);
}

std::string text_at(double x, double y, const char* anchor, const std::string& text, const std::string& more = "") {
    return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + anchor + "\"" + more + ">" + xml_escaped(text) + "</text>\n";
}

std::string stroke(double x0, double y0, double x1, double y1, const std::string& colour, double weight) {
    return "<path d=\"M" + number(x0) + " " + number(y0) + "L" + number(x1) + " " + number(y1) + "\" stroke=\"" + colour + "\" stroke-width=\"" +
           number(weight) + "\"/>\n";
}

// One axis: values to pixels.
struct Axis {
    std::vector<double> marks;
    double from, to;
    bool logarithmic;
    double scale(double value) const { return logarithmic ? std::log10(value) : value; }
    double operator()(double value) const {
        return from + (scale(value) - scale(marks.front())) / (scale(marks.back()) - scale(marks.front())) * (to - from);
    }
};

Axis axis(double low, double high, double from, double to, int count, bool logarithmic) {
    if (logarithmic) {
        if (!(low > 0)) low = high = 1;  // no line has a point
        if (!(low < high)) low /= 2, high *= 2;
        return {log_ticks(low, high), from, to, true};
    }
    if (!(low < high)) low -= 0.5, high += 0.5;
    return {ticks(low, high, count), from, to, false};
}

double name_width(const Plot::Line& line) { return 8 * double(line.name.size()) + 36; }

// The lines whose names stand in the title's line, in each of those below it: all there where they fit, none otherwise.
std::vector<size_t> legend_lines(const Plot& plot) {
    double all = 0;
    for (const Plot::Line& line : plot.lines) all += name_width(line);
    if (all + 8 * double(plot.title.size()) <= width - left - right) return {plot.lines.size()};
    std::vector<size_t> counts = {0};
    double used = width;
    for (const Plot::Line& line : plot.lines) {
        if (used + name_width(line) > width - left - right) counts.push_back(0), used = 0;
        used += name_width(line);
        ++counts.back();
    }
    return counts;
}

std::string path_of(const Plot::Line& line, size_t first, size_t end, const Axis& x, const Axis& y, const char* more) {
    if (end - first < 1) return "";
    std::string svg = "<path fill=\"none\" stroke=\"" + line.colour + "\" stroke-width=\"1.5\" stroke-linejoin=\"round\"" + more + " d=\"";
    for (size_t i = first; i < end; ++i) svg += (i > first ? "L" : "M") + number(x(line.points[i].x)) + " " + number(y(line.points[i].y));
    return svg + "\"/>\n";
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

std::vector<double> log_ticks(double low, double high) {
    assert(0 < low && low < high);
    std::vector<double> marks;
    const double first = std::floor(std::log10(low)), last = std::ceil(std::log10(high));
    for (double decade = first; decade <= last; ++decade)
        for (const double round : {1.0, 2.0, 5.0})
            if (round == 1 || last - first <= 5) marks.push_back(round * std::pow(10, decade));
    while (marks.size() > 1 && marks[1] <= low) marks.erase(marks.begin());
    while (marks.size() > 1 && marks[marks.size() - 2] >= high) marks.pop_back();
    return marks;
}

std::string to_svg(const Plot& plot) {
    double x_low = 0, x_high = 0, y_low = 0, y_high = 0;
    bool any = false;
    for (const Plot::Line& line : plot.lines)
        for (const Plot::Point& p : line.points) {
            x_low = any ? std::min(x_low, p.x) : p.x, x_high = any ? std::max(x_high, p.x) : p.x;
            y_low = any || !plot.logarithmic ? std::min(y_low, p.y) : p.y, y_high = std::max(y_high, p.y);
            any = true;
        }
    const std::vector<size_t> legends = legend_lines(plot);
    const double top = 40 + legend_line * double(legends.size() - 1), height = top + plot_height + bottom;
    const Axis x = axis(x_low, x_high, left, width - right, 10, plot.logarithmic), y = axis(y_low, y_high, height - bottom, top, 6, plot.logarithmic);
    const std::string size = number(height);
    std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 720 " + size + "\" width=\"720\" height=\"" + size +
                      "\" font-family=\"sans-serif\" font-size=\"12\" fill=\"#222\">\n<rect width=\"720\" height=\"" + size + "\" fill=\"#fff\"/>\n";
    svg += text_at(left, 22, "start", plot.title, " font-size=\"14\"");
    for (const double mark : x.marks) {
        svg += stroke(x(mark), top, x(mark), height - bottom, "#eee", 1);
        svg += text_at(x(mark), height - bottom + 16, "middle", mark_number(mark, plot.logarithmic));
    }
    for (const double mark : y.marks) {
        svg += stroke(left, y(mark), width - right, y(mark), mark == 0 ? "#222" : "#ddd", 1);
        svg += text_at(left - 6, y(mark) + 4, "end", mark_number(mark, plot.logarithmic));
    }
    svg += text_at((left + width - right) / 2, height - 12, "middle", plot.x_label);
    svg += text_at(16, (top + height - bottom) / 2, "middle", plot.y_label, " transform=\"rotate(-90 16 " + number((top + height - bottom) / 2) + ")\"");
    size_t end = 0;
    for (size_t i = 0; i < legends.size(); ++i) {
        const size_t first = end;
        end += legends[i];
        double legend = width - right;
        for (size_t l = end; l-- > first;) {
            const Plot::Line& line = plot.lines[l];
            legend -= name_width(line) - 28;  // the name begins beside its swatch, however wide the letters are
            svg += text_at(legend + 6, 22 + legend_line * double(i), "start", line.name);
            svg += stroke(legend - 16, 18 + legend_line * double(i), legend, 18 + legend_line * double(i), line.colour, 2);
            legend -= 28;
        }
    }
    for (const Plot::Line& line : plot.lines) {
        if (line.points.empty()) continue;
        const size_t solid = std::min(line.solid, line.points.size());
        svg += path_of(line, 0, solid, x, y, "");
        if (solid < line.points.size()) svg += path_of(line, solid - (solid > 0), line.points.size(), x, y, " stroke-dasharray=\"2 4\"");
    }
    return svg + "</svg>\n";
}

}  // namespace myriad::tools
