#include "tools/view/remembered.hpp"

#include "tools/temp_folder.hpp"

namespace myriad::tools::view {
namespace {

TEST(view_remembered, comes_back) {
    const TempFolder folder;
    const auto file = folder / "deep" / "view.json";
    EXPECT_EQ(recall(file).recent, std::vector<std::string>{}) << "nothing was kept yet";
    const Remembered kept{.recent = {"a.glb", "builtin:atrium"}, .texts = {{"--vpls", "12"}}, .orbits = true, .divisor = 3, .width = 800, .height = 500};
    remember(file, kept);
    const Remembered again = recall(file);
    EXPECT_EQ(again.recent, kept.recent);
    EXPECT_EQ(again.texts, kept.texts);
    EXPECT_TRUE(again.orbits);
    EXPECT_EQ(again.divisor, 3u);
    EXPECT_EQ(again.width, 800);
}

TEST(view_remembered, damage_is_as_if_nothing_were_kept) {
    const TempFolder folder;
    const auto file = folder / "view.json";
    for (const char* text : {"", "{", "[1]", "{\"recent\": 5, \"options\": {\"--vpls\": 7}}", "{\"options\": {\"--paint\": \"1\"}}", "{\"options\": {\"--vpls\": \"many\"}}",
                             "{\"width\": -5, \"height\": 1e99}"}) {
        put(file, text);
        const Remembered kept = recall(file);
        EXPECT_TRUE(kept.recent.empty() && kept.texts.empty()) << text;
        EXPECT_GE(kept.width, 320) << text;
    }
}

TEST(view_state, what_cannot_be_changes_nothing) {
    State state;
    open(state, "builtin:cornell");
    state.changed = false;
    set(state, "--visibility", "rays");
    EXPECT_TRUE(state.changed && state.message.empty());
    state.changed = false;
    set(state, "--coverage", "full");
    EXPECT_FALSE(state.changed);
    EXPECT_TRUE(state.is_error && state.message.find("--coverage") != std::string::npos);
    EXPECT_EQ(state.texts, (Texts{{"--visibility", "rays"}}));
    set(state, "--visibility", "manylods");
    EXPECT_TRUE(state.texts.empty()) << "the default is no choice";
    EXPECT_TRUE(state.message.empty());
}

TEST(view_state, another_scene_has_its_own_camera_and_moment) {
    State state;
    open(state, "builtin:cornell");
    state.texts = {{"--vpls", "5"}, {"--time", "2"}, {"--camera", "1"}};
    moved(state);
    EXPECT_FALSE(state.texts.contains("--camera"));
    for (int i = 0; i < 20; ++i) open(state, "scene" + std::to_string(i));
    open(state, "builtin:cornell");
    EXPECT_EQ(state.texts, (Texts{{"--vpls", "5"}}));
    EXPECT_EQ(state.kept.recent.size(), 10u);
    EXPECT_EQ(state.kept.recent.front(), "builtin:cornell");
}

}  // namespace
}  // namespace myriad::tools::view
