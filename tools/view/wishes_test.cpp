#include "tools/view/wishes.hpp"

#include "tools/temp_folder.hpp"
#include "tools/view/ladder.hpp"

namespace myriad::tools::view {
namespace {

const std::string cornell = "builtin:cornell";

bool offers(const std::string& name, const Texts& texts, const Needs& needs = {}) { return offered(*find_option(name), cornell, texts, needs); }

TEST(view_wishes, know_options_from_their_help) {
    using Kind = Alternative::Kind;
    EXPECT_EQ(find_option("--update")->alternatives, (std::vector<Alternative>{{Kind::word, "basic"}, {Kind::word, "incremental"}, {Kind::with_or_without, "lazy"}}));
    EXPECT_EQ(find_option("--gather")->alternatives[1], (Alternative{Kind::with_number, "subset"}));
    EXPECT_EQ(find_option("--exposure")->alternatives, (std::vector<Alternative>{{Kind::free, "E"}, {Kind::word, "auto"}}));
    EXPECT_TRUE(find_option("--filter")->flag());
    EXPECT_FALSE(find_option("--sky")->flag());
    EXPECT_EQ(find_option("--vpls")->fallback, "4096");
    EXPECT_EQ(find_option("--output"), nullptr);
    EXPECT_EQ(find_option("--frames"), nullptr);
}

TEST(view_wishes, are_read_as_render_reads_them) {
    const auto options = read(cornell, {{"--vpls", "77"}, {"--gather", "tree:5"}, {"--eye", "-1,2,3"}, {"--target", "0,0,0"}});
    EXPECT_EQ(options->frame.vpls, 77u);
    EXPECT_EQ(options->frame.subset, 5u);
    EXPECT_EQ(*options->eye, glm::vec3(-1, 2, 3));
    EXPECT_NE(input_error([] { read(cornell, {{"--vpls", "many"}}); }).find("--vpls 'many'"), std::string::npos);
    EXPECT_NE(input_error([] { read(cornell, {{"--visibility", "rays"}, {"--coverage", "full"}}); }).find("--coverage full"), std::string::npos);
}

TEST(view_wishes, what_changes_nothing_is_not_offered) {
    EXPECT_TRUE(offers("--coverage", {}));
    EXPECT_FALSE(offers("--coverage", {{"--visibility", "brute"}}));
    EXPECT_TRUE(offers("--map-size", {{"--visibility", "brute"}}));
    EXPECT_FALSE(offers("--map-size", {{"--visibility", "rays"}}));
    EXPECT_FALSE(offers("--ism-points", {}));
    EXPECT_TRUE(offers("--ism-points", {{"--visibility", "ism"}}));
    EXPECT_FALSE(offers("--update", {{"--visibility", "megaviews"}}));
    EXPECT_TRUE(offers("--update", {{"--update", "lazy:2"}}));
    EXPECT_TRUE(offers("--fusion", {{"--visibility", "megaviews"}}));
    EXPECT_FALSE(offers("--fusion", {}));
    EXPECT_FALSE(offers("--gather-distance", {}));
    EXPECT_TRUE(offers("--gather-distance", {{"--gather", "culled:8"}}));
    EXPECT_TRUE(offers("--bounces", {}));
    EXPECT_FALSE(offers("--bounces", {{"--vpls", "0"}}));
    EXPECT_FALSE(offers("--env-rotation", {}));
    EXPECT_FALSE(offers("--animation", {}));
    EXPECT_TRUE(offers("--animation", {}, {.clips = true}));
    EXPECT_TRUE(offers("--rebuild", {{"--time", "1"}}, {.clips = true}));
    EXPECT_FALSE(offers("--point-lights", {}));
    EXPECT_TRUE(offers("--point-lights", {}, {.point_lights = true}));
}

TEST(view_wishes, become_a_command_line) {
    EXPECT_EQ(shell_line(render_arguments("my room's.glb", {{"--eye", "-1,2,3"}, {"--vpls", "4096"}, {"--filter", "off"}}, 64, 48)),
              "myriad render 'my room'\\''s.glb' --eye=-1,2,3 --filter off --size 64x48");
}

TEST(view_ladder, ends_with_the_wish) {
    const Texts texts = {{"--visibility", "megaviews"}, {"--fusion", "queries"}, {"--vpls", "4096"}};
    for (const double last_ms : {0.0, 10.0, 500.0, 5000.0}) {
        const auto rungs = ladder(cornell, texts, 640, 360, false, 4, last_ms);
        Texts whole = texts;
        whole["--size"] = "640x360";
        EXPECT_EQ(rungs.back(), whole);
        for (const Texts& rung : rungs) EXPECT_NO_THROW(read(cornell, rung));
    }
    EXPECT_EQ(ladder(cornell, texts, 640, 360, false, 4, 10).size(), 1u) << "what is there at once needs no preview";
    EXPECT_EQ(ladder(cornell, texts, 640, 360, false, 4, 500).size(), 2u);
    EXPECT_EQ(ladder(cornell, texts, 640, 360, false, 4, 5000).size(), 3u);
}

TEST(view_ladder, previews_are_small_whatever_is_chosen) {
    for (const Texts& texts : {Texts{{"--visibility", "rays"}}, {{"--visibility", "none"}}, {{"--visibility", "ism"}, {"--ism-points", "7"}}, {{"--update", "lazy:3"}},
                               {{"--visibility", "megaviews"}, {"--tree", "svo:7"}}, {{"--gather", "culled:9"}, {"--gather-distance", "2"}}, {{"--coverage", "full"}},
                               {{"--primary", "points"}, {"--primary-pixels", "2"}}, {{"--vpls", "5"}}, {{"--compensate", "9"}}}) {
        const auto rungs = ladder(cornell, texts, 640, 360, true, 4, 0);
        ASSERT_EQ(rungs.size(), 1u);
        const auto options = read(cornell, rungs[0]);
        EXPECT_EQ(options->frame.width, 160u);
        EXPECT_LE(options->frame.vpls, 256u);
        EXPECT_EQ(options->frame.compensate, 0u);
    }
}

TEST(view_pace, settles_where_a_picture_takes_as_long_as_it_may) {
    for (const double ms_of_whole : {1.0, 100.0, 800.0, 3000.0, 1e9}) {
        Pace pace(6);
        const auto cost = [&] { return 5 + ms_of_whole / (double(pace.divisor()) * pace.divisor()); };
        int changes = 0;
        for (int i = 0; i < 100; ++i) changes += pace.measured(pace.divisor(), cost());
        EXPECT_LT(changes, 10) << "it does not go to and fro";
        EXPECT_TRUE(cost() <= Pace::most_ms || pace.divisor() == 16) << pace.divisor();
        if (ms_of_whole == 1) {
            EXPECT_EQ(pace.divisor(), 1u);
        }
    }
    Pace pace(6);
    EXPECT_FALSE(pace.measured(3, 1e9)) << "of another size";
    EXPECT_EQ(pace.divisor(), 6u);
}

}  // namespace
}  // namespace myriad::tools::view
