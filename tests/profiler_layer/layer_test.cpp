// Programs run through the layer: Myriad itself, and a plain one for what Myriad does not do.
#include <cstdlib>

#include "tests/profiler_layer/layer_run.hpp"
#include "tools/profiler_layer/settings.hpp"

namespace myriad::profiler {
namespace {

using tools::bytes_of;
using tools::contains;
using tools::myriad_program;
using tools::put;
using tools::TempFolder;

const Arguments cornell = {"render", "builtin:cornell", "--size", "64x36", "--vpls", "64", "--samples", "12", "--quiet"};
const std::string validation = "VK_LAYER_KHRONOS_validation", profiler_name = "VK_LAYER_MYRIAD_profiler";

Measured render(const TempFolder& folder, const Environment& settings, const Arguments& more = {}) {
    const Outcome outcome = myriad_program(cornell + more + Arguments{"-o", folder / "out.exr"}, with_layer(folder / "", settings));
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    return read_measured(folder / "trace.json", folder / "trace.csv");
}

// Runs the plain program with validation above the layer or below it. Without the validation layer there is one order.
Measured plain(const TempFolder& folder, const std::string& mode, const Environment& settings = {}) {
    Measured measured;
    for (const std::string& layers : {profiler_name + ":" + validation, validation + ":" + profiler_name}) {
        const bool validated = std::filesystem::exists("/usr/share/vulkan/explicit_layer.d/VkLayer_khronos_validation.json");
        const Environment environment = with_layer(folder / "", settings, validated ? layers : profiler_name) +
                                        Environment{{"VK_LAYER_ENABLES", "VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT"}};
        const Outcome outcome = myriad_program({mode}, environment, MYRIAD_PLAIN_VULKAN);
        EXPECT_EQ(outcome.status, 0) << layers << "\n" << outcome.err;
        EXPECT_EQ(outcome.err, "");
        measured = read_measured(folder / "trace.json", folder / "trace.csv");
    }
    return measured;
}

TEST(ProfilerLayer, FramesAlone) {
    const TempFolder folder;
    const Measured measured = render(folder, {{"MYRIAD_PROFILER_GRANULARITY", "frame"}});
    EXPECT_GT(measured.count("frame,frame"), 1);
    EXPECT_EQ(measured.count("frame,frame"), measured.count("submission,vkQueueSubmit2"));  // each submission is one
    EXPECT_EQ(measured.count("command buffer,frame"), measured.count("frame,frame"));       // Myriad names it so
    EXPECT_TRUE(measured.spans("region").empty());
    EXPECT_EQ(measured.counters(), (std::set<std::string>{"submits a frame", "commands a frame", "device memory (bytes)"}));
}

TEST(ProfilerLayer, PassesByNameWithinTheirCommandBuffer) {
    const TempFolder folder;
    const Measured measured = render(folder, {});
    for (const char* pass : {"gbuffer", "vpls", "cut", "splat", "gather", "compose"})
        EXPECT_EQ(measured.count(std::string("region,") + pass), 1) << pass;
    EXPECT_EQ(measured.count("region,gather/maps"), 1);  // a kernel within a pass
    EXPECT_TRUE(measured.spans("command").empty());
    // Regions lie within the command buffers, and passes, which do not overlap, take no longer than all of these.
    double passes = 0;
    for (const char* pass : {"gbuffer", "vpls", "cut", "splat", "gather", "compose"}) passes += measured.rows.at(std::string("region,") + pass).total_ms;
    EXPECT_GT(passes, 0);
    EXPECT_LE(passes, measured.rows.at("command buffer,frame").total_ms);
    EXPECT_LE(measured.rows.at("region,gather/maps").total_ms, measured.rows.at("region,gather").total_ms);
    const auto buffers = measured.spans("command buffer");
    for (const auto& region : measured.spans("region"))
        EXPECT_TRUE(std::ranges::any_of(buffers, [&](const auto& buffer) {
            constexpr double rounding = 0.01;  // microseconds
            return double(buffer["ts"]) - rounding <= double(region["ts"]) &&
                   double(region["ts"]) + double(region["dur"]) <= double(buffer["ts"]) + double(buffer["dur"]) + rounding;
        })) << region;
    // Device and host are on one clock: work follows its submission and nothing precedes the first one.
    EXPECT_TRUE(measured.trace["otherData"].empty()) << measured.trace["otherData"];
    double first = 1e300, first_submission = 1e300;
    for (const auto& buffer : buffers) first = std::min(first, double(buffer["ts"]));
    for (const auto& call : measured.spans("submission")) first_submission = std::min(first_submission, double(call["ts"]));
    EXPECT_GE(first, first_submission - 50);
}

TEST(ProfilerLayer, EachDispatch) {
    const TempFolder folder;
    const Measured measured = render(folder, {{"MYRIAD_PROFILER_GRANULARITY", "dispatch"}});
    int dispatches = 0, fills = 0;
    for (const auto& command : measured.spans("command")) {
        dispatches += std::string(command["name"]).starts_with("vkCmdDispatch");
        fills += command["name"] == "vkCmdFillBuffer";
    }
    EXPECT_GT(dispatches, 20);
    EXPECT_GT(fills, 0);
    EXPECT_EQ(measured.count("region,gather"), 1);
}

TEST(ProfilerLayer, AnImageIsTheSameWithAndWithout) {
    const TempFolder folder;
    render(folder, {{"MYRIAD_PROFILER_GRANULARITY", "dispatch"}}, {"--png", folder / "with.png"});
    EXPECT_EQ(myriad_program(cornell + Arguments{"-o", folder / "plain.exr", "--png", folder / "without.png"}).status, 0);
    EXPECT_EQ(bytes_of(folder / "with.png"), bytes_of(folder / "without.png"));
}

TEST(ProfilerLayer, FollowsASettingsFileAndVariablesBeforeIt) {
    const TempFolder folder;
    put(folder / "vk_layer_settings.txt", "myriad_profiler.granularity = frame\nmyriad_profiler.counters = memory\n");
    const Measured file = render(folder, {});
    EXPECT_TRUE(file.spans("region").empty());
    EXPECT_EQ(file.counters(), (std::set<std::string>{"device memory (bytes)"}));
    const Measured variable = render(folder, {{"MYRIAD_PROFILER_GRANULARITY", "pass"}});
    EXPECT_FALSE(variable.spans("region").empty());
}

TEST(ProfilerLayer, FramesByLabelAndARangeOfThem) {
    const TempFolder folder;
    const Environment by_label = {{"MYRIAD_PROFILER_FRAME_BOUNDARY", "label"}, {"MYRIAD_PROFILER_FRAME_LABEL", "gbuffer"}};
    const Arguments thrice = {"--repeat", "4"};
    EXPECT_EQ(render(folder, by_label, thrice).count("frame,frame"), 4);
    const Measured some = render(folder, by_label + Environment{{"MYRIAD_PROFILER_FRAMES", "1-2"}}, thrice);
    EXPECT_EQ(some.count("frame,frame"), 2);
    EXPECT_EQ(some.count("region,gather"), 2);
    for (const auto& region : some.spans("region")) EXPECT_TRUE(region["args"]["frame"] == 1 || region["args"]["frame"] == 2) << region;
}

TEST(ProfilerLayer, ABadSettingIsToldAndTheRestFollowed) {
    const TempFolder folder;
    put(folder / "vk_layer_settings.txt", "myriad_profiler.granularity = finest\nmyriad_profiler.counters = memory\n");
    const Outcome outcome = myriad_program(cornell + Arguments{"-o", folder / "out.exr"}, with_layer(folder / ""));
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.error_lines(), 1) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "VK_LAYER_MYRIAD_profiler: ")) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "line 1, myriad_profiler.granularity: \"finest\"")) << outcome.err;
    EXPECT_EQ(read_measured(folder / "trace.json", folder / "trace.csv").counters(), (std::set<std::string>{"device memory (bytes)"}));
}

