#include "tools/plot.hpp"

#include <map>

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

TEST(plot, logarithmic_ticks_are_round_and_span) {
    EXPECT_EQ(log_ticks(1024, 65536), (std::vector<double>{1000, 2000, 5000, 10000, 20000, 50000, 100000}));
    EXPECT_EQ(log_ticks(2, 50), (std::vector<double>{2, 5, 10, 20, 50}));
    EXPECT_EQ(log_ticks(3, 3.5), (std::vector<double>{2, 5}));
    EXPECT_EQ(log_ticks(0.5, 2e6), (std::vector<double>{0.1, 1, 10, 100, 1000, 1e4, 1e5, 1e6, 1e7}));
}

TEST(plot, logarithmic_axes_and_dots_from_where_nothing_was_measured) {
    Plot plot{"", "views", "ms", {{"one", "#f00", {{1, 1}, {10, 10}, {100, 100}}, 2}, {"guessed", "#0f0", {{1, 10}, {100, 100}}, 0}}, true};
    const std::string svg = to_svg(plot);
    pugi::xml_document document;
    ASSERT_TRUE(document.load_string(svg.c_str()));
    std::vector<std::string> solid, dotted;
    for (const auto& path : document.child("svg").children("path"))
        if (std::string(path.attribute("fill").value()) == "none")
            (path.attribute("stroke-dasharray") ? dotted : solid).push_back(path.attribute("d").value());
    EXPECT_EQ(solid, (std::vector<std::string>{"M64 312L384 176"}));
    EXPECT_EQ(dotted, (std::vector<std::string>{"M384 176L704 40", "M64 176L704 40"}));
    plot.lines = {{"long", "#000", {{500, 100}, {2e6, 2e6}}}};
    for (const char* mark : {">500<", ">1k<", ">200k<", ">2M<"}) EXPECT_NE(to_svg(plot).find(mark), std::string::npos) << mark;
    plot.lines.clear();
    EXPECT_EQ(to_svg(plot).find("nan"), std::string::npos);
    plot.lines = {{"x", "#000", {{4, 3}}}};
    EXPECT_EQ(to_svg(plot).find("nan"), std::string::npos);
}

// Names that do not fit beside the title stand below it, and the plot lies lower.
TEST(plot, many_names_take_lines_of_their_own) {
    Plot plot{"a title", "", "", {}};
    for (int i = 0; i < 6; ++i) plot.lines.push_back({"a rather long name", "#000", {{0, 0}, {1, 1}}});
    const std::string svg = to_svg(plot);
    pugi::xml_document document;
    ASSERT_TRUE(document.load_string(svg.c_str()));
    EXPECT_EQ(std::string(document.child("svg").attribute("height").value()), "396");
    std::map<double, int> names;  // by y
    for (const auto& text : document.child("svg").children("text"))
        if (std::string(text.text().get()) == "a rather long name") {
            ++names[text.attribute("y").as_double()];
            EXPECT_GT(text.attribute("x").as_double(), 64 + 16) << svg;           // beside its swatch, right of the axis
            EXPECT_LE(text.attribute("x").as_double() + 8 * 18, 720 - 16) << svg;  // letters are narrower
        }
    EXPECT_EQ(names, (std::map<double, int>{{40, 3}, {58, 3}}));
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
