#include "tools/view/ladder.hpp"

#include <algorithm>
#include <iterator>

namespace myriad::tools::view {
namespace {

constexpr uint32_t preview_vpls = 256;
constexpr double worth_a_step_ms = 1000;  // images that take longer have one before them

}  // namespace

Pace::Pace(uint32_t divisor) {
    while (rung_ + 1 < std::size(divisors) && divisors[rung_] < divisor) ++rung_;
}

// About half of what the smallest takes has nothing to do with pixels, so that a guess by pixels errs on the safe side; one rung up is taken only with
// room to spare, or two rungs would take turns.
bool Pace::measured(uint32_t divisor, double ms) {
    if (divisor != this->divisor()) return false;
    if (ms > most_ms && rung_ + 1 < std::size(divisors)) return ++rung_, true;
    if (rung_ == 0) return false;
    const double growth = double(divisor) / divisors[rung_ - 1];
    if (ms * growth * growth > 0.9 * most_ms) return false;
    return --rung_, true;
}

Texts sized(const Texts& texts, uint32_t width, uint32_t height, uint32_t divisor) {
    Texts out = texts;
    out["--size"] = std::to_string(std::max(width / divisor, 1u)) + "x" + std::to_string(std::max(height / divisor, 1u));
    return out;
}

Texts preview(const std::string& scene, const Texts& texts, uint32_t width, uint32_t height, uint32_t divisor) {
    Texts out = sized(texts, width, height, divisor);
    const auto options = read(scene, texts);
    out["--vpls"] = std::to_string(std::min(options->frame.vpls, preview_vpls));
    for (const char* name : {"--gather-distance", "--fusion", "--coverage", "--tree", "--ism-points", "--append", "--compensate", "--primary", "--primary-pixels"}) out.erase(name);
    out["--gather"] = "subset:16";
    if (options->frame.visibility != passes::Visibility::none) out["--visibility"] = "manylods", out["--update"] = "incremental";
    out["--map-size"] = "16";
    out["--epsilon"] = "4";
    return out;
}

std::vector<Texts> ladder(const std::string& scene, const Texts& texts, uint32_t width, uint32_t height, bool moving, uint32_t divisor, double last_ms) {
    const Texts quick = preview(scene, texts, width, height, divisor);
    if (moving) return {quick};
    const Texts whole = sized(texts, width, height, 1);
    if (last_ms > 0 && last_ms < Pace::most_ms) return {whole};
    if (last_ms > 0 && last_ms < worth_a_step_ms) return {quick, whole};
    return {quick, sized(texts, width, height, 2), whole};
}

}  // namespace myriad::tools::view
