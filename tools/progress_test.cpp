#include "tools/progress.hpp"

#include <gtest/gtest.h>

#include <string>

namespace myriad::tools {
namespace {

// What a progress line prints into a memory stream.
template <class Action>
std::string printed(bool shown, Action action) {
    char* text = nullptr;
    size_t size = 0;
    FILE* out = open_memstream(&text, &size);
    {
        Progress progress(out, shown);
        action(progress);
    }
    fclose(out);
    const std::string result(text, size);
    free(text);
    return result;
}

TEST(progress, nothing_where_it_is_not_shown) {
    EXPECT_EQ(printed(false, [](Progress& p) { p.show("gathering", 0.5), p.clear(); }), "");
}

TEST(progress, rewrites_one_line_and_clears_it) {
    const std::string text = printed(true, [](Progress& p) { p.show("gathering", 0.25), p.show("writing", 2); });
    EXPECT_EQ(text, "\r\033[Kgathering 25 %\r\033[Kwriting 100 %\r\033[K");
}

TEST(progress, is_not_drawn_again_and_again) {
    const std::string text = printed(true, [](Progress& p) {
        for (int i = 0; i < 100000; ++i) p.show("gathering", i / 1e5);
    });
    EXPECT_LT(text.size(), 2000u);
}

TEST(progress, clears_only_what_was_drawn) {
    EXPECT_EQ(printed(true, [](Progress& p) { p.clear(), p.clear(); }), "");
}

TEST(progress, fits_a_row) {
    EXPECT_LT(printed(true, [](Progress& p) { p.show(std::string(500, 'x'), 1); }).size(), 80u);
}

}  // namespace
}  // namespace myriad::tools
