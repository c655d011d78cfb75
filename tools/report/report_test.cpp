#include "tools/report/report.hpp"

#include <gtest/gtest.h>

namespace myriad::tools {
namespace {

Trial trial(const char* group, double seconds, double error) { return {group, "t", "--x \"1\" <2>", {seconds}, {{"E", error}}}; }

TEST(Report, the_front_is_what_nothing_else_beats) {
    const std::vector<Trial> trials = {trial("a", 3, 1), trial("a", 1, 5), trial("a", 2, 5), trial("b", 0.5, 0.1), trial("a", 2, 2), trial("a", 4, 2), trial("a", 2, 2), trial("a", 9, 1)};
    EXPECT_EQ(pareto_front(trials, "a", "E"), (std::vector<size_t>{1, 4, 0}));
    EXPECT_EQ(pareto_front(trials, "b", "E"), (std::vector<size_t>{3}));
    EXPECT_TRUE(pareto_front(trials, "c", "E").empty());
    EXPECT_TRUE(pareto_front(trials, "a", "F").empty());
}

TEST(Report, the_best_within_a_budget) {
    const std::vector<Trial> trials = {trial("a", 1, 5), trial("a", 2, 2), trial("a", 3, 4)};
    EXPECT_EQ(best_within(trials, "a", "E", 0.5), std::nullopt);
    EXPECT_EQ(best_within(trials, "a", "E", 1), 0u);
    EXPECT_EQ(best_within(trials, "a", "E", 1.9), 0u);
    EXPECT_EQ(best_within(trials, "a", "E", 100), 1u);
}

TEST(Report, medians_not_means) {
    Trial t = trial("a", 1, 1);
    t.runs = {9, 1, 2};
    EXPECT_EQ(t.seconds(), 2);
}

// RFC 4648, section 10.
TEST(Report, base64) {
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

Report example() {
    Report report{.command = "myriad <bench>", .device = "d", .driver = "1", .cpu = "c", .revision = "r", .groups = {"a", "b"}, .metrics = {"E"}, .scenes = {}};
    ReportScene scene;
    scene.name = "room & hall", scene.budgets = {1, 5};
    scene.trials = {trial("a", 1, 5), trial("a", 2, 2), trial("b", 4, 1)};
    scene.parts = {{"maps", "rays", {{"E", 0.25}}}};
    scene.pictures = {{{"seen", {1, 1, {255, 0, 0}}}}};
    report.scenes.push_back(scene);
    return report;
}

TEST(Report, html_holds_everything_and_escapes_it) {
    const std::string html = to_html(example());
    for (const char* text : {"room &amp; hall", "myriad &lt;bench&gt;", "--x &quot;1&quot; &lt;2&gt;", "<b>5</b>", "<b>1</b>", "<td>–</td>", "<svg", "data:image/png;base64,iVBORw0KGgo", "0.25"})
        EXPECT_NE(html.find(text), std::string::npos) << text;
    EXPECT_EQ(html.find("<bench>"), std::string::npos);
    EXPECT_EQ(html, to_html(example()));
    for (const char* tag : {"table", "tr", "td", "th", "h2", "h3", "p", "figure", "div", "code"}) {
        const auto count = [&](const std::string& what) {
            size_t n = 0;
            for (size_t at = html.find(what); at != std::string::npos; at = html.find(what, at + 1)) ++n;
            return n;
        };
        EXPECT_EQ(count(std::string("<") + tag + ">") + count(std::string("<") + tag + " "), count(std::string("</") + tag + ">")) << tag;
    }
}

TEST(Report, csv_has_a_line_for_each_trial) {
    EXPECT_EQ(to_csv(example()), "scene,camera,group,technique,seconds,least,most,runs,E,options\n"
                                 "\"room & hall\",\"\",\"a\",t,1,1,1,1,5,\"--x \"\"1\"\" <2>\"\n"
                                 "\"room & hall\",\"\",\"a\",t,2,2,2,1,2,\"--x \"\"1\"\" <2>\"\n"
                                 "\"room & hall\",\"\",\"b\",t,4,4,4,1,1,\"--x \"\"1\"\" <2>\"\n");
}

}  // namespace
}  // namespace myriad::tools
