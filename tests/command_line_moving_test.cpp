// Scenes that move, as users ask for their moments.
#include <fstream>

#include <nlohmann/json.hpp>

#include "tests/command_line.hpp"

namespace myriad::tools {
namespace {

// A square of 2 m that shines, 3 m before the first camera; its clip "rise" lifts it out of the picture within a second.
std::string moving_scene(const TempFolder& folder) {
    const float numbers[] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, -1, 0, 1, 1, 0, -1, 1, 0, 0, 1, 0, 0, 0, 0, 8, 0};
    std::ofstream(folder / "numbers.bin", std::ios::binary).write(reinterpret_cast<const char*>(numbers), sizeof numbers);
    std::ofstream(folder / "moving.gltf") << R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"name": "sign", "mesh": 0}, {"name": "front", "camera": 0, "translation": [0, 0, 3]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
        "materials": [{"emissiveFactor": [1, 1, 1]}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
        "buffers": [{"uri": "numbers.bin", "byteLength": 104}],
        "bufferViews": [{"buffer": 0, "byteLength": 72}, {"buffer": 0, "byteOffset": 72, "byteLength": 8}, {"buffer": 0, "byteOffset": 80, "byteLength": 24}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 6, "min": [-1, -1, 0], "max": [1, 1, 0]},
                      {"bufferView": 1, "componentType": 5126, "type": "SCALAR", "count": 2, "min": [0], "max": [1]},
                      {"bufferView": 2, "componentType": 5126, "type": "VEC3", "count": 2}],
        "animations": [{"name": "rise", "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}], "samplers": [{"input": 1, "output": 2}]}]})";
    return folder / "moving.gltf";
}

TEST_F(command_line, frames_are_moments) {
    TempFolder input;
    const Arguments render = {"render", moving_scene(input), "--size", "16x16", "--vpls", "64", "--samples", "8", "--sky", "off", "-q"};
    succeed(render + Arguments{"-o", exr, "--frames", "0-2", "--fps", "4", "--stats", folder / "s.json"});
    EXPECT_EQ(folder.names(), (Arguments{"a.0000.exr", "a.0001.exr", "a.0002.exr", "s.json"}));
    EXPECT_GT(mean(folder / "a.0000.exr"), 0.5) << "the sign is there";
    EXPECT_EQ(mean(folder / "a.0002.exr"), 0) << "4 m up it is not";
    const auto frames = nlohmann::json::parse(bytes_of(folder / "s.json"))["frames"];
    ASSERT_EQ(frames.size(), 3u);
    EXPECT_EQ(frames[1]["frame"], 1);
    EXPECT_EQ(frames[1]["seconds"], 0.25);
    EXPECT_EQ(frames[2]["counters"]["tree_rebuilds"], 0);
    // A moment is the same alone, in a sequence, a loop later, and by the clip's name; but for the metadata of the files.
    const auto same = [&](const Arguments& how, const char* frame) {
        succeed(render + Arguments{"-o", exr} + how);
        const auto a = read_exr(exr), b = read_exr(folder / frame);
        ASSERT_EQ(std::pair(a.width, a.height), std::pair(b.width, b.height));
        for (const char* name : {"R", "G", "B"}) EXPECT_TRUE(a.find(name)->values == b.find(name)->values) << testing::PrintToString(how) << " " << name;
    };
    same({"--time", "0.25"}, "a.0001.exr");
    same({"--time", "1.25", "--animation", "rise"}, "a.0001.exr");
    same({"--time", "7", "--loop", "off"}, "a.0002.exr");
    same({}, "a.0000.exr");
}

TEST_F(command_line, trees_are_built_anew_on_request) {
    TempFolder input;
    const std::string scene = moving_scene(input), stats = folder / "s.json";
    refuse(2, {"render", scene, "-o", exr, "--rebuild", "2"}, "--rebuild is about a scene that moves");
    refuse(2, {"render", scene, "-o", exr, "--rebuild", "soon", "--time", "1"}, "--rebuild 'soon'");
    for (const auto& [when, rebuilds] : {std::pair{"0", 3}, {"2", 0}, {"off", 0}}) {  // each frame places the sign, which stays as large as it is
        succeed({"render", scene, "--size", "16x16", "--vpls", "64", "--samples", "8", "--sky", "off", "-q", "-o", exr, "--frames", "0-2", "--fps", "4", "--stats", stats, "--rebuild", when});
        const auto json = nlohmann::json::parse(bytes_of(stats));
        EXPECT_EQ(json["frames"][2]["counters"]["tree_rebuilds"], rebuilds) << when;
        EXPECT_EQ(json["settings"].contains("rebuild"), std::string(when) != "off") << when;
    }
}

TEST_F(command_line, cameras_go_their_ways) {
    TempFolder input;
    std::ofstream(input / "way.json") << R"({"camera_path": 1, "keys": [{"time": 0, "eye": [0, 0, 3], "target": [0, 0, 0]}, {"time": 1, "eye": [0, 0, 3], "target": [0, 9, 0]}]})";
    const Arguments render = {"render", moving_scene(input), "--size", "16x16", "--vpls", "0", "--sky", "off", "-q", "--camera-path", input / "way.json"};
    const std::string name = folder / "f%02d";
    succeed(render + Arguments{"-o", name + ".exr", "--png", name + ".png", "--stats", name + ".json", "--frames", "0-1", "--fps", "1", "--animation", "0"});
    EXPECT_EQ(folder.names(), (Arguments{"f00.exr", "f00.json", "f00.png", "f01.exr", "f01.json", "f01.png"}));
    EXPECT_GT(mean(folder / "f00.exr"), 0.5);
    EXPECT_EQ(mean(folder / "f01.exr"), 0);
    const auto frames = nlohmann::json::parse(bytes_of(folder / "f01.json"))["frames"];
    EXPECT_TRUE(frames.size() == 1 && frames[0]["frame"] == 1) << frames;
}

TEST_F(command_line, moments_that_make_no_sense) {
    TempFolder input;
    const std::string scene = moving_scene(input);
    const Arguments still = tiny + Arguments{"-o", exr}, moving = {"render", scene, "-o", exr};
    refuse(2, still + Arguments{"--frames", "0-3"}, "the scene has no animation");
    refuse(2, still + Arguments{"--animation", "0"}, "there is no animation \"0\"");
    refuse(2, moving + Arguments{"--animation", "fall"}, "0 \"rise\"");
    refuse(2, moving + Arguments{"--time", "1", "--frames", "0-3"}, "--time and --frames");
    refuse(2, moving + Arguments{"--frames", "3-0"}, "--frames '3-0'");
    refuse(2, moving + Arguments{"--frames", "0-1", "--repeat", "2"}, "--repeat");
    refuse(2, moving + Arguments{"--time", "soon"}, "--time 'soon'");
    refuse(2, moving + Arguments{"--fps", "0", "--frames", "0-1"}, "--fps '0'");
    refuse(2, moving + Arguments{"--fps", "12"}, "--fps needs frames");
    for (const char* name : {"%d.exr", "%4d.exr", "%04d%04d.exr", "100%_%04d.exr", "%04d%.exr", "%s.exr", "%00d.exr"})
        refuse(2, tiny + Arguments{"-o", folder / name, "--frames", "0-1"}, "one %0Nd");
    refuse(2, tiny + Arguments{"-o", folder / "%04d.exr"}, "--frames A-B");
    refuse(2, tiny + Arguments{"-o", folder / "none/%04d.exr", "--frames", "0-1"}, "does not exist");
    refuse(2, moving + Arguments{"--fps", "12", "--time", "1"}, "--fps needs frames");
    refuse(2, moving + Arguments{"--camera-path", input / "none.json", "--time", "0"}, "none.json");
    refuse(2, moving + Arguments{"--camera-path", input / "way.json"}, "which moment");
    refuse(2, moving + Arguments{"--camera-path", input / "way.json", "--camera", "0", "--time", "0"}, "--camera and --camera-path");
    // Through its own target, half way between two good keys: said before the first frame, which would be good.
    put(input / "through.json", R"({"camera_path": 1, "interpolation": "linear", "keys": [{"time": 0, "eye": [0, 0, 3], "target": [0, 0, 0]},
                                                                                          {"time": 1, "eye": [0, 0, -3], "target": [0, 0, 0]}]})");
    refuse(2, moving + Arguments{"--camera-path", input / "through.json", "--frames", "0-2", "--fps", "2"}, "at 0.500000 s the eye is at the target");
}

}  // namespace
}  // namespace myriad::tools
