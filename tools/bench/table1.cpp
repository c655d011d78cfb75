// `myriad bench manylods-table1`: Table 1 of ManyLoDs. The scene's lights, without those that are emitting surfaces, go around it, 1 and 10
// degrees a frame, and the maps of their VPLs are drawn anew in each. Rows: the paper's competitors and the three updates of the cuts; `ms`
// is what the maps take, cut and splat or what stands in their place, `error` is the last frame's, against the same VPLs with exact rays.
#include <cstdio>

#include "tools/bench/maps_bench.hpp"
#include "tools/metrics.hpp"
#include "tools/render_image.hpp"

namespace myriad::tools {
namespace {

using passes::CutUpdate;
using passes::Visibility;

struct Technique {
    const char* name;
    Visibility visibility;
    CutUpdate update = CutUpdate::basic;
    bool revalidate = false;
};

// Both ways of the incremental update are rows: the paper's looks at every node-view of the last cut again.
const Technique techniques[] = {
    {"brute", Visibility::brute},
    {"ism", Visibility::ism},
    {"basic", Visibility::manylods},
    {"incremental", Visibility::manylods, CutUpdate::incremental, true},
    {"incremental", Visibility::manylods, CutUpdate::incremental},
    {"lazy", Visibility::manylods, CutUpdate::lazy},
};

}  // namespace

void bench_table1(engine::Device& device, const BenchOptions& options, const RowSink& sink) {
    const Turntable table = load_turntable(options);
    const auto& [source, scene, triangles, camera] = table;
    const std::vector<uint32_t> counts = options.views.empty() ? std::vector<uint32_t>{1024} : options.views;
    for (const uint32_t views : counts)
        for (const double step : {1.0, 10.0}) {
            // The first frame warms up, lets lists grow, and is what the next starts from.
            const auto play = [&](passes::Frame& frame, auto after) {
                for (uint32_t f = 0; f <= options.repeats; ++f) {
                    frame.move_to(table.at(f * step));
                    frame.render(camera);
                    if (f > 0) after();
                }
                return read_image(device, frame, {});
            };
            const auto reference = [&] {
                passes::FrameSettings settings = frame_settings(options, views);
                settings.visibility = Visibility::rays;
                passes::Frame frame(device, scene, triangles, settings);
                return play(frame, [] {});
            }();
            for (const Technique& technique : techniques) {
                passes::FrameSettings settings = frame_settings(options, views);
                settings.visibility = technique.visibility;
                settings.maps.update = technique.update;
                settings.maps.revalidate = technique.revalidate;
                device.reset_memory_peaks();
                passes::Frame frame(device, scene, triangles, settings);
                BenchRow row = maps_row("manylods-table1", source, technique.name, settings);
                row.settings["light_step_deg"] = step;
                std::vector<double> node_views, invalid;
                const Image image = play(frame, [&] {
                    add_maps_times(row, frame);
                    if (!frame.counters().maps) return;
                    const passes::MapCounters& maps = *frame.counters().maps;
                    node_views.push_back(double(maps.node_views));
                    invalid.push_back(maps.cut ? double(maps.invalid) / double(maps.cut) : 0);
                    if (maps.cut) row.counters["cut"] = double(maps.cut);
                    if (maps.triangle_views) row.counters["triangle_views"] = double(maps.triangle_views);
                });
                if (row.counters.contains("cut")) row.counters["node_views"] = Samples{node_views}.median();
                if (technique.update == CutUpdate::lazy) row.counters["invalid_share"] = Samples{invalid}.median();
                set_bytes(row, device);
                const Metrics metrics = measure(reference, image, 0.01);
                row.error = {{"relMSE", metrics.rel_mse}, {"SSIM", metrics.ssim}};
                sink(row);
            }
        }
}

}  // namespace myriad::tools
