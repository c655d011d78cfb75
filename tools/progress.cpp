#include "tools/progress.hpp"

#include <unistd.h>

#include <algorithm>

namespace myriad::tools {

Progress::Progress(bool quiet) : Progress(stderr, !quiet && isatty(STDERR_FILENO)) {}

void Progress::show(const std::string& stage, double done) {
    if (!shown_) return;
    const Clock::time_point now = Clock::now();
    if (drawn_ && stage == stage_ && now - last_ < std::chrono::milliseconds(100)) return;
    drawn_ = true, stage_ = stage, last_ = now;
    const int percent = static_cast<int>(100 * std::clamp(done, 0.0, 1.0));
    std::fprintf(out_, "\r\033[K%.60s %d %%", stage.c_str(), percent);  // short enough for one row
    std::fflush(out_);
}

void Progress::clear() {
    if (!drawn_) return;
    drawn_ = false;
    std::fputs("\r\033[K", out_);
    std::fflush(out_);
}

}  // namespace myriad::tools
