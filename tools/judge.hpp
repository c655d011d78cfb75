// Whether an image is near enough to its reference, and a picture of where it is not: what `myriad compare` and the image tests share.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>
#include <vector>

#include "tools/arguments.hpp"
#include "tools/metrics.hpp"

namespace myriad::tools {

struct Limit {
    const MetricName* metric;
    double value;
    bool above;  // broken above the value, or below it
};

// "METRIC=VALUE". InputError names the option, the metrics that there are, or the number that lacks.
Limit parse_limit(const std::string& text, bool above);
std::string show_limit(const Limit& limit);  // "FLIP <= 0.01": what must hold

// |t - r| beyond which a pixel counts as failing.
struct Tolerance {
    double value = 0.01;
    bool relative = false;  // of the mean of the reference over R, G, B and pixels

    double of(const Image& reference, std::string_view layer) const;
};
Tolerance parse_tolerance(const std::string& option, const std::string& text);  // "0.01" or "2%"

struct Comparison {
    std::string layer;  // empty: the beauty
    Tolerance tolerance;
    double ppd = flip_ppd;
    std::vector<Limit> limits;
};

struct Verdict {
    Metrics metrics;
    std::vector<std::string> failures;  // none: it passes
};

// NaN and Inf in either image are failures, whatever the limits. InputError as for `measure`.
Verdict judge(const Image& reference, const Image& test, const Comparison& comparison);

nlohmann::ordered_json to_json(const Metrics& metrics);  // what is NaN prints as null

// The error of each pixel as a file: what it shows, and how it is to be read.
enum class DiffMetric { absolute, flip, hdr_flip };
extern const Choices<DiffMetric> diff_metrics;

struct ErrorMap {
    std::string text;  // about it, after the name of the file
    double scale = 0;  // of a picture: the error that is light yellow, and all beyond
};

// An .exr with the errors as they are, or a .png as a heat map; InputError for another ending, or as for `measure`.
void require_map_name(const std::string& option, const std::string& path);
ErrorMap write_error_map(const std::filesystem::path& path, const Image& reference, const Image& test, DiffMetric metric,
                         const Comparison& comparison);

}  // namespace myriad::tools
