// A folder of images that must not change unless someone says so, and a folder of the same images made anew.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/judge.hpp"

namespace myriad::tools {

struct GoldenOptions {
    Comparison comparison;
    std::filesystem::path heat_maps;  // a folder, made where it is absent; empty: none
    bool all_maps = false;            // of images that pass, too
    DiffMetric map_metric = DiffMetric::absolute;
};

struct GoldenResult {
    std::string name;   // below both folders, with '/'
    std::string kind;   // of failure: missing, extra, unreadable, size, nonfinite or limit; empty: it passes
    std::vector<std::string> failures;  // sentences; none: it passes
    std::optional<Metrics> metrics;     // where both images could be compared
    std::filesystem::path heat_map;     // empty: there is none
    std::map<std::string, std::string> golden_metadata;  // what made it: device, driver, settings
    double seconds = 0;                 // that it took

    bool passed() const { return failures.empty(); }
};

// A golden against the file that is to be like it. Whatever is wrong with either is a failure of the result and not thrown; what
// cannot be written is an InputError.
GoldenResult judge_golden(const std::filesystem::path& golden, const std::filesystem::path& test, const std::string& name,
                          const GoldenOptions& options);

// Every .exr below either folder against its namesake, the worst first: failures before passes, then by FLIP, then by name. InputError
// when one is no folder, both are one, or the golden one has no .exr.
std::vector<GoldenResult> judge_goldens(const std::filesystem::path& golden, const std::filesystem::path& test, const GoldenOptions& options);

// A line an image, the failures of each below it, and a line of how many. The metrics are those of the limits and some more.
std::string golden_table(const std::vector<GoldenResult>& results, const std::vector<Limit>& limits);
nlohmann::ordered_json golden_json(const std::vector<GoldenResult>& results, const std::vector<Limit>& limits);
// JUnit's XML, a test case an image. Well-formed whatever the names: what XML cannot hold becomes U+FFFD.
std::string golden_junit(const std::vector<GoldenResult>& results);

struct Blessing {
    std::string reason;
    std::string by;  // what made the images, for the log: a revision
};

// Replaces goldens by what is tested, or adds them; the names are below both folders. First of all GOLDEN/blessed.log tells the date,
// the reason, by, and each file with how far it moves. Files of the same bytes stay and are not told of. Returns the names that moved.
// InputError, and nothing is changed, when the reason is blank, or a test image is missing, unreadable or not finite.
std::vector<std::string> bless(const std::filesystem::path& golden, const std::filesystem::path& test, std::vector<std::string> names,
                               const Comparison& comparison, const Blessing& blessing);

// The names of all .exr files below a folder, sorted. InputError when it is none or cannot be read.
std::vector<std::string> exr_names(const std::filesystem::path& folder);

}  // namespace myriad::tools
