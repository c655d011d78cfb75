// Timed experiments: each writes measured rows, one JSON object a line (spec, section 5).
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/device.hpp"

namespace myriad::tools {

// Milliseconds of repeated runs.
struct Samples {
    std::vector<double> ms;
    double median() const;
    nlohmann::json json() const;  // {"median", "min", "max", "n"}
};

// One measured row. What is absent was not run.
struct BenchRow {
    std::string bench, scene, technique;
    uint64_t views = 0;
    nlohmann::json settings = nlohmann::json::object();
    Samples ms;
    std::map<std::string, Samples> stages;
    std::map<std::string, double> counters;
    std::map<std::string, uint64_t> bytes;
    std::map<std::string, double> error;
    bool extrapolated = false;

    nlohmann::json json(const engine::DeviceInfo& device) const;
};

struct BenchOptions {
    std::string scene;              // empty: the experiment's own
    std::string camera;
    std::vector<uint32_t> views;    // empty: the experiment's own
    uint32_t log2_samples = 20;
    uint32_t arity = 8;             // of the tree over them
    uint32_t map_size = 32;
    float epsilon = 1;
    uint32_t repeats = 5;
    uint64_t memory_limit = 0;
    uint32_t seed = 1;
    // Of some experiments only (Bench::own):
    std::string animation;          // empty: the first clip
    uint32_t frames = 48;
    std::vector<uint32_t> items;    // empty: the experiment's own
    uint32_t depth = 10;            // of an octree
    uint32_t bounces = 1;           // of light
    std::vector<uint32_t> picks;    // VPLs that a pixel gathers; empty: the experiment's own
    std::vector<uint32_t> map_sizes, levels; // of maps' sides; of the scene's octree; empty: the experiment's own (megaviews-views: no octree)
    std::vector<std::string> distributions;  // of views; empty: all that the experiment has
    uint32_t measured = 65536;      // views: beyond that what draws each view for itself is extrapolated
    std::vector<std::string> scenes;         // empty: `scene`
    std::vector<std::string> techniques;     // empty: all
    std::vector<std::string> parameters;     // empty: all
    std::vector<double> budgets = {0.5, 1, 2, 5, 10};  // seconds a frame
    std::string references;         // a folder; empty: they are not kept
    double reference_seconds = 120;
    uint32_t width = 640, height = 360;
    std::string report;             // empty: not written
    std::string csv, plot, images;  // empty: not written
};

// Called with each row as soon as it is measured.
using RowSink = std::function<void(const BenchRow&)>;

struct Bench {
    const char* name;
    const char* what;
    void (*run)(engine::Device& device, const BenchOptions& options, const RowSink& sink);
    std::vector<std::string> own = {};  // options that it takes and others do not
    std::optional<uint32_t> map_size = {};  // what it has where others have 32 texels
    std::optional<float> epsilon = {};      // and 1
};
const std::vector<Bench>& benches();

// bench/manylods.cpp
void bench_manylods(engine::Device& device, const BenchOptions& options, const RowSink& sink);
// bench/table1.cpp
void bench_table1(engine::Device& device, const BenchOptions& options, const RowSink& sink);
// bench/table2.cpp
void bench_table2(engine::Device& device, const BenchOptions& options, const RowSink& sink);
// bench/fig8.cpp
void bench_fig8(engine::Device& device, const BenchOptions& options, const RowSink& sink);
// bench/arity.cpp
void bench_arity(engine::Device& device, const BenchOptions& options, const RowSink& sink);
// bench/equal_time.cpp
void bench_equal_time(engine::Device& device, const BenchOptions& options, const RowSink& sink);
// bench/megaviews.cpp
void bench_megaviews(engine::Device& device, const BenchOptions& options, const RowSink& sink);
// bench/maps_error.cpp
void bench_resolution(engine::Device& device, const BenchOptions& options, const RowSink& sink);
void bench_coverage(engine::Device& device, const BenchOptions& options, const RowSink& sink);
// bench/bias.cpp
void bench_bias(engine::Device& device, const BenchOptions& options, const RowSink& sink);
// bench/error.cpp
void bench_error(engine::Device& device, const BenchOptions& options, const RowSink& sink);
// bench/gather.cpp
void bench_gather(engine::Device& device, const BenchOptions& options, const RowSink& sink);
// bench/octree.cpp
void bench_octree(engine::Device& device, const BenchOptions& options, const RowSink& sink);
// bench/sort.cpp
void bench_sort(engine::Device& device, const BenchOptions& options, const RowSink& sink);
// bench/stability.cpp
void bench_stability(engine::Device& device, const BenchOptions& options, const RowSink& sink);

}  // namespace myriad::tools
