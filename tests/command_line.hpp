// What tests of the command line share: how it succeeds and how it refuses.
#pragma once

#include <gtest/gtest.h>

#include "tests/program.hpp"
#include "tools/exr.hpp"

namespace myriad::tools {

class command_line : public testing::Test {
protected:
    // Ends with that status and one sentence on stderr, and leaves no file.
    void refuse(int status, const Arguments& arguments, const std::string& part, const Environment& environment = {}) {
        const Outcome o = myriad_program(arguments, environment);
        const std::string what = testing::PrintToString(arguments) + "\n" + o.err;
        EXPECT_EQ(o.status, status) << what;
        EXPECT_EQ(o.error_lines(), 1) << what;
        EXPECT_TRUE(o.err.starts_with("error: ") && contains(o.err, part)) << what;
        EXPECT_TRUE(folder.names().empty()) << what << testing::PrintToString(folder.names());
    }
    void succeed(const Arguments& arguments, const Environment& environment = {}) {
        last = myriad_program(arguments, environment);
        EXPECT_EQ(last.status, 0) << testing::PrintToString(arguments) << "\n" << last.err;
        EXPECT_EQ(last.err, "") << testing::PrintToString(arguments);
    }

    TempFolder folder;
    const std::string exr = folder / "a.exr", png = folder / "a.png";
    Outcome last;
};

// Of an image's red.
inline double mean(const std::string& path) {
    const Image image = read_exr(path);
    double sum = 0;
    for (size_t i = 0; i < image.pixels(); ++i) sum += double(image.rgb()->r[i]);
    return sum / double(image.pixels());
}

}  // namespace myriad::tools
