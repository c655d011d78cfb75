// `myriad bench manylods-fig8`: Figure 8 of ManyLoDs. A clip plays, and each of its frames updates the cuts of all VPLs' views: from the roots
// (basic), from the last frame's (incremental: the figure's "full") and lazily. A row has a sample for each frame; `--csv` has a line for each,
// medians over `--repeat` plays, with the share of node-views that lag and what they do to the image; `--plot` draws the times of the cut.
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "scenes/moment.hpp"
#include "scenes/sky.hpp"
#include "tools/bench/maps_bench.hpp"
#include "tools/metrics.hpp"
#include "tools/output_file.hpp"
#include "tools/plot.hpp"
#include "tools/render_image.hpp"

namespace myriad::tools {
namespace {

using passes::CutUpdate;

constexpr double fps = 24;

struct Technique {
    const char* name;
    CutUpdate update;
    const char* colour;
};
const Technique techniques[] = {
    {"basic", CutUpdate::basic, "#999999"},
    {"incremental", CutUpdate::incremental, "#0072b2"},
    {"lazy", CutUpdate::lazy, "#d55e00"},
};

// One frame of a clip as one technique shows it.
struct Shown {
    Samples cut;
    double node_views = 0, maps_drawn = 0, invalid_share = 0;
    Image image;
};

struct Clip {
    scenes::Scene scene;
    scenes::Triangles triangles;
    scenes::Camera camera;
    uint32_t frames = 0;
    double seconds(uint32_t frame) const { return frame / fps; }
};

Clip load(const BenchOptions& options, const std::string& source) {
    Clip clip;
    clip.scene = scenes::load(source, options.seed);
    scenes::apply_sky(clip.scene, scenes::SkyChoice::automatic);
    if (clip.scene.clips.empty()) throw InputError("\"" + source + "\" has no animation to play; give another --scene");
    const scenes::Playback playback = scenes::pick_clips(clip.scene, options.animation.empty() ? "0" : options.animation);
    clip.triangles = scenes::flatten(clip.scene, scenes::Sharing::automatic, playback);
    clip.camera = scenes::pick_camera(clip.scene, clip.triangles, options.camera);
    clip.frames = options.frames;
    return clip;
}

// Plays the clip once, from frame 0 with its complete cuts on.
void play(engine::Device& device, passes::Frame& frame, const Clip& clip, BenchRow& row, std::vector<Shown>& shown) {
    const auto render = [&](uint32_t number) {
        frame.move_to(scenes::moment_at(clip.scene, clip.triangles.motion, clip.seconds(number)));
        frame.render(clip.camera);
    };
    render(0);
    for (int rest = 0; rest < 32 && frame.counters().maps->invalid > 0; ++rest) render(0);  // lazy cuts come from the last play's end
    for (uint32_t number = 1; number <= clip.frames; ++number) {
        render(number);
        add_maps_times(row, frame);
        Shown& s = shown[number - 1];
        for (const engine::PassTime& pass : frame.times())
            if (pass.name == "cut") s.cut.ms.push_back(pass.gpu_ms);
        const passes::MapCounters& maps = *frame.counters().maps;
        s.node_views = double(maps.node_views);
        s.maps_drawn = double(maps.maps_drawn.value_or(row.views));
        s.invalid_share = maps.cut ? double(maps.invalid) / double(maps.cut) : 0;
        if (s.image.width == 0) s.image = read_image(device, frame, {});
    }
}

std::string csv(const Clip& clip, const std::vector<std::vector<Shown>>& shown, const std::vector<double>& errors) {
    std::string text = "frame,seconds";
    for (const Technique& t : techniques)
        for (const char* column : {"cut_ms", "node_views", "maps_drawn"}) text += std::string(",") + t.name + "_" + column;
    text += ",lazy_invalid_share,lazy_relMSE\n";
    char number[64];
    const auto add = [&](const char* format, double value) { text.append(number, size_t(std::snprintf(number, sizeof number, format, value))); };
    for (uint32_t f = 0; f < clip.frames; ++f) {
        text += std::to_string(f + 1);
        add(",%.4f", clip.seconds(f + 1));
        for (const auto& technique : shown) add(",%.3f", technique[f].cut.median()), add(",%.0f", technique[f].node_views), add(",%.0f", technique[f].maps_drawn);
        add(",%.6g", shown.back()[f].invalid_share);
        add(",%.4g\n", errors[f]);
    }
    return text;
}

}  // namespace

void bench_fig8(engine::Device& device, const BenchOptions& options, const RowSink& sink) {
    const std::string source = options.scene.empty() ? "builtin:teatime" : options.scene;
    for (const std::string& file : {options.csv, options.plot})
        if (!file.empty()) require_writable(file);
    const Clip clip = load(options, source);
    std::printf("scene: %s, %zu triangles, 2^%u samples, maps 2 x %u^2, epsilon %g, %u frames of 1/%g s\n", source.c_str(),
                size_t(clip.triangles.count()), options.log2_samples, options.map_size, options.epsilon, clip.frames, fps);
    for (const uint32_t views : options.views.empty() ? std::vector<uint32_t>{1024} : options.views) {
        std::vector<std::vector<Shown>> shown;
        std::vector<double> errors;
        for (const Technique& technique : techniques) {
            passes::FrameSettings settings = frame_settings(options, views);
            settings.maps.update = technique.update;
            device.reset_memory_peaks();
            passes::Frame frame(device, clip.scene, clip.triangles, settings);
            BenchRow row = maps_row("manylods-fig8", source, technique.name, settings);
            row.settings["frames"] = clip.frames, row.settings["fps"] = fps;
            std::vector<Shown>& frames = shown.emplace_back(clip.frames);
            for (uint32_t repeat = 0; repeat < options.repeats; ++repeat) play(device, frame, clip, row, frames);
            const auto median = [&](auto member) {
                Samples samples;
                for (const Shown& s : frames) samples.ms.push_back(s.*member);
                return samples.median();
            };
            row.counters["node_views"] = median(&Shown::node_views);
            row.counters["maps_drawn"] = median(&Shown::maps_drawn);
            if (technique.update == CutUpdate::lazy) row.counters["invalid_share"] = median(&Shown::invalid_share);
            double total = 0;
            for (uint32_t f = 0; f < clip.frames && shown.size() > 1; ++f) {
                const double error = measure(shown[0][f].image, frames[f].image, 0.01).rel_mse;
                total += error;
                if (technique.update == CutUpdate::lazy) errors.push_back(error);
            }
            if (shown.size() > 1) row.error["relMSE"] = total / clip.frames;  // against the basic cut's images
            set_bytes(row, device);
            sink(row);
        }
        if (!options.csv.empty()) write_text(options.csv, csv(clip, shown, errors));
        if (options.plot.empty()) continue;
        Plot plot{"Cuts of " + std::to_string(views) + " views through " + std::filesystem::path(source).filename().string(), "frame", "cut, ms", {}};
        for (size_t t = 0; t < shown.size(); ++t) {
            Plot::Line line{techniques[t].name, techniques[t].colour, {}};
            for (uint32_t f = 0; f < clip.frames; ++f) line.points.push_back({double(f + 1), shown[t][f].cut.median()});
            plot.lines.push_back(std::move(line));
        }
        write_text(options.plot, to_svg(plot));
    }
}

}  // namespace myriad::tools
