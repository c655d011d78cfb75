#include "tools/plot.hpp"

#include <gtest/gtest.h>
#include <pugixml.hpp>

namespace myriad::tools {
namespace {

TEST(plot, ticks_are_round_and_span) {
    EXPECT_EQ(ticks(0, 10, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
    EXPECT_EQ(ticks(-3, 47, 5), (std::vector<double>{-10, 0, 10, 20, 30, 40, 50}));
    for (const auto& [low, high] : {std::pair{0.0, 1e-7}, {1e6, 1e6 + 3}, {-2e9, 5.0}, {0.0, 0.9999}}) {
        const std::vector<double> marks = ticks(low, high, 8);
        EXPECT_TRUE(marks.front() <= low && marks.back() >= high) << low << " " << high;
        EXPECT_TRUE(marks.size() >= 3 && marks.size() <= 20) << marks.size();
    }
}

TEST(plot, draws_each_point_of_each_line) {
    const Plot plot{"a < b & c", "frame", "ms", {{"one", "#f00", {{1, 0}, {2, 5}, {3, 2}}}, {"none", "#0f0", {}}, {"flat", "#00f", {{1, 5}, {3, 5}}}}};
    const std::string svg = to_svg(plot);
    pugi::xml_document document;
    ASSERT_TRUE(document.load_string(svg.c_str()));
    std::vector<std::string> lines;
    for (const auto& path : document.child("svg").children("path"))
        if (std::string(path.attribute("fill").value()) == "none") lines.push_back(path.attribute("d").value());
    ASSERT_EQ(lines.size(), 2u) << svg;
    // x from 1 to 3 over 64 … 704, y from 0 to 5 over 312 … 40.
    EXPECT_EQ(lines[0], "M64 312L384 40L704 203.2");
    EXPECT_EQ(lines[1], "M64 40L704 40");
    EXPECT_EQ(std::string(document.child("svg").child("text").text().get()), "a < b & c");
    EXPECT_EQ(svg, to_svg(plot));
}

TEST(plot, nothing_and_one_point_are_plots_too) {
    for (const Plot& plot : {Plot{}, Plot{"", "", "", {{"x", "#000", {{4, 0}}}}}}) {
        const std::string svg = to_svg(plot);
        EXPECT_EQ(svg.find("nan"), std::string::npos) << svg;
        EXPECT_EQ(svg.find("inf"), std::string::npos) << svg;
    }
}

}  // namespace
}  // namespace myriad::tools
