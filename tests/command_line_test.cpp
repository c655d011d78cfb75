// The program as users and scripts meet it: what it prints where, how it ends, and what it leaves behind (spec, section 5).
#include <pty.h>

#include <chrono>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <thread>

#include <nlohmann/json.hpp>

#include "tests/command_line.hpp"
#include "tools/exr.hpp"
#include "tools/png.hpp"

namespace myriad::tools {
namespace {

TEST_F(command_line, help_names_every_option) {
    const std::map<std::string, Arguments> options = {
        {"", {"render", "view", "convert", "compare", "bench", "info", "--version"}},
        {"render", {"SCENE",     "--output",   "--png",  "--size",    "--camera", "--eye", "--target", "--yfov",  "--seed",    "--primary", "--primary-pixels", "--visibility", "--append",
                    "--vpls",    "--bounces",  "--map-size",          "--epsilon", "--samples", "--gather", "--gather-distance",     "--filter",
                    "--vpl-bound", "--compensate", "--bias",   "--exposure",          "--memory-limit",         "--stats",      "--trace",
                    "--aov",     "--cache",  "--instances",         "--sky",     "--device",   "--repeat", "--capture-frame", "--float", "--animation", "--time", "--frames", "--fps", "--loop", "--camera-path", "--rebuild", "--env", "--env-lights", "--env-rotation", "--env-strength", "--quiet",   "1:1",       "builtin:cornell", "W/sr"}},
        {"compare", {"REF", "TEST", "--json", "--fail-above", "--fail-below", "--layer", "--diff", "--diff-metric", "--ppd", "--tolerance", "--golden", "--heat-maps",
                     "--all-heat-maps", "--junit", "--bless"}},
        {"bench", {"--json"}},
        {"convert", {"IN", "OUT", "--unit", "--up", "--crease", "--colors", "--seed", "--quiet", ".gltf", ".glb", ".obj", ".ply.gz", ".stl", ".fbx", ".dae", ".json", "builtin:NAME"}},
        {"view", {"SCENE", "--window", "--fresh", "--verbose", "--vpls", "--visibility", "--eye", "--exposure", "F1", "view.json", "builtin:cornell"}},
        {"info", {"--json", "--device"}}};
    for (const auto& [command, names] : options) {
        succeed(command.empty() ? Arguments{"-h"} : Arguments{command, "-h"});
        for (const std::string& name : names) EXPECT_TRUE(contains(last.out, name)) << command << " -h lacks " << name;
    }
}

TEST_F(command_line, looks_from_where_it_is_told) {
    succeed(tiny + Arguments{"-q", "-o", folder / "camera.exr"});
    const Arguments eye = {"--eye", "0,2.75,12", "--target=0,2.75,-1", "--yfov", "39.3"};
    succeed(tiny + eye + Arguments{"-q", "-o", exr});
    const Image image = read_exr(exr);
    EXPECT_EQ(image.metadata.at("camera"), "(from 0,2.75,12)");
    EXPECT_GT(std::abs(mean(exr) - mean(folder / "camera.exr")), 1e-4) << "it looks from elsewhere";
    // The same by a path.
    put(folder / "way.json", R"({"camera_path": 1, "yfov": 39.3, "keys": [{"time": 0, "eye": [0, 2.75, 12], "target": [0, 2.75, -1]}]})");
    succeed(tiny + Arguments{"--camera-path", folder / "way.json", "--time", "0", "-q", "-o", folder / "way.exr"});
    EXPECT_EQ(read_exr(folder / "way.exr").rgb()->r[700], image.rgb()->r[700]);
    EXPECT_EQ(mean(folder / "way.exr"), mean(exr));
}

TEST_F(command_line, refuses_to_look_nowhere) {
    refuse(2, tiny + Arguments{"-o", exr, "--eye", "0,1,2"}, "--eye and --target");
    refuse(2, tiny + Arguments{"-o", exr, "--yfov", "40"}, "--yfov is about --eye");
    refuse(2, tiny + Arguments{"-o", exr, "--eye", "0,1,2", "--target", "0,5,2"}, "straight up or down");
    refuse(2, tiny + Arguments{"-o", exr, "--eye", "0,1,2", "--target", "0,1,2"}, "nowhere");
    refuse(2, tiny + Arguments{"-o", exr, "--eye", "0,1,2", "--target", "0,1,1", "--camera", "0"}, "in place of a camera");
    for (const char* wrong : {"0,1", "0,1,2,3", "a,b,c", "0,1,", "0,1,nan", "0,1,1e10"}) refuse(2, tiny + Arguments{"-o", exr, "--target", "0,0,0", "--eye", wrong}, "give X,Y,Z");
}

TEST_F(command_line, version) {
    succeed({"--version"});
    EXPECT_TRUE(last.out.starts_with("myriad ")) << last.out;
    EXPECT_EQ(std::ranges::count(last.out, '\n'), 1);
}

TEST_F(command_line, no_subcommand_shows_what_there_is) {
    const Outcome o = myriad_program({});
    EXPECT_EQ(o.status, 2);
    EXPECT_TRUE(contains(o.out, "render"));
    EXPECT_EQ(o.error_lines(), 1) << o.err;
}

TEST_F(command_line, bad_usage) {
    refuse(2, {"paint"}, "paint");
    refuse(2, {"--paint"}, "myriad -h");
    refuse(2, {"render", "-o", exr}, "SCENE is required; see myriad render -h");
    refuse(2, tiny + Arguments{"-o", exr, "--paint"}, "--paint; see myriad render -h");
    refuse(2, tiny + Arguments{"-o", exr, "--visibility", "shadows"}, "manylods, megaviews, brute, ism, rays, none");
    for (const char* later : {"--update", "--coverage", "--primary", "--time-budget", "--target-error"})
        refuse(2, tiny + Arguments{"-o", exr, later, "1"}, later);  // options of the spec that are yet to come
    refuse(2, tiny + Arguments{"-o", exr, "-o", folder / "b.exr"}, "--output is given more than once");
    refuse(2, tiny + Arguments{"-o"}, "--output");
    refuse(2, tiny, "no output");
    refuse(2, tiny + Arguments{"-o", folder / "a.jpg"}, "unknown format");
    refuse(2, {"info", "extra"}, "myriad info -h");
    refuse(2, {"compare", exr}, "TEST is required");
}

TEST_F(command_line, bad_values) {
    const Arguments base = {"render", "builtin:cornell", "-o", exr};
    for (const char* size : {"0x48", "64", "-64x48", "16385x1", "99999999999x1", "axb"}) refuse(2, base + Arguments{"--size", size}, "16384");
    for (const char* option : {"--vpls", "--bounces", "--map-size", "--samples", "--seed", "--repeat", "--memory-limit"})
        for (const char* value : {"-1", "1.5", "nan", "18446744073709551616"})
            refuse(2, base + Arguments{option, value}, option + std::string(" '") + value + "': give a whole number");
    for (const char* option : {"--epsilon", "--vpl-bound", "--bias"})
        for (const char* value : {"-1", "nan", "inf", "1e99", "x"})
            refuse(2, base + Arguments{option, value}, option + std::string(" '") + value + "': give a number");
    refuse(2, base + Arguments{"--gather", "subset:0"}, "--gather");
    refuse(2, base + Arguments{"--gather", "tree:4097"}, "from 1 to 4096");
    refuse(2, base + Arguments{"--gather", "tree:8", "--gather-distance", "2"}, "culled:K");
    refuse(2, base + Arguments{"--compensate", "256"}, "--compensate '256': give a whole number");
    refuse(2, base + Arguments{"--compensate", "1", "--vpls", "0"}, "--vpls 0 has none");
    refuse(2, base + Arguments{"--compensate", "1", "--visibility", "none"}, "give another --visibility");
    refuse(2, base + Arguments{"--gather", "culled:8", "--update", "incremental"}, "give --update basic");
    refuse(2, base + Arguments{"--filter", "maybe"}, "on, off");
    refuse(2, base + Arguments{"--aov", "Q"}, "indirect");
    refuse(2, base + Arguments{"--exposure", "0", "--png", png}, "--exposure");
}

TEST_F(command_line, bad_scenes_and_cameras) {
    const TempFolder other;
    put(other / "bad.glb", "not a glTF file");
    const auto render = [&](const std::string& scene) { return Arguments{"render", scene, "-o", exr, "--size", "64x48"}; };
    refuse(2, render("builtin:palace"), "palace");
    refuse(2, render("builtin:cornell?colour=red"), "colour");
    refuse(2, render(folder / "none.glb"), "none.glb");
    refuse(2, render(other / "bad.glb"), "bad.glb");
    refuse(2, render("two\nlines.glb"), "two lines.glb");
    refuse(2, tiny + Arguments{"-o", exr, "--camera", "behind"}, "behind");
    refuse(2, tiny + Arguments{"-o", exr, "--camera", "99"}, "99");
}

TEST_F(command_line, a_reference_that_is_interrupted) {
    const Arguments base = {"reference", "builtin:cornell?light=point", "--size", "16x12", "-q"};
    refuse(2, base, "--output is required");
    refuse(2, base + Arguments{"-o", png}, "name an .exr file");
    refuse(2, base + Arguments{"-o", exr, "--spp", "0"}, "--spp '0'");
    refuse(2, base + Arguments{"-o", exr, "--time", "1"}, "no animation");
    const TempFolder other;
    const std::string parts = other / "parts.exr", whole = other / "whole.exr";
    succeed(base + Arguments{"-o", parts, "--spp", "3", "--resume"});  // there is nothing yet to go on from
    const std::string before = bytes_of(parts);
    refuse(2, base + Arguments{"-o", parts, "--spp", "5", "--resume", "--seed", "2"}, "has seed 1, and 2 is asked for");
    refuse(2, base + Arguments{"-o", parts, "--spp", "5", "--resume", "--brdf", "diffuse"}, "has brdf gltf, and diffuse");
    EXPECT_EQ(bytes_of(parts), before);
    succeed(base + Arguments{"-o", parts, "--spp", "5", "--resume"}, {{"MYRIAD_THREADS", "1"}});
    succeed(base + Arguments{"-o", whole, "--spp", "5"});
    EXPECT_EQ(bytes_of(parts), bytes_of(whole));
    const Image image = read_exr(whole);
    EXPECT_EQ(image.metadata.at("samples"), "5");
    EXPECT_EQ(image.metadata.at("technique"), "reference");
    EXPECT_GT(mean(whole), 0.01);
    EXPECT_TRUE(image.rgb("direct") && image.rgb("indirect") && image.rgb("variance"));
}

TEST_F(command_line, points_in_place_of_rays) {
    refuse(2, tiny + Arguments{"-o", exr, "--primary", "triangles"}, "rays, points");
    refuse(2, tiny + Arguments{"-o", exr, "--primary-pixels", "2"}, "--primary-pixels is about points");
    refuse(2, tiny + Arguments{"-o", exr, "--primary", "rays", "--primary-pixels", "2"}, "give --primary points");
    refuse(2, tiny + Arguments{"-o", exr, "--primary", "points", "--primary-pixels", "0"}, "--primary-pixels '0'");
    const TempFolder other;
    const std::string stats = other / "s.json";
    uint64_t last_views = ~0ull;
    for (const char* c : {"1", "4", "1000"}) {
        succeed(Arguments{"render", "builtin:cornell", "--size", "64x48", "--vpls", "16", "--visibility", "rays", "--samples", "14", "-q", "-o", other / "a.exr", "--stats", stats,
                          "--primary", "points", "--primary-pixels", c});
        const nlohmann::json json = nlohmann::json::parse(bytes_of(stats)), points = json["frames"][0]["counters"]["points"];
        EXPECT_EQ(json["settings"]["primary"], "points");
        EXPECT_EQ(json["settings"]["primary_pixels"], std::stoi(c));
        EXPECT_EQ(json["scene"]["samples"], 1 << 14);
        EXPECT_GE(points["node_views"], points["cut"]);
        EXPECT_GE(points["cut"], points["drawn"]);
        EXPECT_LT(points["node_views"], last_views);
        last_views = points["node_views"];
    }
    succeed(Arguments{"render", "builtin:cornell", "--size", "64x48", "--vpls", "16", "--visibility", "rays", "-q", "-o", other / "a.exr", "--stats", stats});
    EXPECT_FALSE(nlohmann::json::parse(bytes_of(stats))["frames"][0]["counters"].contains("points"));
}

TEST_F(command_line, environments) {
    const TempFolder other;
    std::string sky = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n", dark = sky;
    for (int i = 0; i < 32; ++i) sky += i < 16 ? std::string{60, 80, 120, char(129)} : std::string{90, 80, 60, char(127)}, dark += std::string(4, '\0');
    put(other / "sky.hdr", sky), put(other / "short.hdr", sky.substr(0, 90)), put(other / "dark.hdr", dark), put(other / "text.hdr", "text");
    const Arguments with = tiny + Arguments{"-o", exr, "--env"};
    refuse(2, with + Arguments{folder / "none.hdr"}, "none.hdr");
    refuse(2, with + Arguments{other / "short.hdr"}, "short.hdr': the file is truncated or damaged (row 1 ends early)");
    refuse(2, with + Arguments{other / "text.hdr"}, "neither an OpenEXR nor a Radiance picture");
    refuse(2, with + Arguments{other / "dark.hdr"}, "black all over");
    for (const char* option : {"--env-lights", "--env-rotation", "--env-strength"}) refuse(2, tiny + Arguments{"-o", exr, option, "1"}, option + std::string(" is about an environment"));
    refuse(2, with + Arguments{other / "sky.hdr", "--env-lights", "0"}, "--env-lights '0': give a whole number");
    refuse(2, with + Arguments{other / "sky.hdr", "--env-strength", "0"}, "--env-strength '0': give a number");
    refuse(2, with + Arguments{other / "sky.hdr", "--sky", "on"}, "--sky on and --env");
    for (const char* v : {"brute", "ism"}) refuse(2, with + Arguments{other / "sky.hdr", "--visibility", v}, v + std::string(" draws no maps for the lights of an environment"));

    const std::string stats = other / "s.json", image = other / "a.exr";
    std::vector<float> first;
    for (const Arguments& more : {Arguments{"--vpls", "64"}, Arguments{"--vpls", "0"}, Arguments{"--visibility", "rays"}, Arguments{"--visibility", "none"}, Arguments{"--update", "incremental"},
                                  Arguments{"--env-rotation", "90"}, Arguments{"--env-strength", "2"}}) {
        SCOPED_TRACE(testing::PrintToString(more));
        succeed(Arguments{"render", "builtin:cornell", "--size", "64x48", "--samples", "12", "-q", "-o", image, "--stats", stats, "--env", other / "sky.hdr", "--env-lights", "16",
                          "--float"} + (more[0] == "--vpls" ? more : more + Arguments{"--vpls", "64"}));
        const nlohmann::json settings = nlohmann::json::parse(bytes_of(stats))["settings"];
        EXPECT_EQ(settings["env_lights"], 16);
        EXPECT_EQ(settings["env"], std::string(other / "sky.hdr"));
        EXPECT_FALSE(settings.contains("sky"));
        const std::vector<float> blue = read_exr(image).find("B")->values;
        if (first.empty()) first = blue;
        else EXPECT_EQ(blue == first, more == Arguments({"--update", "incremental"}));
    }
}

// Trees of every arity draw about the same image, and carried cuts through them the very same.
TEST_F(command_line, arities) {
    refuse(2, {"render", "none.glb", "-o", exr, "--arity", "3"}, "--arity '3'");
    refuse(2, {"render", "builtin:cornell", "--size", "8x8", "-o", exr, "--arity", "2", "--samples", "28"}, "give --samples 25 at most");
    const TempFolder other;
    const std::string stats = other / "s.json", image = other / "a.exr";
    std::vector<std::vector<float>> images;
    std::vector<uint64_t> blocks;
    for (const auto& [arity, update] : {std::pair("2", "basic"), {"2", "incremental"}, {"8", "basic"}}) {
        succeed({"render", "builtin:cornell", "--size", "64x48", "--samples", "13", "--vpls", "64", "-q", "-o", image, "--stats", stats, "--float", "--arity", arity,
                 "--update", update});
        const nlohmann::json json = nlohmann::json::parse(bytes_of(stats));
        EXPECT_EQ(json["settings"]["arity"], std::stoi(arity));
        images.push_back(read_exr(image).find("R")->values);
        blocks.push_back(json["scene"]["bsh_blocks"]);
    }
    EXPECT_EQ(blocks, (std::vector<uint64_t>{8191, 8191, 1171}));
    EXPECT_TRUE(images[0] == images[1]);
    const auto mean = [](const std::vector<float>& values) { return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size()); };
    EXPECT_NEAR(mean(images[0]) / mean(images[2]), 1, 0.03);
}

TEST_F(command_line, megaviews) {
    refuse(2, tiny + Arguments{"-o", exr, "--visibility", "megaviews", "--update", "incremental"}, "--update incremental carries the cuts of manylods");
    refuse(2, {"render", "builtin:cornell", "-o", exr, "--size", "64x48", "--samples", "12", "--visibility", "megaviews", "--vpls", "2000000"}, "megaviews takes up to 1048576 views");
    refuse(2, tiny + Arguments{"-o", exr, "--fusion", "queries"}, "--fusion queries is about maps that views share");
    refuse(2, tiny + Arguments{"-o", exr, "--visibility", "megaviews", "--gather", "tree:8", "--fusion", "queries"}, "--fusion queries");
    refuse(2, tiny + Arguments{"-o", exr, "--visibility", "brute", "--coverage", "full"}, "--coverage full is about nodes that are drawn, and --visibility brute draws none");
    refuse(2, tiny + Arguments{"-o", exr, "--coverage", "half"}, "--coverage");
    const std::string stats = folder / "s.json";
    std::map<std::string, double> light;
    for (const char* coverage : {"exact", "full", "stochastic"}) {
        succeed(tiny + Arguments{"-o", exr, "-q", "--stats", stats, "--visibility", "megaviews", "--epsilon", "0.5", "--coverage", coverage});
        EXPECT_EQ(nlohmann::json::parse(bytes_of(stats))["settings"].value("coverage", "exact"), coverage);
        const auto plane = read_exr(exr).find("G")->values;
        light[coverage] = std::accumulate(plane.begin(), plane.end(), 0.0);
    }
    EXPECT_LT(light["full"], light["exact"]);
    EXPECT_LT(light["full"], light["stochastic"]);
    EXPECT_NE(light["exact"], light["stochastic"]);
    succeed(tiny + Arguments{"-o", exr, "-q", "--stats", stats, "--visibility", "megaviews", "--fusion", "queries"});
    EXPECT_EQ(nlohmann::json::parse(bytes_of(stats))["settings"]["fusion"], "queries");
    succeed(tiny + Arguments{"-o", exr, "-q", "--stats", stats, "--visibility", "megaviews"});
    const auto json = nlohmann::json::parse(bytes_of(stats)), counters = json["frames"][0]["counters"];
    EXPECT_EQ(json["settings"]["visibility"], "megaviews");
    EXPECT_FALSE(json["settings"].contains("update"));
    EXPECT_FALSE(counters.contains("node_views"));
    EXPECT_GT(counters["pairs"], counters["pairs_rendered"]);
    std::map<std::string, uint64_t> sums;
    for (const auto& step : counters["pairs_by_step"])
        for (const auto& [fate, pairs] : step.items()) sums[fate] += pairs.get<uint64_t>();
    EXPECT_EQ(sums, (std::map<std::string, uint64_t>{{"tested", counters["pairs"]}, {"culled", counters["pairs_culled"]}, {"edge_on", counters["pairs_edge_on"]},
                                                     {"rendered", counters["pairs_rendered"]}}));
    EXPECT_GE(counters["views_per_rendered_pair"], 1);
    EXPECT_GT(counters["peak_bytes"]["view tree"], 0);
    EXPECT_EQ(json["settings"]["tree"], "bsh");
}

TEST_F(command_line, octree) {
    for (const char* value : {"svo:0", "svo:13", "svo:", "octree", "bsh:3"}) refuse(2, tiny + Arguments{"-o", exr, "--visibility", "megaviews", "--tree", value}, "--tree");
    refuse(2, tiny + Arguments{"-o", exr, "--tree", "svo"}, "--tree svo is walked by megaviews");
    refuse(2, tiny + Arguments{"-o", exr, "--visibility", "rays", "--tree", "svo:5"}, "give --visibility megaviews");
    refuse(3, {"render", "builtin:cornell", "-o", exr, "--size", "64x48", "--vpls", "16", "--visibility", "megaviews", "--tree", "svo:11", "--memory-limit", "64"}, "give --tree svo:10 or fewer");
    const std::string stats = folder / "s.json";
    succeed(tiny + Arguments{"-o", exr, "-q", "--stats", stats, "--visibility", "megaviews", "--tree", "svo:6"});
    const auto json = nlohmann::json::parse(bytes_of(stats)), octree = json["scene"]["octree"];
    EXPECT_EQ(json["settings"]["tree"], "svo:6");
    EXPECT_FALSE(json["settings"].contains("log2_samples"));
    EXPECT_FALSE(json["scene"].contains("samples"));
    EXPECT_GT(octree["nodes"], octree["leaves"]);
    EXPECT_EQ(octree["bytes"], 20 * octree["nodes"].get<uint64_t>() + 20 * (octree["nodes"].get<uint64_t>() - octree["leaves"].get<uint64_t>() + 1));
    EXPECT_GT(json["frames"][0]["counters"]["pairs_rendered"], 0);
}

TEST_F(command_line, outputs_that_cannot_be_written_are_told_at_once) {
    const TempFolder other;
    std::filesystem::create_directory(other / "folder.exr");
    put(other / "file", "");
    // A scene that does not exist: were it asked for first, it would be what is complained about.
    for (const char* option : {"-o", "--png", "--stats", "--trace"}) {
        const std::string name = option == std::string("--png") ? "/a.png" : "/a.exr";
        const Arguments first = option == std::string("-o") ? Arguments{"render", "none.glb"} : Arguments{"render", "none.glb", "-o", exr};
        refuse(2, first + Arguments{option, (folder / "none").string() + name}, "does not exist; create it");
        refuse(2, first + Arguments{option, (other / "file").string() + name}, "is a file");
    }
    refuse(2, {"render", "none.glb", "-o", other / "folder.exr"}, "it is a folder");
    refuse(2, {"render", "none.glb", "-o", exr, "--stats", exr}, "twice");
    refuse(2, {"render", "none.glb", "-o", ""}, "unknown format");
}

TEST_F(command_line, without_a_device) {
    const Environment none = {{"VK_DRIVER_FILES", "/dev/null"}, {"VK_ICD_FILENAMES", "/dev/null"}};
    refuse(3, tiny + Arguments{"-o", exr}, "no Vulkan device", none);
    refuse(3, {"info"}, "no Vulkan device", none);
    refuse(3, {"info", "--json"}, "no Vulkan device", none);
    refuse(3, tiny + Arguments{"-o", exr, "--device", "Voodoo"}, "Voodoo");
    refuse(3, {"info", "--device", "Voodoo"}, "Voodoo");
}

TEST_F(command_line, memory_limit) {
    refuse(3, {"render", "builtin:cornell", "-o", exr, "--memory-limit", "1"}, "--memory-limit");
}

TEST_F(command_line, info) {
    succeed({"info"});
    EXPECT_TRUE(contains(last.out, "bufferDeviceAddress") && contains(last.out, "<- used") && contains(last.out, "maxPushConstantsSize"));
    succeed({"info", "--json"});
    const auto devices = nlohmann::json::parse(last.out)["devices"];
    EXPECT_EQ(std::ranges::count_if(devices, [](const auto& d) { return d["picked"] == true; }), 1);
    for (const auto& device : devices)
        for (const char* key : {"name", "driver", "driver_version", "api", "type", "heap_bytes", "used", "missing", "degraded", "limits"})
            EXPECT_TRUE(device.contains(key)) << key;
}

TEST_F(command_line, render_writes_what_was_asked_for) {
    succeed(tiny + Arguments{"-o", exr, "--png", png, "--stats", folder / "s.json", "--trace", folder / "t.json", "--aov", "direct,N,Z"});
    EXPECT_EQ(folder.names(), (Arguments{"a.exr", "a.png", "s.json", "t.json"})) << "and no temporaries";
    for (const char* part : {"gbuffer", "gather", "total", "peak MiB", "exposure", "VPLs"}) EXPECT_TRUE(contains(last.out, part)) << last.out;
    EXPECT_FALSE(contains(last.out, "\r"));

    const Image image = read_exr(exr);
    EXPECT_EQ(image.width, 64u);
    EXPECT_EQ(image.height, 48u);
    Arguments channels;
    for (const auto& channel : image.channels) channels.push_back(channel.name);
    std::ranges::sort(channels);
    EXPECT_EQ(channels, (Arguments{"B", "G", "N.X", "N.Y", "N.Z", "R", "Z", "direct.B", "direct.G", "direct.R"}));
    EXPECT_GT(*std::ranges::max_element(image.find("G")->values), 0);
    for (const char* key : {"scene", "seed", "technique", "vpls", "bounces", "map_size", "epsilon", "append", "gather", "git_revision",
                            "device", "driver"})
        EXPECT_TRUE(image.metadata.contains(key)) << key;
    EXPECT_EQ(image.metadata.at("scene"), "builtin:cornell");
    EXPECT_EQ(image.metadata.at("technique"), "manylods");

    const Picture picture = read_png(png);
    EXPECT_EQ(picture.width * picture.height, 64u * 48u);
    EXPECT_GT(*std::ranges::max_element(picture.rgb), 100);

    const auto stats = nlohmann::json::parse(bytes_of(folder / "s.json"));
    EXPECT_GT(stats["scene"]["triangles"], 0);
    EXPECT_EQ(stats["scene"]["samples"], 4096);
    ASSERT_EQ(stats["frames"].size(), 1u);
    EXPECT_GT(stats["frames"][0]["passes"].size(), 3u);
    for (const char* name : {"node_views", "cut", "list_capacity", "list_peak", "vpls"}) EXPECT_GT(stats["frames"][0]["counters"][name], 0);
    EXPECT_GT(stats["frames"][0]["counters"]["peak_bytes"].size(), 3u);
    EXPECT_GT(nlohmann::json::parse(bytes_of(folder / "t.json"))["traceEvents"].size(), 10u);
}

TEST_F(command_line, one_frame_is_captured_where_renderdoc_is_attached) {
    const TempFolder logs;
    const Environment attached = {{"LD_PRELOAD", FALSE_RENDERDOC}, {"FALSE_RENDERDOC_LOG", logs / "log"}};
    const auto capture = [&](const char* number) { return tiny + Arguments{"-o", exr, "--repeat", "3", "--capture-frame", number}; };
    refuse(2, capture("1"), "RenderDoc, which is not attached; start the program with renderdoccmd capture");
    refuse(2, capture("3"), "the last is 2", attached);
    refuse(3, capture("2"), "RenderDoc made no capture", attached + Environment{{"FALSE_RENDERDOC_FAILS", "1"}});
    std::filesystem::remove(logs / "log");
    succeed(capture("1"), attached);
    EXPECT_EQ(bytes_of(logs / "log"), "start\nend\n");
}

// One clock for both: what the device did for a frame lies after its recording and within the frame's time on the host.
TEST_F(command_line, a_time_line_joins_host_and_device) {
    succeed(tiny + Arguments{"-o", exr, "--trace", folder / "t.json", "--repeat", "2"});
    const auto trace = nlohmann::json::parse(bytes_of(folder / "t.json"));
    std::vector<std::pair<double, double>> frames, recorded, ran;  // from and to
    std::set<std::string> counters;
    for (const auto& event : trace["traceEvents"]) {
        if (event["ph"] == "C") counters.insert(event["name"]);
        if (event["ph"] != "X") continue;
        const double from = event["ts"], to = from + double(event["dur"]);
        if (event["tid"] == 1 && std::string(event["name"]).starts_with("frame ")) frames.emplace_back(from, to);
        if (event["name"] == "gather") (event["tid"] == 3 ? ran : recorded).emplace_back(from, to);
    }
    ASSERT_EQ(frames.size(), 2u);
    ASSERT_EQ(recorded.size(), 2u);
    ASSERT_EQ(ran.size(), 2u);
    for (size_t i = 0; i < 2; ++i) {
        EXPECT_GE(ran[i].first, recorded[i].second);
        EXPECT_LE(ran[i].second, frames[i].second);
    }
    for (const char* name : {"list_peak", "vpls", "peak_bytes: atlas"}) EXPECT_TRUE(counters.contains(name)) << name;
}

TEST_F(command_line, layers_add_up_to_the_beauty) {
    succeed(tiny + Arguments{"-o", exr, "--aov", "all", "--float", "-q"});
    EXPECT_EQ(last.out, "");
    const Image image = read_exr(exr);
    const auto beauty = *image.rgb(), direct = *image.rgb("direct"), indirect = *image.rgb("indirect"), emission = *image.rgb("emission");
    for (size_t i = 0; i < image.pixels(); ++i)
        ASSERT_NEAR(beauty.g[i], direct.g[i] + indirect.g[i] + emission.g[i], 1e-5 * (1 + beauty.g[i])) << i;
    const auto normal = *image.rgb("N");
    for (size_t i = 0; i < image.pixels(); ++i) {
        const float length = std::hypot(normal.r[i], normal.g[i], normal.b[i]);
        ASSERT_NEAR(length, image.find("Z")->values[i] > 0 ? 1 : 0, 1e-3) << i;
    }
}

TEST_F(command_line, png_alone_and_given_to_o) {
    succeed(tiny + Arguments{"-o", png, "--exposure", "1"});
    const std::string first = bytes_of(png);
    succeed(tiny + Arguments{"--png", png, "--exposure", "1"});
    EXPECT_EQ(folder.names(), Arguments{"a.png"});
    EXPECT_EQ(bytes_of(png), first);
}

TEST_F(command_line, repeats_are_all_counted) {
    succeed(tiny + Arguments{"-o", exr, "--repeat", "3", "--stats", folder / "s.json"});
    EXPECT_TRUE(contains(last.out, "medians of 3 frames")) << last.out;
    EXPECT_EQ(nlohmann::json::parse(bytes_of(folder / "s.json"))["frames"].size(), 3u);
}

TEST_F(command_line, the_same_render_gives_the_same_bytes) {
    succeed(tiny + Arguments{"-o", exr, "--aov", "all"});
    const std::string first = bytes_of(exr);
    succeed(tiny + Arguments{"-o", exr, "--aov", "all"});
    EXPECT_TRUE(bytes_of(exr) == first) << "on a second run";
    for (const char* threads : {"0", "1", "2"}) {
        succeed(tiny + Arguments{"-o", exr, "--aov", "all"}, {{"LP_NUM_THREADS", threads}});
        EXPECT_TRUE(bytes_of(exr) == first) << "with LP_NUM_THREADS=" << threads;
    }
    succeed(tiny + Arguments{"-o", exr, "--aov", "all", "--seed", "2"});
    EXPECT_FALSE(bytes_of(exr) == first) << "another seed must change the image, or nothing was compared";
}

TEST_F(command_line, both_ways_to_append_give_the_same_pixels) {
    for (const char* mode : {"scan", "atomic"}) succeed(tiny + Arguments{"-o", folder / (mode + std::string(".exr")), "--float", "--append", mode});
    const Image scan = read_exr(folder / "scan.exr"), atomic = read_exr(folder / "atomic.exr");
    EXPECT_EQ(atomic.metadata.at("append"), "atomic");
    for (const char* name : {"R", "G", "B"}) EXPECT_TRUE(scan.find(name)->values == atomic.find(name)->values) << name;
}

TEST_F(command_line, ends_of_the_ranges) {
    const std::string panel = "builtin:cornell", point = "builtin:cornell?light=point";
    const std::vector<std::pair<std::string, Arguments>> cases = {
        {panel, {"--visibility", "rays"}}, {point, {"--visibility", "none"}}, {panel, {"--gather", "all"}}, {point, {"--gather", "subset:1"}},
        {panel, {"--bounces", "0"}},       {point, {"--bounces", "0"}},       {point, {"--bounces", "3"}},  {panel, {"--vpls", "0"}},
        {panel, {"--vpls", "2"}},          {panel, {"--samples", "0"}},       {panel, {"--map-size", "2"}}, {point, {"--size", "1x1"}},
        {panel, {"--size", "129x1"}},      {panel, {"--epsilon", "0.001"}},   {panel, {"--epsilon", "1e6"}}, {panel, {"--bias", "0"}}};
    for (const auto& [scene, change] : cases) {
        Arguments arguments = tiny;
        arguments[1] = scene;
        const auto same = std::ranges::find(arguments, change[0]);
        if (same == arguments.end()) arguments = arguments + change;
        else same[1] = change[1];
        succeed(arguments + Arguments{"-o", exr});
    }
}

TEST_F(command_line, compare) {
    const std::string other = folder / "b.exr";
    succeed(tiny + Arguments{"-o", exr});
    succeed(tiny + Arguments{"-o", other, "--visibility", "none"});
    succeed({"compare", exr, exr, "--fail-above", "MSE=0"});
    succeed({"compare", exr, other});
    const Outcome o = myriad_program({"compare", exr, other, "--json", "--fail-above", "MSE=0"});
    EXPECT_EQ(o.status, 1) << o.err;
    EXPECT_EQ(o.error_lines(), 1) << o.err;
    EXPECT_GT(nlohmann::json::parse(o.out)["MSE"], 0);
}

TEST_F(command_line, convert) {
    succeed({"convert", "builtin:cornell", folder / "a.glb"});
    EXPECT_TRUE(contains(last.out, "1776 triangles")) << last.out;
    EXPECT_EQ(std::ranges::count(last.out, '\n'), 1);
    succeed({"convert", folder / "a.glb", folder / "b.glb", "--unit", "ft", "--up", "z", "--quiet"});
    EXPECT_EQ(last.out, "");
    succeed({"convert", folder / "a.glb", folder / "c.glb", "--unit", "0.3048", "--up", "z"});
    EXPECT_TRUE(contains(last.out, "1.74 x 1.71 x 1.74 m")) << last.out;
    EXPECT_TRUE(bytes_of(folder / "b.glb") == bytes_of(folder / "c.glb"));
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.glb", "b.glb", "c.glb"}));

    put(folder / "room.json", R"({"recipe": 1, "parts": [{"file": "a.glb", "places": [{}, {"at": [9, 0, 0]}]}], "boxes": [{"size": [1, 1, 1]}]})");
    succeed({"convert", folder / "room.json", folder / "e.glb"});
    EXPECT_TRUE(contains(last.out, "(3564 with instances)")) << last.out;

    put(folder / "a.obj", "mtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const Outcome o = myriad_program({"convert", folder / "a.obj", folder / "d.glb"});
    EXPECT_EQ(o.status, 0) << o.err;
    EXPECT_TRUE(o.err.starts_with("warning: ") && contains(o.err, "gone.mtl")) << o.err;  // a texture or material less is no failure
    EXPECT_TRUE(contains(o.out, "1 triangle in 1 mesh")) << o.out;
}

TEST_F(command_line, convert_refuses) {
    const std::string glb = folder / "a.glb";
    const TempFolder other;
    put(other / "bad.glb", "not a glTF file");
    put(other / "scene.xyz", "");
    refuse(2, {"convert"}, "IN is required");
    refuse(2, {"convert", "builtin:cornell"}, "OUT is required");
    refuse(2, {"convert", "builtin:cornell", folder / "a.gltf"}, "let the name end in .glb");
    refuse(2, {"convert", "none.glb", folder / "none/a.glb"}, "does not exist; create it");  // before the scene is read
    refuse(2, {"convert", other / "none.glb", glb}, "there is no such file");
    refuse(2, {"convert", other / "scene.xyz", glb}, "give one of .gltf, .glb");
    refuse(2, {"convert", other / "bad.glb", glb}, "bad.glb");
    for (const char* unit : {"0", "-1", "nan", "mile", ""}) refuse(2, {"convert", "builtin:cornell", glb, "--unit", unit}, "mm, cm, m, in, ft");
    refuse(2, {"convert", "builtin:cornell", glb, "--up", "w"}, "x, y, z");
    refuse(2, {"convert", "builtin:cornell", glb, "--crease", "181"}, "--crease");
    put(other / "bad.json", R"({"recipe": 1, "parts": [{"file": "none.obj"}]})");
    refuse(2, {"convert", other / "bad.json", glb}, "parts[0]: there is no file \"none.obj\"");
    put(other / "bad.obj", "v 0 0 0\nf 1 2 3\n");
    refuse(2, {"convert", other / "bad.obj", glb}, "bad.obj: the file cannot be read");
    put(other / "empty.gltf", R"({"asset": {"version": "2.0"}})");
    refuse(2, {"convert", other / "empty.gltf", glb}, "nothing in it");
}

TEST_F(command_line, interrupted_in_the_middle) {
    for (int sent : {SIGINT, SIGTERM}) {
        const TempFolder pipes;
        const pid_t child = start(tiny + Arguments{"-o", exr, "--png", png, "--repeat", "100000"}, {}, pipes / "out", pipes / "err");
        std::this_thread::sleep_for(std::chrono::seconds(2));
        int status = 0;
        ASSERT_EQ(waitpid(child, &status, WNOHANG), 0) << "it ended by itself: " << bytes_of(pipes / "err");
        kill(child, sent);
        waitpid(child, &status, 0);
        EXPECT_EQ(status_of(status), 128 + sent);
        EXPECT_TRUE(folder.names().empty()) << testing::PrintToString(folder.names());
    }
}

TEST_F(command_line, progress_is_for_terminals) {
    const TempFolder pipes;
    int terminal = -1, end = -1, status = 0;
    if (openpty(&terminal, &end, nullptr, nullptr, nullptr) != 0) GTEST_SKIP() << "no terminal can be made here: /dev/pts is not mounted";
    const pid_t child = start(tiny + Arguments{"-o", exr}, {}, pipes / "out", "", end);
    close(end);
    std::string shown;
    char buffer[4096];
    for (ssize_t n; (n = read(terminal, buffer, sizeof buffer)) > 0;) shown.append(buffer, size_t(n));  // ends when the child does
    waitpid(child, &status, 0);
    close(terminal);
    EXPECT_EQ(status_of(status), 0) << shown;
    EXPECT_TRUE(contains(shown, "\r\033[K") && contains(shown, "gathering")) << shown;
    EXPECT_TRUE(shown.ends_with("\r\033[K")) << "the line must be cleared";
    EXPECT_FALSE(contains(bytes_of(pipes / "out"), "\r"));
}

TEST_F(command_line, the_cache_is_used_and_its_loss_is_no_failure) {
    const auto with = [&](const std::string& cache) -> Arguments {
        return {"render", "builtin:cornell", "-o", folder / "c.exr", "--size", "16x9", "--vpls", "16", "--samples", "8", "--stats", folder / "c.json", "--cache", cache};
    };
    const auto stats = [&] { return bytes_of(folder / "c.json"); };
    succeed(with(folder / "made"));
    EXPECT_TRUE(contains(stats(), "\"missing\": 2"));
    const std::string image = bytes_of(folder / "c.exr");
    succeed(with(folder / "made"));
    EXPECT_TRUE(contains(stats(), "\"found\": 2"));
    EXPECT_EQ(bytes_of(folder / "c.exr"), image);
    succeed(with("off"));
    EXPECT_FALSE(contains(stats(), "\"cache\""));

    put(folder / "file", "x");
    const Outcome lost = myriad_program(with(folder / "file" / "in\x1bit"));
    EXPECT_EQ(lost.status, 0);
    EXPECT_TRUE(lost.err.starts_with("warning: nothing is kept in the cache '")) << lost.err;
    EXPECT_EQ(lost.error_lines(), 1);
    EXPECT_FALSE(contains(lost.err, "\x1b")) << "control characters could drive a terminal";
    EXPECT_EQ(bytes_of(folder / "c.exr"), image);
}

TEST_F(command_line, a_full_disk_for_the_table_is_no_success) {
    const TempFolder pipes;
    int status = 0;
    waitpid(start({"info"}, {}, "/dev/full", pipes / "err"), &status, 0);
    EXPECT_EQ(status_of(status), 2);
    EXPECT_TRUE(contains(bytes_of(pipes / "err"), "standard output"));
}

}  // namespace
}  // namespace myriad::tools
