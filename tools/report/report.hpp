// Speed against error, as one HTML file that needs nothing else: plots, tables and pictures of what was measured.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/png.hpp"

namespace myriad::tools {

// One way to make the image, and what came of it.
struct Trial {
    std::string group;      // a line of the plots: "Myriad", "path tracer" …
    std::string technique;  // as in rows of bench (spec, section 5)
    std::string options;    // of `myriad render` or `myriad reference`, that make it again
    std::vector<double> runs;  // seconds, at least one
    std::map<std::string, double> error;  // by metric, against the path-traced reference

    double seconds() const;  // the median run
};

// Those that no other is better than, in time and in `metric` both: indices by rising seconds. Of two alike, the first.
std::vector<size_t> pareto_front(std::span<const Trial> trials, std::string_view group, const std::string& metric);

// The trial of that group with the least error among those that take `budget` seconds at most.
std::optional<size_t> best_within(std::span<const Trial> trials, std::string_view group, const std::string& metric, double budget);

struct ErrorPart {
    std::string what, against;  // what differs, and from what
    std::map<std::string, double> error;
};

struct ReportScene {
    std::string name, camera;
    uint64_t triangles = 0;
    uint32_t width = 0, height = 0, bounces = 0;
    uint32_t reference_samples = 0;
    double reference_noise = 0;   // relMSE that the reference itself is expected to have
    std::vector<Trial> trials;
    std::vector<double> budgets;  // seconds, rising
    std::vector<ErrorPart> parts; // of one trial's error; empty: not taken apart
    std::string parts_of;         // which trial, by its options
    struct Shown {
        std::string title;
        Picture picture;
    };
    std::vector<std::vector<Shown>> pictures;  // rows
};

struct Report {
    std::string command, device, driver, cpu, revision;
    std::vector<std::string> groups;   // in the order of the plots' lines
    std::vector<std::string> metrics;  // a plot each
    std::vector<ReportScene> scenes;
};

// Same bytes for the same report.
std::string to_html(const Report& report);
// A line a trial, with a header.
std::string to_csv(const Report& report);

// RFC 4648.
std::string base64(std::string_view bytes);

}  // namespace myriad::tools
