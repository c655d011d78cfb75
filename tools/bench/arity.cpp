// `myriad bench manylods-arity`: trees of arity 2, 4 and 8 over the same samples. Rows: what a tree takes to refit (`build`, on the host, makes
// the samples and their order, which all arities have in common), and cuts of VPL views through it, from the roots and from the frame
// before, while the scene's lights go around it a degree a frame. Arities take turns, so that a machine that slows down does so for all.
#include <chrono>
#include <cstdio>
#include <filesystem>

#include "compute/bsh/bsh.hpp"
#include "tools/bench/maps_bench.hpp"

namespace myriad::tools {
namespace {

constexpr uint arities[] = {2, 4, 8};

void measure_trees(engine::Device& device, const BenchOptions& options, const scenes::Scene& scene, const scenes::Triangles& triangles,
                   const std::string& source, const RowSink& sink) {
    const passes::GeometryData data = passes::geometry_data(scene, triangles);
    const passes::Geometry geometry(device, triangles, data);
    const auto start = std::chrono::steady_clock::now();
    const compute::BshLeaves leaves = compute::bsh_leaves(data.world, options.log2_samples, options.seed);
    const double build_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    struct Tried {
        compute::Bsh tree;
        BenchRow row;
    };
    std::vector<Tried> all;
    for (const uint arity : arities) {
        all.push_back({compute::Bsh(device, data.world, leaves, arity), {}});
        BenchRow& row = all.back().row;
        row.bench = "manylods-arity", row.scene = std::filesystem::path(source).filename().string(), row.technique = "refit";
        row.settings = {{"samples", uint64_t(1) << options.log2_samples}, {"arity", arity}};
        row.counters = {{"build_ms", build_ms}, {"blocks", double(all.back().tree.blocks())}, {"levels", double(all.back().tree.levels())}};
        row.bytes["bsh"] = all.back().tree.bytes();
    }
    engine::Recorder recorder(device);
    for (uint32_t run = 0; run <= options.repeats; ++run)  // run 0 warms up
        for (Tried& tried : all) {
            {
                auto scope = recorder.scope("refit");
                tried.tree.refit(recorder, geometry.positions(), geometry.triangles(), geometry.instances(), geometry.opacity());
            }
            recorder.submit_and_wait();
            const double ms = recorder.take_times().front().gpu_ms;
            if (run > 0) tried.row.ms.ms.push_back(ms);
        }
    for (Tried& tried : all) {
        std::printf("arity %u, %.1f MiB: ", tried.tree.arity(), double(tried.tree.bytes()) / (1 << 20));
        sink(tried.row);
    }
}

}  // namespace

void bench_arity(engine::Device& device, const BenchOptions& options, const RowSink& sink) {
    for (const uint arity : arities) compute::check_bsh_size(options.log2_samples, arity);
    const Turntable table = load_turntable(options);
    const auto& [source, scene, triangles, camera] = table;
    measure_trees(device, options, scene, triangles, source, sink);
    for (const uint32_t views : options.views.empty() ? std::vector<uint32_t>{1024} : options.views)
        for (const passes::CutUpdate update : {passes::CutUpdate::basic, passes::CutUpdate::incremental}) {
            struct Tried {
                std::unique_ptr<passes::Frame> frame;
                BenchRow row;
                Samples node_views;
            };
            std::vector<Tried> all;
            for (const uint arity : arities) {
                passes::FrameSettings settings = frame_settings(options, views);
                settings.maps.arity = arity;
                settings.maps.update = update;
                const char* technique = update == passes::CutUpdate::basic ? "basic" : "incremental";
                all.push_back({std::make_unique<passes::Frame>(device, scene, triangles, settings), maps_row("manylods-arity", source, technique, settings), {}});
            }
            // The first frame warms up, lets lists grow, and is what the next starts from.
            for (uint32_t f = 0; f <= options.repeats; ++f)
                for (Tried& tried : all) {
                    tried.frame->move_to(table.at(f));
                    tried.frame->render(camera);
                    if (f == 0) continue;
                    add_maps_times(tried.row, *tried.frame);
                    const passes::MapCounters& maps = *tried.frame->counters().maps;
                    tried.node_views.ms.push_back(double(maps.node_views));
                    tried.row.counters["cut"] = double(maps.cut), tried.row.counters["groups"] = double(maps.groups);
                    tried.row.counters["list_peak"] = double(maps.list_peak), tried.row.counters["batches"] = maps.batches;
                }
            for (Tried& tried : all) {
                tried.row.counters["node_views"] = tried.node_views.median();
                std::printf("arity %u: ", tried.frame->settings().maps.arity);
                sink(tried.row);
            }
        }
}

}  // namespace myriad::tools
