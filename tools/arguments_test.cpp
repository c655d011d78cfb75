#include "tools/arguments.hpp"

#include "tools/render_options.hpp"
#include "tools/temp_folder.hpp"

namespace myriad::tools {
namespace {

using Names = std::vector<std::string>;

TEST(arguments, sizes) {
    EXPECT_EQ(parse_size("--size", "640x360"), std::pair(640u, 360u));
    EXPECT_EQ(parse_size("--size", "1x16384"), std::pair(1u, 16384u));
    for (const char* text : {"", "x", "640", "640x", "x360", "0x360", "640x0", "-1x1", "16385x1", "1x16385", "4294967297x1", "640X360",
                             "640x360x1", " 640x360", "640x360 ", "6.4e2x360", "0x10x2", "nanx1"}) {
        const std::string message = input_error([&] { parse_size("--size", text); });
        EXPECT_TRUE(contains(message, "--size '" + std::string(text) + "'") && contains(message, "16384")) << message;
    }
}

TEST(arguments, whole_numbers) {
    EXPECT_EQ(parse_whole("--vpls", "0", 0, 10), 0u);
    EXPECT_EQ(parse_whole("--vpls", "010", 0, 10), 10u) << "decimal, never octal";
    EXPECT_EQ(parse_whole("--vpls", "18446744073709551615", 0, ~uint64_t(0)), ~uint64_t(0));
    for (const char* text : {"", "-1", "11", "1.0", "1e1", "0x1", "ten", "18446744073709551616", "+1", "1 "})
        EXPECT_TRUE(contains(input_error([&] { parse_whole("--vpls", text, 0, 10); }), "from 0 to 10")) << text;
}

TEST(arguments, numbers) {
    EXPECT_EQ(parse_number("--epsilon", "0.5", 1e-3f, 1e6f), 0.5f);
    EXPECT_EQ(parse_number("--epsilon", "1e6", 1e-3f, 1e6f), 1e6f);
    EXPECT_EQ(parse_number("--epsilon", "0.001", 1e-3f, 1e6f), 1e-3f) << "though the float is above the decimal";
    for (const char* text : {"", "0", "-1", "nan", "inf", "-inf", "1e7", "1e999", "0x1p3", "1,5", "1.5m"})
        EXPECT_TRUE(contains(input_error([&] { parse_number("--epsilon", text, 1e-3f, 1e6f); }), "from 0.001 to 1e+06")) << text;
}

// In double: no frame of a film may be at another moment than the one that its number says.
TEST(arguments, rates) {
    EXPECT_EQ(parse_rate("--fps", "29.97"), 29.97);
    EXPECT_EQ(parse_rate("--fps", "0.001"), 0.001);
    EXPECT_EQ(parse_rate("--fps", "100000"), 100000);
    for (const char* text : {"", "0", "-24", "nan", "inf", "100001", "24fps", "30000/1001"})
        EXPECT_TRUE(contains(input_error([&] { parse_rate("--fps", text); }), "from 0.001 to 100000")) << text;
}

TEST(arguments, gathers_read_back) {
    passes::FrameSettings s;
    for (const char* text : {"all", "subset:1", "subset:256", "subset:4294967295", "culled:1", "culled:64", "tree:64", "tree:4096"}) {
        parse_gather("--gather", text, s);
        EXPECT_EQ(show_gather(s), text);
    }
    EXPECT_TRUE(s.gather == passes::GatherMethod::tree && s.subset == 4096);
    for (const char* text : {"", "subset", "culled", "tree", "forest:8", "ALL"})
        EXPECT_TRUE(contains(input_error([&] { parse_gather("--gather", text, s); }), "subset:256")) << text;
    for (const char* text : {"subset:", "subset:0", "subset:-1", "subset:1.5", "subset:4294967296", "culled:0", "culled:4097", "tree:", "tree:x", "tree:4097"})
        EXPECT_TRUE(contains(input_error([&] { parse_gather("--gather", text, s); }), "whole number")) << text;
}

TEST(arguments, lists) {
    const Names known = {"a", "b", "c"};
    EXPECT_EQ(parse_list("--aov", "c,a", known), (Names{"a", "c"}));
    EXPECT_EQ(parse_list("--aov", "b", known), Names{"b"});
    EXPECT_EQ(parse_list("--aov", "all", known), known);
    for (const char* text : {"", ",", "a,", ",a", "a,,b", "d", "a;b", "a,all", "A"})
        EXPECT_TRUE(contains(input_error([&] { parse_list("--aov", text, known); }), "a,b,c")) << text;
    EXPECT_TRUE(contains(input_error([&] { parse_list("--aov", "a,a", known); }), "twice"));
}

TEST(arguments, floats_are_shown_as_they_were_written) {
    EXPECT_EQ(show_number(0.1f), "0.1");
    EXPECT_EQ(show_number(1e30f), "1e+30");
    EXPECT_EQ(show_number(0.5f), "0.5");
}

std::shared_ptr<RenderOptions> parsed(std::vector<std::string> arguments) {
    CLI::App app;
    auto options = add_render_options(app);
    std::ranges::reverse(arguments);
    app.parse(arguments);
    return options;
}

TEST(render_options, reach_the_settings) {
    const auto o = parsed({"scene.glb", "-o", "a.exr", "--png", "a.png", "--size", "64x48", "--visibility", "rays", "--append", "atomic",
                           "--gather", "all", "--filter", "off", "--vpls", "77", "--bounces", "3", "--map-size", "16", "--epsilon", "2.5",
                           "--samples", "12", "--arity", "4", "--seed", "4294967295", "--vpl-bound", "9", "--compensate", "2", "--bias", "0", "--exposure", "2", "--memory-limit",
                           "5", "--aov", "Z,direct", "--float", "-q", "--repeat", "7", "--device", "1", "--camera", "c"});
    EXPECT_EQ(o->exr + o->png, "a.exra.png");
    const passes::FrameSettings& s = o->frame;
    EXPECT_TRUE(s.width == 64 && s.height == 48 && s.vpls == 77 && s.bounces == 3 && s.seed == ~0u && s.log2_samples == 12);
    EXPECT_TRUE(s.visibility == passes::Visibility::rays && s.maps.append == compute::AppendMode::atomic && s.subset == 0 && !s.filter);
    EXPECT_TRUE(s.maps.map_size == 16 && s.maps.arity == 4 && s.maps.epsilon == 2.5f && s.vpl_bound == 9 && s.compensate == 2 && s.bias == 0);
    EXPECT_EQ(o->layers, (Names{"direct", "Z"}));
    EXPECT_TRUE(o->exposure == 2.0 && o->device.memory_limit == 5 << 20 && o->device.select == "1" && o->full_floats && o->quiet);
    EXPECT_TRUE(o->repeat == 7 && o->camera == "c" && o->scene == "scene.glb");
}

TEST(render_options, defaults_are_those_of_the_frame) {
    const auto o = parsed({"scene.glb", "-o", "a.png"});
    EXPECT_EQ(o->png, "a.png");
    EXPECT_TRUE(o->exr.empty() && o->layers.empty() && !o->exposure);
    EXPECT_EQ(o->frame.vpls, passes::FrameSettings{}.vpls);
    EXPECT_EQ(o->frame.vpl_bound, 0);
    EXPECT_EQ(o->frame.maps.arity, compute::bsh_arity_default);
}

TEST(render_options, outputs_are_checked) {
    TempFolder folder;
    const std::string exr = folder / "a.exr", png = folder / "a.png", same = folder / "b/../a.exr";
    std::filesystem::create_directory(folder / "b");
    const auto refusal = [](const std::vector<std::string>& arguments) {
        return input_error([&] { check_outputs(*parsed(arguments)); });
    };
    EXPECT_TRUE(contains(refusal({"s.glb"}), "no output"));
    EXPECT_TRUE(contains(refusal({"s.glb", "-o", exr, "--gather", "tree:8", "--gather-distance", "3"}), "--gather tree:8 has no cut-off"));
    EXPECT_TRUE(contains(refusal({"s.glb", "-o", exr, "--gather", "tree:8", "--update", "lazy:2"}), "--update lazy:2 needs VPLs"));
    EXPECT_EQ(parsed({"s.glb", "-o", exr, "--gather", "culled:8", "--gather-distance", "3"})->frame.gather_distance, 3);
    EXPECT_TRUE(contains(refusal({"s.glb", "-o", "a.jpg"}), "unknown format"));
    EXPECT_TRUE(contains(refusal({"s.glb", "--png", "a.exr"}), ".png"));
    EXPECT_TRUE(contains(refusal({"s.glb", "-o", png, "--png", png}), "--png"));
    EXPECT_TRUE(contains(refusal({"s.glb", "-o", png, "--aov", "Z"}), "--aov"));
    EXPECT_TRUE(contains(refusal({"s.glb", "-o", exr, "--exposure", "1"}), "--exposure"));
    EXPECT_TRUE(contains(refusal({"s.glb", "-o", exr, "--stats", same}), "twice"));
    EXPECT_TRUE(contains(refusal({"s.glb", "-o", exr, "--trace", folder / "none/t.json"}), "does not exist"));
    check_outputs(*parsed({"s.glb", "-o", exr, "--png", png, "--exposure", "auto"}));
    EXPECT_EQ(folder.names(), Names{"b"});
}

TEST(arguments, names_of_frames) {
    EXPECT_EQ(numbered("a.exr", {}), "a.exr");
    EXPECT_EQ(numbered("a.exr", 7), "a.0007.exr");
    EXPECT_EQ(numbered("a.exr", 123456), "a.123456.exr");
    EXPECT_EQ(numbered("d/%04d.exr", 7), "d/0007.exr");
    EXPECT_EQ(numbered("d/f_%02d_x.png", 123), "d/f_123_x.png");
    EXPECT_EQ(numbered("50%04d/a.exr", 1), "50%04d/a.0001.exr") << "folders are as they are";
    EXPECT_TRUE(has_number("%01d.exr") && has_number("d/a%09d"));
    for (const char* none : {"%4d.exr", "%d.exr", "%00d.exr", "%04i.exr", "%04", "%04d/a.exr", ""}) EXPECT_FALSE(has_number(none)) << none;
}

}  // namespace
}  // namespace myriad::tools
