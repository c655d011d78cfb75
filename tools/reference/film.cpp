#include "tools/reference/film.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine/error.hpp"

namespace myriad::reference {

const std::array<std::string, Film::planes>& Film::names() {
    static const std::array<std::string, planes> all = {"R", "G", "B", "direct.R", "direct.G", "direct.B", "indirect.R", "indirect.G", "indirect.B", "variance.R", "variance.G", "variance.B"};
    return all;
}

Film::Film(const tools::Image& image) : Film(image.width, image.height) {
    const auto refuse = [&](const std::string& what) {
        throw InputError("'" + image.origin + "' " + what + ", so nothing can be added to it; give a file that myriad reference wrote with --sums on, or leave --resume out");
    };
    const auto at = image.metadata.find("samples");
    if (at == image.metadata.end()) refuse("does not say how many samples it has");
    const char* end = at->second.data() + at->second.size();
    if (const auto [stop, error] = std::from_chars(at->second.data(), end, samples_); error != std::errc() || stop != end) refuse("does not say how many samples it has");
    for (size_t k = 0; k < planes; ++k) {
        const auto* high = image.find("sum." + names()[k]);
        const auto* low = image.find("rest." + names()[k]);
        if (!high || !low) refuse("keeps no sums");
        for (size_t i = 0; i < sums_.size(); ++i) sums_[i][k] = {high->values[i], low->values[i]};
    }
}

bool Film::finite(const Radiance& s) {
    const vec3 whole = s.emission + s.direct + s.indirect, squares = whole * whole;
    return std::isfinite(squares.x) && std::isfinite(squares.y) && std::isfinite(squares.z);
}

void Film::add(size_t pixel, const Radiance& s) {
    std::array<Sum, planes>& sums = sums_[pixel];
    for (int c = 0; c < 3; ++c) {
        const double whole = double(s.emission[c]) + double(s.direct[c]) + double(s.indirect[c]);
        sums[size_t(c)].add(whole);
        sums[size_t(3 + c)].add(double(s.direct[c]));
        sums[size_t(6 + c)].add(double(s.indirect[c]));
        sums[size_t(9 + c)].add(whole * whole);
    }
}

tools::Image Film::image(bool keep_sums) const {
    tools::Image image;
    image.width = width_, image.height = height_;
    const double n = std::max(samples_, 1u);
    for (size_t k = 0; k < planes; ++k) {
        std::vector<float>& values = image.add(names()[k]);
        for (size_t i = 0; i < sums_.size(); ++i) {
            const double mean = sums_[i][k].value() / n;
            if (k < 9) values[i] = float(mean);
            else if (samples_ > 1) values[i] = float(std::max(0.0, mean - std::pow(sums_[i][k - 9].value() / n, 2)) / (n - 1));
        }
    }
    for (size_t k = 0; keep_sums && k < planes; ++k) {
        std::ranges::transform(sums_, image.add("sum." + names()[k]).begin(), [k](const auto& s) { return s[k].high; });
        std::ranges::transform(sums_, image.add("rest." + names()[k]).begin(), [k](const auto& s) { return s[k].low; });
    }
    image.metadata["samples"] = std::to_string(samples_);
    return image;
}

}  // namespace myriad::reference
