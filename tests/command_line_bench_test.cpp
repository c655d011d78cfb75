// The benches as users start them: which rows they write, and what they refuse. What their numbers are is no test's business here.
#include <fstream>
#include <map>
#include <sstream>

#include <nlohmann/json.hpp>

#include "tests/command_line.hpp"

namespace myriad::tools {
namespace {

std::vector<nlohmann::json> rows_of(const std::filesystem::path& file) {
    std::istringstream lines(bytes_of(file));
    std::vector<nlohmann::json> rows;
    for (std::string line; std::getline(lines, line);) rows.push_back(nlohmann::json::parse(line));
    return rows;
}

// A row for each technique and step of the light. What the numbers are is no test's business here.
TEST_F(command_line, bench_table_1) {
    succeed({"bench", "manylods-table1", "--scene", "builtin:cornell?light=point", "--views", "4", "--samples", "6", "--map-size", "4", "--repeat", "1",
             "--json", folder / "rows.json"});
    std::map<double, Arguments> techniques;  // by the step
    for (const auto& row : rows_of(folder / "rows.json")) {
        EXPECT_EQ(row["bench"], "manylods-table1");
        EXPECT_EQ(row["views"], 4);
        EXPECT_EQ(row["ms"]["n"], 1) << row;
        EXPECT_FALSE(row["stages"].empty()) << row;
        EXPECT_TRUE(row["error"]["relMSE"].is_number()) << row;
        techniques[row["settings"]["light_step_deg"].get<double>()].push_back(row["technique"].get<std::string>());
    }
    const Arguments all = {"brute", "ism", "basic", "incremental", "incremental", "lazy"};
    EXPECT_EQ(techniques, (std::map<double, Arguments>{{1, all}, {10, all}}));
}

// What Table 2 has, for so many points and for twice as many; rays once.
TEST_F(command_line, bench_table_2) {
    succeed({"bench", "manylods-table2", "--scene", "builtin:cornell", "--samples", "8", "--repeat", "1", "--json", folder / "rows.json"});
    std::map<uint64_t, Arguments> techniques;
    for (const auto& row : rows_of(folder / "rows.json")) {
        EXPECT_EQ(row["bench"], "manylods-table2");
        EXPECT_EQ(row["views"], 1) << row;
        EXPECT_EQ(row["ms"]["n"], 1) << row;
        techniques[row["settings"].value("samples", 0)].push_back(row["technique"]);
        if (row["technique"] == "points") { EXPECT_TRUE(row["error"]["another_depth"].is_number() && row["stages"]["cut"].is_number()) << row; }
        if (row["technique"] == "update") { EXPECT_GT(row["counters"]["times_copy"], 0) << row; }
    }
    const Arguments each = {"build", "update", "copy", "points", "points", "points"};
    EXPECT_EQ(techniques, (std::map<uint64_t, Arguments>{{0, {"poly"}}, {256, each}, {512, each}}));
}

// A row a technique, a line of the table a frame, and a plot.
TEST_F(command_line, bench_figure_8) {
    refuse(2, {"bench", "manylods-fig8", "--scene", "builtin:cornell"}, "has no animation to play");
    refuse(2, {"bench", "manylods-table1", "--plot", folder / "f.svg"}, "--plot is an option of bench manylods-fig8");
    const Arguments small = {"--scene", "builtin:teatime?detail=0.25", "--views", "4", "--samples", "8", "--map-size", "4", "--repeat", "1"};
    Arguments arguments = {"bench", "manylods-fig8", "--frames", "3", "--json", folder / "rows.json", "--csv", folder / "f.csv", "--plot", folder / "f.svg"};
    arguments.insert(arguments.end(), small.begin(), small.end());
    succeed(arguments);
    Arguments techniques;
    for (const auto& row : rows_of(folder / "rows.json")) {
        techniques.push_back(row["technique"]);
        EXPECT_EQ(row["ms"]["n"], 3) << row;
        EXPECT_EQ(row["settings"]["frames"], 3) << row;
    }
    EXPECT_EQ(techniques, (Arguments{"basic", "incremental", "lazy"}));
    const std::string table = bytes_of(folder / "f.csv");
    EXPECT_EQ(std::ranges::count(table, '\n'), 4) << table;
    EXPECT_EQ(std::ranges::count(table, ','), 4 * 12) << table;
    EXPECT_TRUE(contains(bytes_of(folder / "f.svg"), ">lazy</text>"));
}

// A row for each distribution, number and technique; what draws each view for itself is extrapolated beyond what was asked for.
TEST_F(command_line, bench_megaviews_views) {
    refuse(2, {"bench", "manylods", "--distributions", "random"}, "--distributions is an option of bench megaviews-views");
    refuse(2, {"bench", "megaviews-views", "--scene", "builtin:cornell", "--views", "4", "--distributions", "even"}, "--distributions");
    refuse(2, {"bench", "megaviews-views", "--scene", "builtin:cornell", "--levels", "4,5"}, "give one number of levels");
    succeed({"bench", "megaviews-views", "--scene", "builtin:cornell", "--views", "16", "--distributions", "random", "--samples", "9", "--map-size", "4", "--repeat", "1", "--levels", "4",
             "--json", folder / "octree.jsonl"});
    for (const auto& row : rows_of(folder / "octree.jsonl")) EXPECT_EQ(row["settings"].contains("levels"), row["technique"] == "megaviews") << row;
    succeed({"bench", "megaviews-views", "--scene", "builtin:cornell", "--views", "64,16", "--measured", "16", "--samples", "9", "--map-size", "4", "--repeat", "2",
             "--json", folder / "rows.json", "--csv", folder / "v.csv", "--plot", folder / "v.svg"});
    Arguments which;
    for (const auto& row : rows_of(folder / "rows.json")) {
        which.push_back(row["settings"]["distribution"].get<std::string>() + " " + std::to_string(row["views"].get<int>()) + " " + row["technique"].get<std::string>());
        const bool extrapolated = row["technique"] == "manylods" && row["views"] == 64;
        EXPECT_EQ(row["extrapolated"], extrapolated) << row;
        EXPECT_EQ(row["ms"]["n"], extrapolated ? 1 : 2) << row;
        EXPECT_EQ(row["error"].contains("relMSE"), row["views"] == 16) << row;
        EXPECT_EQ(row["settings"]["map_size"], 4) << row;
        EXPECT_TRUE(row["bytes"].contains("pairs") && row["bytes"].contains("atlas")) << row;
        if (row["technique"] == "brute") continue;
        EXPECT_EQ(row["settings"]["epsilon"], 2) << row;
        EXPECT_GT(row["counters"]["at_once_bytes"], row["counters"]["at_once_pairs_bytes"]) << row;
        if (row["technique"] != "megaviews") continue;
        for (const char* stage : {"view tree", "pairs", "splat", "fuse"}) EXPECT_TRUE(row["stages"].contains(stage)) << row;
        EXPECT_GE(row["counters"]["views_per_rendered_pair"], 1) << row;
        EXPECT_TRUE(row["counters"].contains("times_manylods_ms")) << row;
        EXPECT_EQ(row["counters"].contains("exponent"), row["views"] == 64) << row;
    }
    Arguments expected;
    for (const char* distribution : {"1-bounce ", "4-bounce ", "random "})
        for (const char* views : {"16 ", "64 "})
            for (const char* technique : {"brute", "manylods", "megaviews"}) expected.push_back(std::string(distribution) + views + technique);
    EXPECT_EQ(which, expected);
    EXPECT_EQ(std::ranges::count(bytes_of(folder / "v.csv"), '\n'), 19);
    EXPECT_TRUE(contains(bytes_of(folder / "v.svg"), ">megaviews 4-bounce</text>"));
    EXPECT_TRUE(contains(bytes_of(folder / "v.svg"), "stroke-dasharray"));
}

TEST_F(command_line, bench_megaviews_resolution) {
    refuse(2, {"bench", "megaviews-views", "--map-sizes", "4"}, "--map-sizes is an option of bench megaviews-resolution");
    refuse(2, {"bench", "megaviews-resolution", "--images", folder / "none"}, "there is no such folder");
    succeed({"bench", "megaviews-resolution", "--scene", "builtin:cornell", "--views", "100", "--samples", "9", "--map-sizes", "4,8", "--levels", "3,5", "--repeat", "2", "--json",
             folder / "rows.json", "--images", folder / ""});
    std::map<std::string, std::vector<int>> sizes;
    std::vector<int> levels;
    for (const auto& row : rows_of(folder / "rows.json")) {
        EXPECT_EQ(row["bench"], "megaviews-resolution");
        EXPECT_EQ(row["ms"]["n"], 2);
        EXPECT_GT(row["error"]["SSIM"], 0);
        EXPECT_GT(row["error"]["PSNR"], 0);
        if (row["settings"].contains("levels")) levels.push_back(row["settings"]["levels"]);
        else sizes[row["technique"]].push_back(row["settings"]["map_size"]);
    }
    EXPECT_EQ(sizes, (std::map<std::string, std::vector<int>>{{"manylods", {4, 8}}, {"megaviews", {4, 8}}}));
    EXPECT_EQ(levels, (std::vector<int>{3, 5}));
    EXPECT_TRUE(std::filesystem::exists(folder / "megaviews-100-16-svo5.png"));
}

TEST_F(command_line, bench_coverage) {
    succeed({"bench", "coverage", "--scene", "builtin:cornell", "--views", "100", "--samples", "12", "--epsilon", "0.5", "--levels", "6", "--repeat", "1", "--json",
             folder / "rows.json"});
    std::map<std::string, double> bias;
    for (const auto& row : rows_of(folder / "rows.json")) {
        EXPECT_EQ(row["bench"], "coverage");
        EXPECT_EQ(row["settings"].contains("levels"), row["technique"] == "megaviews");
        bias[row["technique"].get<std::string>() + " " + row["settings"].value("coverage", "exact")] = row["error"]["bias"];
    }
    EXPECT_EQ(bias.size(), 7u);
    for (const char* technique : {"manylods", "megaviews"}) EXPECT_LT(bias[technique + std::string(" full")], bias[technique + std::string(" exact")]);
}

TEST_F(command_line, bench_bias) {
    succeed({"bench", "bias", "--scene", "builtin:cornell", "--views", "32", "--parameters", "vpl-bound", "--reference-seconds", "0.1", "--json", folder / "rows.json", "--images",
             folder / ""});
    std::map<double, double> light, compensated;
    for (const auto& row : rows_of(folder / "rows.json")) {
        EXPECT_EQ(row["bench"], "bias");
        (row["settings"]["parameter"] == "--vpl-bound" ? light : compensated)[row["settings"]["value"]] = row["error"]["light"];
    }
    EXPECT_EQ(light.size(), 6u);
    double last = -1;
    for (const auto& [bound, more] : light) EXPECT_GE(more, std::exchange(last, more)) << bound << ": a lower bound loses more";
    EXPECT_LT(light.begin()->second, -0.1);
    EXPECT_EQ(compensated.size(), 5u);
    for (const auto& [bound, more] : compensated) EXPECT_LT(std::abs(more), 0.05) << bound << ": what a bound cuts off is given back";
    EXPECT_TRUE(contains(bytes_of(folder / "bias-vpl-bound.svg"), "light lost"));
    EXPECT_TRUE(std::filesystem::exists(folder / "bias-vpl-bound-compensate-4.svg"));
}

// Which candidates are within the budget depends on the machine.
TEST_F(command_line, bench_error) {
    refuse(2, {"bench", "gather", "--report", "r.html"}, "--report is an option of bench error");
    refuse(2, {"bench", "error", "--references", folder / "none"}, "there is no such folder");
    const auto once = [&](const char* technique, const char* seconds) {
        succeed({"bench", "error", "--scenes", "builtin:cornell", "--size", "32x18", "--samples", "9", "--techniques", technique, "--budgets", "0.02,0.3", "--reference-seconds", seconds, "--repeat", "1",
                 "--references", folder / "", "--report", folder / "r.html", "--csv", folder / "r.csv", "--json", folder / "rows.json"});
    };
    once("brute", "0.3");
    const std::string kept = folder / "builtin_cornell--32x18-1.exr";
    const std::string reference = bytes_of(kept);
    once("megaviews", "0.1");
    EXPECT_EQ(bytes_of(kept), reference) << "made once";
    size_t paths = 0, rows = 0;
    for (const auto& row : rows_of(folder / "rows.json")) {
        EXPECT_EQ(row["bench"], "error");
        EXPECT_GT(row["error"]["relMSE"], 0);
        EXPECT_GT(row["error"]["FLIP"], 0);
        paths += row["technique"] == "path-tracer", ++rows;
    }
    EXPECT_GE(paths, 1u);
    EXPECT_EQ(size_t(std::ranges::count(bytes_of(folder / "r.csv"), '\n')), 1 + rows);
    EXPECT_TRUE(contains(bytes_of(folder / "r.html"), "builtin:cornell"));
    EXPECT_TRUE(contains(bytes_of(folder / "r.html"), "data:image/png"));
}

TEST_F(command_line, bench_gather) {
    refuse(2, {"bench", "manylods", "--picks", "4"}, "--picks is an option of bench gather");
    refuse(2, {"bench", "gather", "--picks", "0"}, "--picks");
    succeed({"bench", "gather", "--scene", "builtin:cornell", "--views", "300", "--picks", "8,64", "--bounces", "2", "--samples", "9", "--map-size", "4", "--repeat", "1", "--json",
             folder / "rows.json"});
    std::map<std::string, int> rows;
    for (const auto& row : rows_of(folder / "rows.json")) {
        EXPECT_EQ(row["bench"], "gather");
        EXPECT_EQ(row["settings"]["bounces"], 2);
        const std::string technique = row["technique"];
        ++rows[technique];
        const double error = row["error"]["relMSE"];
        EXPECT_TRUE(technique == "all" ? error == 0 : error > 0 && error < 1) << technique << " " << error;
        EXPECT_EQ(row["stages"].contains("picks"), technique == "culled" || technique == "tree");
        EXPECT_TRUE(row["stages"].contains("gather"));
    }
    EXPECT_EQ(rows, (std::map<std::string, int>{{"all", 1}, {"subset", 2}, {"culled", 2}, {"tree", 2}}));
}

// For each arity what its tree takes, and its cuts.
TEST_F(command_line, bench_arity) {
    refuse(2, {"bench", "manylods-arity", "--arity", "4"}, "--arity is an option of bench manylods");
    succeed({"bench", "manylods-arity", "--scene", "builtin:cornell?light=point", "--views", "4", "--samples", "7", "--map-size", "4", "--repeat", "2",
             "--json", folder / "rows.json"});
    std::map<std::string, std::vector<int>> arities;
    std::map<std::string, double> node_views;
    for (const auto& row : rows_of(folder / "rows.json")) {
        arities[row["technique"]].push_back(row["settings"]["arity"]);
        EXPECT_EQ(row["ms"]["n"], 2) << row;
        if (row["technique"] == "refit") {
            EXPECT_GT(row["bytes"]["bsh"], 0) << row;
        } else {  // carried cuts may find nothing to look at
            node_views[row["technique"]] += row["counters"]["node_views"].get<double>();
        }
    }
    EXPECT_LT(node_views.at("incremental"), node_views.at("basic"));
    const std::vector<int> all = {2, 4, 8};
    EXPECT_EQ(arities, (std::map<std::string, std::vector<int>>{{"basic", all}, {"incremental", all}, {"refit", all}}));
}

// Both widths, verified; few keys, so in the device's shape only.
TEST_F(command_line, bench_sort) {
    refuse(2, {"bench", "octree", "--items", "4"}, "--items is an option of bench sort");
    succeed({"bench", "sort", "--items", "1,3000", "--repeat", "2", "--json", folder / "rows.json"});
    std::map<std::string, int> rows;
    for (const auto& row : rows_of(folder / "rows.json")) {
        ++rows[row["technique"]];
        EXPECT_EQ(row["ms"]["n"], 2) << row;
    }
    EXPECT_EQ(rows, (std::map<std::string, int>{{"copy", 4}, {"device", 4}, {"native-radix", 4}, {"native-stable-sort", 4}}));
}

// The same tree on the host and on the device, also where it has more nodes than were foreseen.
TEST_F(command_line, bench_octree) {
    refuse(2, {"bench", "sort", "--depth", "4"}, "--depth is an option of bench octree");
    succeed({"bench", "octree", "--scene", "builtin:cornell", "--samples", "9", "--depth", "21", "--repeat", "2", "--json", folder / "rows.json"});
    const auto rows = rows_of(folder / "rows.json");
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0]["technique"], "native-octree");
    EXPECT_EQ(rows[1]["technique"], "octree");
    EXPECT_EQ(rows[0]["counters"]["nodes"], rows[1]["counters"]["nodes"]);
    EXPECT_GT(rows[1]["counters"]["nodes"], 2 * 512);
    EXPECT_EQ(rows[1]["counters"]["nodes_00"], 1);
    EXPECT_EQ(rows[1]["counters"]["nodes_21"], rows[1]["counters"]["leaves"]);
    succeed({"bench", "octree", "--scene", "builtin:cornell", "--samples", "5", "--depth", "6", "--repeat", "2", "--json", folder / "cells.json"});
    const auto cells = rows_of(folder / "cells.json");
    ASSERT_EQ(cells.size(), 4u);
    EXPECT_EQ(cells[2]["technique"], "octree-triangles");
    EXPECT_GT(cells[2]["counters"]["pairs"], cells[2]["counters"]["leaves"]);
    EXPECT_GT(cells[2]["counters"]["nodes"], cells[2]["counters"]["leaves"]);
    EXPECT_EQ(cells[3]["technique"], "scene-octree");
    EXPECT_EQ(cells[3]["counters"]["leaves"], cells[2]["counters"]["leaves"]);
    EXPECT_EQ(cells[3]["stages"].size(), 5u) << cells[3];
    succeed({"bench", "octree", "--scene", "builtin:cornell", "--levels", "3,5", "--repeat", "1", "--json", folder / "levels.json"});
    const auto levels = rows_of(folder / "levels.json");
    ASSERT_EQ(levels.size(), 2u);
    for (const auto& row : levels) {
        EXPECT_EQ(row["technique"], "scene-octree");
        EXPECT_EQ(row["bytes"]["tree"], 20 * row["counters"]["nodes"].get<uint64_t>() + 20 * (row["counters"]["nodes"].get<uint64_t>() - row["counters"]["leaves"].get<uint64_t>() + 1));
    }
}

// Maps in the same time, diffuse and glossy; ISM has as few points as there are.
TEST_F(command_line, bench_ism) {
    refuse(2, {"bench", "manylods-ism", "--images", folder / "none"}, "there is no such folder");
    std::filesystem::create_directory(folder / "images");
    succeed({"bench", "manylods-ism", "--scene", "builtin:cornell", "--views", "4", "--samples", "6", "--map-size", "4", "--repeat", "1", "--json",
             folder / "rows.json", "--images", folder / "images"});
    Arguments which;
    for (const auto& row : rows_of(folder / "rows.json")) {
        which.push_back(row["technique"].get<std::string>() + " " + row["settings"]["brdf"].get<std::string>());
        EXPECT_TRUE(row["error"]["relMSE"].is_number()) << row;
    }
    EXPECT_EQ(which, (Arguments{"manylods diffuse", "ism diffuse", "manylods gltf", "ism gltf"}));
    for (const char* image : {"diffuse-4-rays.exr", "gltf-4-ism.png"}) EXPECT_TRUE(std::filesystem::exists(folder / "images" / image)) << image;
}

}  // namespace
}  // namespace myriad::tools
