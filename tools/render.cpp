// `myriad render SCENE -o out.exr`: a scene goes in, an image comes out.
#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>
#include <optional>

#include "scenes/scene.hpp"
#include "tools/commands.hpp"
#include "tools/exposure.hpp"
#include "tools/exr.hpp"
#include "tools/message.hpp"
#include "tools/output_file.hpp"
#include "tools/png.hpp"
#include "tools/progress.hpp"
#include "tools/render_image.hpp"
#include "tools/render_options.hpp"
#include "tools/trace.hpp"

namespace myriad::tools {
namespace {

struct Loaded {
    scenes::Scene scene;
    scenes::Triangles triangles;
    scenes::Camera camera;
};

Loaded load(const RenderOptions& options, Progress& progress) {
    Loaded loaded;
    loaded.scene = scenes::load(options.scene);
    scenes::apply_sky(loaded.scene, options.sky);
    loaded.triangles = scenes::flatten(loaded.scene, options.instances);
    loaded.camera = scenes::pick_camera(loaded.scene, loaded.triangles, options.camera);
    progress.clear();
    for (const std::string& warning : loaded.scene.warnings) say("warning", warning);
    return loaded;
}

FrameRun render_frame(const RunRecord& run, engine::Device& device, passes::Frame& frame, const scenes::Camera& camera) {
    FrameRun result;
    result.host = {"frame " + std::to_string(run.frames.size()), run.now_ms(), 0};
    frame.render(camera);
    result.host.ms = run.now_ms() - result.host.begin_ms;
    result.passes = frame.times();
    result.counters = frame.counters();
    for (const auto& [kind, use] : device.memory()) result.peak_bytes[kind] = use.peak;
    return result;
}

Picture to_picture(const std::vector<uint>& rgba, const Image& image) {
    Picture picture{image.width, image.height, {}};
    picture.rgb.reserve(rgba.size() * 3);
    for (const uint texel : rgba)
        for (int shift : {0, 8, 16}) picture.rgb.push_back(static_cast<uint8_t>(texel >> shift));
    return picture;
}

void write_images(const RenderOptions& options, RunRecord& run, Image& image, passes::Frame& frame) {
    if (!options.png.empty()) {
        run.exposure = options.exposure ? *options.exposure : auto_exposure(*image.rgb());
        write_png(options.png, to_picture(frame.tonemapped(static_cast<float>(*run.exposure)), image));
        run.files.push_back(options.png);
    }
    if (!options.exr.empty()) {
        image.metadata = image_metadata(run);
        write_exr(options.exr, image, options.full_floats ? ExrColour::full : ExrColour::half);
        run.files.push_back(options.exr);
    }
}

void write_reports(const RenderOptions& options, RunRecord& run) {
    if (!options.stats.empty()) write_text(options.stats, stats_json(run)), run.files.push_back(options.stats);
    if (!options.trace.empty()) write_text(options.trace, trace_json(run)), run.files.push_back(options.trace);
}

void render(const RenderOptions& options) {
    check_outputs(options);
    RunRecord run;
    Progress progress(options.quiet);
    const auto device = run.phase("device", [&] { return std::make_unique<engine::Device>(options.device); });
    run.device = device->info();

    progress.show("loading " + options.scene, 0);
    const Loaded loaded = run.phase("load", [&] { return load(options, progress); });
    run.scene = loaded.scene.name;
    run.camera = loaded.scene.cameras.empty() ? "(all in view)" : loaded.camera.name;

    passes::FrameSettings settings = options.frame;
    uint32_t number = 0;
    settings.progress = [&](const std::string& stage, double done) {
        progress.show(options.repeat > 1 && number ? "frame " + std::to_string(number) + ": " + stage : stage, done);
    };
    std::optional<engine::Cache> cache;
    if (!options.cache.empty()) settings.cache = &cache.emplace(options.cache);
    progress.show("building", 0);
    run.recorder_ms = run.now_ms();  // the recorder is the first thing that a frame makes
    const auto frame = run.phase("build", [&] { return std::make_unique<passes::Frame>(*device, loaded.scene, loaded.triangles, settings); });
    run.build = frame->build_steps();
    if (cache) run.cache = CacheUse{cache->found(), cache->missing(), cache->damaged()};
    if (cache && !cache->problem().empty()) progress.clear(), say("warning", cache->problem());
    run.size = frame->size();
    run.settings = settings_json(settings, frame->vpl_bound());
    run.settings["sky"] = choice_name(sky_choices(), options.sky);

    while (number++ < options.repeat) run.frames.push_back(render_frame(run, *device, *frame, loaded.camera));

    progress.show("writing", 0);
    Image image = read_image(*device, *frame, options.layers);
    require_finite(image);
    run.phase("write", [&] { write_images(options, run, image, *frame); });
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
