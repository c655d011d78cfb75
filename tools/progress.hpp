// Progress for people: one line on a terminal that rewrites itself. In a pipe or a file, nothing.
#pragma once

#include <chrono>
#include <cstdio>
#include <string>

namespace myriad::tools {

class Progress {
public:
    // On stderr, where that is a terminal.
    explicit Progress(bool quiet);
    Progress(FILE* out, bool shown) : out_(out), shown_(shown) {}
    ~Progress() { clear(); }
    Progress(const Progress&) = delete;

    // At most ten times a second, and whenever the stage changes. `done` is 0 to 1.
    void show(const std::string& stage, double done);
    // Leaves the line as if nothing had been there; what is printed next starts at its beginning.
    void clear();

private:
    using Clock = std::chrono::steady_clock;
    FILE* out_;
    bool shown_, drawn_ = false;
    std::string stage_;
    Clock::time_point last_;
};

}  // namespace myriad::tools
