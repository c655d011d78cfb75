// What a run measured, and its two forms for reading: stats.json (spec, section 5) and a table.
#pragma once

#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "passes/frame.hpp"

namespace myriad::tools {

// A stretch of host time, in milliseconds since the run began.
struct HostPhase {
    std::string name;
    double begin_ms = 0, ms = 0;
};

struct FrameRun {
    std::optional<uint32_t> number;            // absent: one image is made, whatever is repeated
    std::optional<double> seconds;             // the moment; absent: the scene is at rest
    HostPhase host;                            // from the first recording to the last result
    std::vector<engine::PassTime> passes;      // as the recorder gives them
    passes::FrameCounters counters;
    std::map<std::string, uint64_t> peak_bytes;  // by kind of buffer, since the run began
};

// What the cache of derived data was good for: entries found, and not; of these, damaged ones, made anew.
struct CacheUse {
    uint64_t found = 0, missing = 0, damaged = 0;
};

struct RunRecord {
    engine::DeviceInfo device;
    std::string scene, camera;
    passes::SceneSize size;
    nlohmann::ordered_json settings;
    std::vector<HostPhase> phases;     // before and after the frames: load, build, write …
    std::vector<passes::BuildStep> build;  // what the phase of that name consists of, and a little more
    std::optional<CacheUse> cache;     // absent: there was none
    std::vector<FrameRun> frames;
    double recorder_ms = 0;            // when the recorder's host clock was 0
    std::optional<double> exposure;    // absent: no picture was asked for
    std::vector<std::string> files;    // written

    // Milliseconds since the run began.
    double now_ms() const { return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count(); }
    // Runs `work` as a phase of that name.
    template <class Work>
    auto phase(const std::string& name, Work work) {
        struct Entry {
            RunRecord& run;
            HostPhase phase;
            ~Entry() {
                phase.ms = run.now_ms() - phase.begin_ms;
                run.phases.push_back(std::move(phase));
            }
        } entry{*this, {name, now_ms(), 0}};
        return work();
    }

private:
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
};

struct PassSum {
    std::string name;
    double gpu_ms = 0, cpu_ms = 0;
};

// Passes of one name added up, in the order of their first appearance.
std::vector<PassSum> sum_passes(const std::vector<engine::PassTime>& passes);
// The median of each pass over the frames that have it.
std::vector<PassSum> median_passes(const std::vector<FrameRun>& frames);
double median(std::vector<double> values);  // of an even number: the mean of the middle two; not empty

// The settings under the names of their options; what the technique does not use is absent. `other_lights`: some are gathered beside VPLs.
nlohmann::ordered_json settings_json(const passes::FrameSettings& settings, float vpl_bound, bool other_lights = false);
double shortest(float value);                // as people write it: 0.1, not 0.10000000149

nlohmann::ordered_json counters_json(const FrameRun& frame);  // those that count something in this run
std::string stats_json(const RunRecord& run);
std::string stats_table(const RunRecord& run);

}  // namespace myriad::tools
