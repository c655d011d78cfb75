// Runs programs through VK_LAYER_MYRIAD_profiler and reads what it wrote. Tests only.
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "tests/program.hpp"

namespace myriad::profiler {

using tools::Arguments;
using tools::Environment;
using tools::Outcome;
using tools::operator+;

struct Row {
    int count = 0;
    double median_ms = 0, total_ms = 0, min_ms = 0, max_ms = 0;
};

// What a run left behind.
struct Measured {
    nlohmann::json trace;
    std::map<std::string, Row> rows;  // by "kind,name"

    std::vector<nlohmann::json> spans(const std::string& kind) const {
        std::vector<nlohmann::json> found;
        for (const auto& event : trace["traceEvents"])
            if (event["ph"] == "X" && event["cat"] == kind) found.push_back(event);
        return found;
    }
    std::set<std::string> tracks() const {
        std::set<std::string> names;
        for (const auto& event : trace["traceEvents"])
            if (event["name"] == "thread_name") names.insert(event["args"]["name"]);
        return names;
    }
    std::set<std::string> counters() const {
        std::set<std::string> names;
        for (const auto& event : trace["traceEvents"])
            if (event["ph"] == "C") names.insert(event["name"]);
        return names;
    }
    int count(const std::string& row) const { return rows.contains(row) ? rows.at(row).count : 0; }
};

inline Measured read_measured(const std::string& trace, const std::string& summary) {
    Measured measured;
    measured.trace = nlohmann::json::parse(std::ifstream(trace));
    std::ifstream csv(summary);
    std::string line;
    std::getline(csv, line);
    while (std::getline(csv, line)) {
        size_t comma = line.size();
        for (int i = 0; i < 5; ++i) comma = line.rfind(',', comma - 1);
        Row row;
        std::sscanf(line.c_str() + comma, ",%d,%lf,%lf,%lf,%lf", &row.count, &row.median_ms, &row.total_ms, &row.min_ms, &row.max_ms);
        measured.rows[line.substr(0, comma)] = row;
    }
    return measured;
}

// The settings of whoever runs the tests stay out: no home, no settings file but the test's.
inline Environment with_layer(const std::string& folder, const Environment& more = {}, const std::string& layers = "VK_LAYER_MYRIAD_profiler") {
    const Environment environment = {{"VK_LAYER_PATH", MYRIAD_LAYERS ":/usr/share/vulkan/explicit_layer.d"}, {"VK_INSTANCE_LAYERS", layers},
                                     {"XDG_DATA_HOME", folder}, {"VK_LAYER_SETTINGS_PATH", folder}, {"MYRIAD_CACHE", "off"},
                                     {"MYRIAD_PROFILER_OUTPUT_FILE", folder + "/trace.json"}};
    return environment + more;
}

}  // namespace myriad::profiler
