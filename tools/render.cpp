// `myriad render SCENE -o out.exr`: a scene goes in, an image comes out.
#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>
#include <optional>

#include "tools/capture.hpp"
#include "tools/commands.hpp"
#include "tools/load_scene.hpp"
#include "tools/message.hpp"
#include "tools/output_file.hpp"
#include "tools/progress.hpp"
#include "tools/render_options.hpp"
#include "tools/trace.hpp"
#include "tools/write_images.hpp"

namespace myriad::tools {
namespace {

// What is rendered: moments, and how often each. Without a number it is one image.
struct Shot {
    std::optional<uint32_t> number;
    std::optional<double> seconds;  // absent: the scene is at rest
};

std::vector<Shot> shots(const RenderOptions& options) {
    if (!options.frames) return std::vector<Shot>(options.repeat, {{}, options.moves() ? std::optional(options.time.value_or(0)) : std::nullopt});
    const double fps = options.fps.value_or(RenderOptions::usual_fps);
    std::vector<Shot> out;
    for (uint32_t i = options.frames->first; i <= options.frames->second; ++i) out.push_back({i, double(i) / fps});
    return out;
}

void write_reports(const RenderOptions& options, RunRecord& run) {
    if (has_number(options.stats)) {
        for (const FrameRun& frame : run.frames) {
            RunRecord one = run;
            one.frames = {frame};
            write_text(numbered(options.stats, frame.number), stats_json(one));
        }
        run.files.push_back(options.stats);
    } else if (!options.stats.empty()) {
        write_text(options.stats, stats_json(run)), run.files.push_back(options.stats);
    }
    if (options.trace.empty()) return;
    write_text(options.trace, trace_json(run)), run.files.push_back(options.trace);
    if (!run.device.common_clock)
        say("warning", "\"" + run.device.name + "\" shares no clock with the host (VK_EXT_calibrated_timestamps): in " + options.trace +
                           ", device times stand where no pass begins before it was recorded");
}

// Renders one shot after the other.
class Film {
public:
    Film(const RenderOptions& options, RunRecord& run, engine::Device& device, LoadedScene& loaded, Progress& progress)
        : options_(options), run_(run), device_(device), loaded_(loaded), progress_(progress), settings_(options.frame), shots_(shots(options)),
          cameras_(loaded.scene.cameras) {
        settings_.progress = [this](const std::string& stage, double done) {
            const std::string which = "frame " + std::to_string(run_.frames.size() + 1) + " of " + std::to_string(shots_.size());
            progress_.show(shots_.size() > 1 ? which + ": " + stage : stage, done);
        };
        if (!options.cache.empty()) settings_.cache = &cache_.emplace(options.cache);
    }

    void make() {
        for (const Shot& shot : shots_) {
            const scenes::Camera camera = prepare(shot);
            run_.frames.push_back(render(shot, camera));
            if (shot.number || run_.frames.size() == shots_.size()) write(shot);
        }
    }

private:
    // Sets the scene for the shot.
    scenes::Camera prepare(const Shot& shot) {
        if (!frame_) build();
        if (loaded_.triangles.motion.plays() && moment_ != shot.seconds) {
            const scenes::Moment moment = scenes::moment_at(loaded_.scene, loaded_.triangles.motion, *shot.seconds);
            frame_->move_to(moment);
            cameras_ = moment.cameras;
            moment_ = shot.seconds;
        }
        return loaded_.camera_at(shot.seconds, cameras_);
    }

    void build() {
        progress_.show("building", 0);
        run_.recorder_ms = run_.now_ms();  // the recorder is the first thing that a frame makes
        run_.phase("build", [&] { frame_ = std::make_unique<passes::Frame>(device_, loaded_.scene, loaded_.triangles, settings_); });
        run_.build = frame_->build_steps();
        if (cache_) run_.cache = CacheUse{cache_->found(), cache_->missing(), cache_->damaged()};
        if (cache_ && !cache_->problem().empty()) progress_.clear(), say("warning", cache_->problem());
        run_.size = frame_->size();
    }

    FrameRun render(const Shot& shot, const scenes::Camera& camera) {
        FrameRun result;
        result.host = {"frame " + std::to_string(shot.number.value_or(uint32_t(run_.frames.size()))), run_.now_ms(), 0};
        result.number = shot.number, result.seconds = shot.seconds;
        std::optional<RenderdocCapture> capture;
        if (options_.capture_frame == run_.frames.size()) capture.emplace();
        frame_->render(camera);
        if (capture) capture->end();
        result.host.ms = run_.now_ms() - result.host.begin_ms;
        result.passes = frame_->times();
        result.counters = frame_->counters();
        for (const auto& [kind, use] : device_.memory()) result.peak_bytes[kind] = use.peak;
        return result;
    }

    void write(const Shot& shot) {
        progress_.show("writing", 0);
        run_.settings = image_settings(options_, *frame_, loaded_, shot.number, shot.seconds);
        Image image = read_image(device_, *frame_, options_.layers);
        require_finite(image);
        run_.phase(shot.number ? "frame " + std::to_string(*shot.number) + ": write" : "write", [&] { write_images(options_, run_, image, *frame_, shot.number); });
    }

    const RenderOptions& options_;
    RunRecord& run_;
    engine::Device& device_;
    LoadedScene& loaded_;
    Progress& progress_;
    passes::FrameSettings settings_;
    const std::vector<Shot> shots_;
    std::vector<scenes::Camera> cameras_;  // at the moment; the scene keeps them at rest, for each moment starts from there
    std::optional<engine::Cache> cache_;
    std::unique_ptr<passes::Frame> frame_;
    std::optional<double> moment_;  // at which the scene stands, of those who move
};

void render(const RenderOptions& options) {
    check_outputs(options);
    RunRecord run;
    Progress progress(options.quiet);
    const auto device = run.phase("device", [&] { return std::make_unique<engine::Device>(options.device); });
    run.device = device->info();

    progress.show("loading " + options.scene, 0);
    std::vector<double> moments;
    for (const Shot& shot : shots(options))
        if (shot.seconds) moments.push_back(*shot.seconds);
    LoadedScene loaded = run.phase("load", [&] {
        return load_scene(options, options.instances, moments, options.lights_of_environment(), options.frame.seed, progress);
    });
    run.scene = loaded.scene.name;
    run.camera = loaded.camera_name();

    Film(options, run, *device, loaded, progress).make();
    write_reports(options, run);
    progress.clear();
    if (!options.quiet) std::fputs(stats_table(run).c_str(), stdout);
}

}  // namespace

void add_render(CLI::App& app) {
    CLI::App* command = app.add_subcommand("render", "Render an image of a scene");
    const std::shared_ptr<RenderOptions> options = add_render_options(*command);
    command->callback([options] { render(*options); });
}

}  // namespace myriad::tools