TEST(ProfilerLayer, AnOutputThatCannotBeIsTold) {
    const TempFolder folder;
    const Outcome outcome = myriad_program(cornell + Arguments{"-o", folder / "out.exr"},
                                           with_layer(folder / "", {{"MYRIAD_PROFILER_OUTPUT_FILE", folder / "absent/trace.json"}}));
    EXPECT_EQ(outcome.status, 0);
    EXPECT_TRUE(contains(outcome.err, "absent/trace.json\" could not be written (No such file or directory)")) << outcome.err;
}

TEST(ProfilerLayer, ACommandBufferSubmittedAgainIsTimedEachTime) {
    const TempFolder folder;
    const Measured measured = plain(folder, "again");
    EXPECT_EQ(measured.count("region,again"), 3);
    EXPECT_EQ(measured.count("recording,again"), 1);
    EXPECT_EQ(measured.count("frame,frame"), 3);
    EXPECT_TRUE(measured.trace["otherData"].empty()) << measured.trace["otherData"];
}

TEST(ProfilerLayer, MoreRegionsThanOneQueryPoolHolds) {
    const TempFolder folder;
    EXPECT_EQ(plain(folder, "many").count("region,many"), 500);
    EXPECT_EQ(plain(folder, "many", {{"MYRIAD_PROFILER_GRANULARITY", "dispatch"}}).count("command,vkCmdDispatch: idle"), 500);
}

TEST(ProfilerLayer, OverlappingSubmissionsOfOneCommandBufferLoseTimesAndSaySo) {
    const TempFolder folder;
    const Measured measured = plain(folder, "overlapping");
    EXPECT_EQ(measured.count("region,overlapping"), 1);
    EXPECT_EQ(measured.count("submission,vkQueueSubmit"), 3);
    ASSERT_EQ(measured.trace["otherData"].size(), 1u);
    EXPECT_EQ(*measured.trace["otherData"].begin(), 2);
}

