#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "tools/profiler_layer/settings.hpp"
#include "tools/temp_folder.hpp"

namespace myriad::profiler {
namespace {

using Values = std::map<std::string, std::string>;

Variables variables(const Values& values) {
    return [values](const char* name) { return values.contains(name) ? values.at(name).c_str() : nullptr; };
}

// The lambda above owns the strings; it must outlive the call.
LoadedSettings read(const std::string& text, const Values& values = {}) {
    const Variables variable = variables(values);
    return read_settings(text, "file.txt", variable);
}

TEST(ProfilerSettings, DefaultsWhereNothingIsSaid) {
    const LoadedSettings loaded = read("# myriad_profiler.granularity = frame\nkhronos_validation.report_flags = error\n");
    EXPECT_TRUE(loaded.problems.empty());
    EXPECT_EQ(loaded.settings.granularity, Granularity::pass);
    EXPECT_EQ(loaded.settings.output, "myriad_profile.json");
    EXPECT_EQ(loaded.settings.summary(), "myriad_profile.csv");
    EXPECT_TRUE(loaded.settings.covers(0) && loaded.settings.covers(1'000'000));
    EXPECT_TRUE(loaded.settings.count_memory);
}

TEST(ProfilerSettings, FromAFile) {
    const LoadedSettings loaded = read(
        "myriad_profiler.output_file = \"/tmp/a b.json\"\r\nmyriad_profiler.granularity=dispatch\n  myriad_profiler.frames = 3-7  \n"
        "myriad_profiler.frame_boundary = label\nmyriad_profiler.frame_label = G-buffer, first\nmyriad_profiler.counters = memory,submits");
    EXPECT_TRUE(loaded.problems.empty()) << loaded.problems.front();
    EXPECT_EQ(loaded.settings.output, "/tmp/a b.json");
    EXPECT_EQ(loaded.settings.summary(), "/tmp/a b.csv");
    EXPECT_EQ(loaded.settings.granularity, Granularity::dispatch);
    EXPECT_FALSE(loaded.settings.covers(2));
    EXPECT_TRUE(loaded.settings.covers(3) && loaded.settings.covers(7));
    EXPECT_FALSE(loaded.settings.covers(8));
    EXPECT_EQ(loaded.settings.boundary, Boundary::label);
    EXPECT_EQ(loaded.settings.frame_label, "G-buffer, first");
    EXPECT_TRUE(loaded.settings.count_memory && loaded.settings.count_submits);
    EXPECT_FALSE(loaded.settings.count_commands);
}

TEST(ProfilerSettings, VariablesAreStrongerThanTheFile) {
    const LoadedSettings loaded = read("myriad_profiler.granularity = dispatch\nmyriad_profiler.frames = 9\n", {{"MYRIAD_PROFILER_GRANULARITY", "frame"}});
    EXPECT_EQ(loaded.settings.granularity, Granularity::frame);
    EXPECT_EQ(loaded.settings.first_frame, 9u);
}

TEST(ProfilerSettings, FramesInEachForm) {
    const auto frames = [](const char* text) {
        const Settings s = read(std::string("myriad_profiler.frames = ") + text).settings;
        return std::pair(s.first_frame, s.last_frame);
    };
    const uint64_t all = Settings{}.last_frame;
    EXPECT_EQ(frames("all"), std::pair(uint64_t(0), all));
    EXPECT_EQ(frames("5"), std::pair(uint64_t(5), uint64_t(5)));
    EXPECT_EQ(frames("5-9"), std::pair(uint64_t(5), uint64_t(9)));
    EXPECT_EQ(frames("5-"), std::pair(uint64_t(5), all));
}

TEST(ProfilerSettings, WhatIsNotUnderstoodIsToldWithItsPlace) {
    const auto problem = [](const std::string& text) {
        const LoadedSettings loaded = read(text);
        return loaded.problems.size() == 1 ? loaded.problems.front() : std::to_string(loaded.problems.size()) + " problems";
    };
    EXPECT_EQ(problem("\nmyriad_profiler.granularity = fine"),
              "file.txt, line 2, myriad_profiler.granularity: \"fine\" is not understood and passed over; write one of frame, pass, dispatch");
    for (const char* frames : {"", "-", "x", "5-3", "-5", "5-x", "5,6", "99999999999999999999"})
        EXPECT_NE(problem(std::string("myriad_profiler.frames = ") + frames).find("a range as in 5-9"), std::string::npos) << frames;
    EXPECT_NE(problem("myriad_profiler.colour = red").find("there is no setting \"myriad_profiler.colour\""), std::string::npos);
    EXPECT_NE(problem("myriad_profiler.frames").find("there is no value"), std::string::npos);
    EXPECT_NE(problem("myriad_profiler.counters = submits, pixels").find("any of submits, commands, memory"), std::string::npos);
    EXPECT_NE(problem("myriad_profiler.output_file =").find("the name of a file"), std::string::npos);
    EXPECT_NE(problem("myriad_profiler.frame_boundary = label").find("set frame_label too"), std::string::npos);
    EXPECT_NE(problem("myriad_profiler.frame_label = x").find("set frame_boundary to \"label\" too"), std::string::npos);
}

TEST(ProfilerSettings, CountersCanAllBeOff) {
    const Settings s = read("myriad_profiler.counters = none").settings;
    EXPECT_FALSE(s.count_submits || s.count_commands || s.count_memory);
}

TEST(ProfilerSettings, FilesAreLookedForWhereKhronosLayersLook) {
    const tools::TempFolder folder;
    const std::string data = folder / "data", given = folder / "given";
    std::filesystem::create_directories(data + "/vulkan/settings.d");
    std::filesystem::create_directories(given);
    const Variables variable = variables({{"XDG_DATA_HOME", data}, {"VK_LAYER_SETTINGS_PATH", given}});
    EXPECT_EQ(settings_path(variable), given + "/vk_layer_settings.txt");
    std::ofstream(data + "/vulkan/settings.d/vk_layer_settings.txt") << "#\n";
    EXPECT_EQ(settings_path(variable), data + "/vulkan/settings.d/vk_layer_settings.txt");  // vkconfig's
    std::ofstream(given + "/other.txt") << "#\n";
    EXPECT_EQ(settings_path(variables({{"VK_LAYER_SETTINGS_PATH", given + "/other.txt"}})), given + "/other.txt");
    EXPECT_EQ(settings_path(variables({})), "vk_layer_settings.txt");
    std::filesystem::create_directories(folder / "home/.local/share/vulkan/settings.d");
    const std::string at_home = folder / "home/.local/share/vulkan/settings.d/vk_layer_settings.txt";
    std::ofstream(at_home) << "#\n";
    EXPECT_EQ(settings_path(variables({{"HOME", folder / "home"}})), at_home);
}

}  // namespace
}  // namespace myriad::profiler
