#include "tools/message.hpp"

#include <string>

#include <gtest/gtest.h>

namespace myriad::tools {
namespace {

std::string said(const char* kind, std::string_view text) {
    testing::internal::CaptureStderr();
    say(kind, text);
    return testing::internal::GetCapturedStderr();
}

TEST(message, one_line_without_full_stop) {
    EXPECT_EQ(said("error", "a: b; c."), "error: a: b; c\n");
    EXPECT_EQ(said("error", "two\nlines. \n"), "error: two lines\n");
    EXPECT_EQ(said("warning", ""), "warning: \n");
}

TEST(message, nothing_drives_the_terminal) {
    EXPECT_EQ(said("error", "red \x1b[31m\a\x7f\r."), "error: red  [31m   \n");
    EXPECT_EQ(said("error", "m\xc3\xb6glich"), "error: m\xc3\xb6glich\n");
}

TEST(message, long_ones_are_cut) {
    const std::string line = said("error", std::string(100'000, 'x'));
    EXPECT_EQ(line.size(), 4096u);
    EXPECT_TRUE(line.starts_with("error: xxx") && line.ends_with("x\n"));
}

}  // namespace
}  // namespace myriad::tools