TEST(ProfilerLayer, SecondaryCommandBuffersHaveTimesOfTheirOwn) {
    const TempFolder folder;
    const Measured once = plain(folder, "secondary");
    EXPECT_EQ(once.count("region,inner"), 1);
    EXPECT_EQ(once.count("region,outer"), 1);
    EXPECT_EQ(once.count("command buffer,secondary command buffer"), 1);
    EXPECT_LE(once.rows.at("region,inner").total_ms, once.rows.at("region,outer").total_ms);
    EXPECT_TRUE(once.trace["otherData"].empty());
    const Measured twice = plain(folder, "secondary-twice");
    EXPECT_EQ(twice.count("region,inner"), 1);
    EXPECT_EQ(twice.trace["otherData"].size(), 1u);
}

TEST(ProfilerLayer, DrawsInRenderPasses) {
    const TempFolder folder;
    const Measured measured = plain(folder, "render-passes", {{"MYRIAD_PROFILER_GRANULARITY", "dispatch"}});
    EXPECT_EQ(measured.count("render pass,render pass"), 2);
    EXPECT_EQ(measured.count("region,inside"), 1);
    EXPECT_EQ(measured.count("region,several views"), 0);
    EXPECT_EQ(measured.count("command,vkCmdDispatch: idle"), 1);
    EXPECT_GT(measured.count("command,vkCmdDraw: triangle"), 50);
    EXPECT_LT(measured.count("command,vkCmdDraw: triangle"), 301);
    EXPECT_EQ(measured.trace["otherData"].size(), 1u) << measured.trace["otherData"];  // those without queries are told
}

TEST(ProfilerLayer, ThreadsHaveTracks) {
    const TempFolder folder;
    const Measured measured = plain(folder, "threads");
    EXPECT_EQ(measured.count("region,first thread"), 20);
    EXPECT_EQ(measured.count("region,second thread"), 20);
    EXPECT_TRUE(measured.tracks().contains("CPU: thread 1") && measured.tracks().contains("CPU: thread 2"));
}

TEST(ProfilerLayer, DevicesHaveTracks) {
    const TempFolder folder;
    const Measured measured = plain(folder, "devices");
    EXPECT_EQ(measured.count("region,one") + measured.count("region,other"), 2);
    EXPECT_EQ(std::ranges::count_if(measured.tracks(), [](const std::string& name) { return contains(name, "queue 0.0: frames"); }), 2);
}

TEST(ProfilerLayer, InstalledTheLoaderFindsIt) {
    const TempFolder folder;
    const std::string prefix = folder / "prefix", log = folder / "log";
    ASSERT_EQ(std::system(("cmake --install " MYRIAD_BUILD " --component layer --prefix " + prefix + " >" + log + " 2>&1").c_str()), 0) << bytes_of(log);
    Environment environment = with_layer(folder / "");
    environment.front() = {"XDG_DATA_DIRS", prefix + "/share:/usr/local/share:/usr/share"};  // in place of VK_LAYER_PATH, which names the build's folder
    const Outcome outcome = myriad_program({"again"}, environment, MYRIAD_PLAIN_VULKAN);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(read_measured(folder / "trace.json", folder / "trace.csv").count("region,again"), 3);
}

// Keys, variables and values that vkconfig offers are those that the layer understands: read from the manifest, tried one by one.
TEST(ProfilerLayer, ItsManifestOffersWhatItUnderstands) {
    const auto manifest = nlohmann::json::parse(std::ifstream(MYRIAD_LAYERS "/VkLayer_myriad_profiler.json"));
    const Settings defaults;
    for (const auto& setting : manifest["layer"]["features"]["settings"]) {
        std::vector<std::string> values;
        for (const auto& flag : setting.value("flags", nlohmann::json::array())) values.push_back(flag["key"]);
        if (setting["default"].is_string() && setting["default"] != "") values.push_back(setting["default"]);
        for (const std::string& value : values) {
            const std::string key = setting["key"], more = value == "label" ? "\nmyriad_profiler.frame_label = x" : "";
            EXPECT_TRUE(read_settings("myriad_profiler." + key + " = " + value + more, "", [](const char*) { return nullptr; }).problems.empty())
                << key << " = " << value;
            const auto variable = [&](const char* name) -> const char* {
                return name == setting["env"] ? value.c_str() : std::string("MYRIAD_PROFILER_FRAME_LABEL") == name && !more.empty() ? "x" : nullptr;
            };
            const LoadedSettings wrong = read_settings("", "", [&](const char* name) { return name == setting["env"] ? "\1" : nullptr; });
            EXPECT_TRUE(read_settings("", "", variable).problems.empty()) << setting["env"];
            EXPECT_TRUE(!wrong.problems.empty() || wrong.settings.output != defaults.output) << setting["env"] << " is not read";
        }
    }
    for (const auto& preset : manifest["layer"]["features"]["presets"])
        for (const auto& setting : preset["settings"])
            EXPECT_TRUE(read_settings("myriad_profiler." + std::string(setting["key"]) + " = " + std::string(setting["value"]), "",
                                      [](const char*) { return nullptr; }).problems.empty()) << setting;
}

TEST(ProfilerLayer, AProgramThatDestroysNothingLeavesWhatItKnewToBeOver) {
    const TempFolder folder;
    EXPECT_EQ(plain(folder, "exits").count("region,exits"), 2);
}

}  // namespace
}  // namespace myriad::profiler
