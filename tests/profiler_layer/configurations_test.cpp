// tools/vkconfig/: each configuration, switched on as vkconfig does it, finds what it is for, and finds nothing in Myriad.
#include "tests/profiler_layer/layer_run.hpp"

namespace myriad::profiler {
namespace {

using tools::bytes_of;
using tools::contains;
using tools::myriad_program;
using tools::put;
using tools::TempFolder;

const Arguments script = {"-c", "cd \"$FOLDER\" && " MYRIAD_VKCONFIG "/use.sh \"$@\"", "use.sh"};

// Runs the script in a folder, which is the user's data folder too.
Outcome use(const TempFolder& folder, const Arguments& arguments) {
    return myriad_program(script + arguments, {{"FOLDER", folder / ""}, {"XDG_DATA_HOME", folder / ""}, {"MYRIAD_CACHE", "off"}, {"LAYERS", MYRIAD_LAYERS}},
                          "/bin/bash");
}

// What the layer said of a program, which may have heard it too.
std::string messages(const std::string& configuration, const Arguments& command) {
    const TempFolder folder;
    const Outcome outcome = use(folder, Arguments{"run", configuration} + command);
    EXPECT_LT(outcome.status, 100) << outcome.err;
    EXPECT_TRUE(std::filesystem::exists(folder / "vulkan_messages.txt")) << "the layer was not there";
    return bytes_of(folder / "vulkan_messages.txt");
}

class Configurations : public ::testing::Test {
protected:
    void SetUp() override {
        if (!std::filesystem::exists("/usr/share/vulkan/explicit_layer.d/VkLayer_khronos_validation.json"))
            GTEST_SKIP() << "the Khronos validation layer is not installed (package vulkan-validationlayers)";
    }
};

const Arguments plain = {MYRIAD_PLAIN_VULKAN};
const Arguments cornell = {MYRIAD_PROGRAM, "render", "builtin:cornell", "--size", "64x36", "--samples", "12", "--quiet", "-o", "out.exr"};
const Arguments manylods = {"--vpls", "64", "--png", "out.png"};
const Arguments megaviews = {"--vpls", "512", "--visibility", "megaviews", "--gather", "tree:8", "--tree", "svo"};

TEST_F(Configurations, EachFindsWhatItIsFor) {
    const std::string rules = messages("validation", plain + Arguments{"wrong"});
    EXPECT_TRUE(contains(rules, "VUID-vkDestroyDevice-device-00378")) << rules;
    EXPECT_FALSE(contains(rules, "SYNC-HAZARD")) << rules;
    const std::string order = messages("synchronization", plain + Arguments{"wrong"});
    EXPECT_TRUE(contains(order, "SYNC-HAZARD-WRITE-AFTER-WRITE")) << order;
    EXPECT_FALSE(contains(order, "VUID-vkDestroyDevice")) << order;
    const std::string wisdom = messages("best_practices", plain + Arguments{"wrong"});
    EXPECT_TRUE(contains(wisdom, "UNASSIGNED-BestPractices-pipeline-stage-flags")) << wisdom;
}

TEST_F(Configurations, NoneFindsAnythingInMyriad) {
    for (const char* configuration : {"validation", "synchronization", "best_practices"})
        for (const Arguments& technique : {manylods, megaviews}) EXPECT_EQ(messages(configuration, cornell + technique), "") << configuration;
}

// Myriad's kernels take many minutes to compile on lavapipe once they are instrumented: see the page.
TEST_F(Configurations, GpuAssistedRunsAndIsSilent) { EXPECT_EQ(messages("gpu_assisted", plain + Arguments{"again"}), ""); }

TEST_F(Configurations, ProfilingWritesATrace) {
    const TempFolder folder;
    EXPECT_EQ(use(folder, Arguments{"run", "profiling"} + plain + Arguments{"again"}).status, 0);
    EXPECT_EQ(read_measured(folder / "myriad_profile.json", folder / "myriad_profile.csv").count("region,again"), 3);
}

TEST_F(Configurations, OnUntilOff) {
    const TempFolder folder;
    EXPECT_EQ(use(folder, {"profiling"}).status, 0);
    const Environment user = {{"XDG_DATA_HOME", folder / ""}, {"MYRIAD_PROFILER_OUTPUT_FILE", folder / "on.json"}};
    EXPECT_EQ(myriad_program({"again"}, user, MYRIAD_PLAIN_VULKAN).status, 0);
    EXPECT_TRUE(std::filesystem::exists(folder / "on.json"));
    EXPECT_EQ(use(folder, {"validation"}).status, 0);  // in place of it
    EXPECT_TRUE(contains(bytes_of(folder / "vulkan/implicit_layer.d/VkLayer_override.json"), "VK_LAYER_KHRONOS_validation"));
    EXPECT_EQ(use(folder, {"off"}).status, 0);
    EXPECT_FALSE(std::filesystem::exists(folder / "vulkan/implicit_layer.d/VkLayer_override.json"));
    EXPECT_FALSE(std::filesystem::exists(folder / "vulkan/settings.d/vk_layer_settings.txt"));
    EXPECT_EQ(use(folder, {"off"}).status, 0);
}

TEST_F(Configurations, AnothersSettingsStay) {
    const TempFolder folder;
    std::filesystem::create_directories(folder / "vulkan/settings.d");
    put(folder / "vulkan/settings.d/vk_layer_settings.txt", "# vkconfig\n");
    for (const char* what : {"validation", "off"}) {
        const Outcome outcome = use(folder, {what});
        EXPECT_EQ(outcome.status, 2);
        EXPECT_TRUE(contains(outcome.err, "is someone else's")) << outcome.err;
    }
    EXPECT_EQ(bytes_of(folder / "vulkan/settings.d/vk_layer_settings.txt"), "# vkconfig\n");
}

TEST_F(Configurations, BadNamesAreRefused) {
    const TempFolder folder;
    const Outcome outcome = use(folder, {"fast"});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.err, "use.sh: there is no configuration \"fast\"; there are: best_practices gpu_assisted profiling synchronization validation\n");
    EXPECT_EQ(use(folder, {"run", "validation"}).status, 2);
    EXPECT_EQ(use(folder, {"run", "validation", "/bin/sh", "-c", "exit 7"}).status, 7);
}

}  // namespace
}  // namespace myriad::profiler
