// `myriad bench manylods-ism`: imperfect shadow maps given the time that ManyLoDs' maps take (ManyLoDs, Figures 4 and 7), with diffuse and with
// glTF's glossy receivers. Both light with the same VPLs, gathered all and unfiltered, so the maps make the whole difference; ISM's points a map are
// searched until its maps take as long. Errors are against the same VPLs with exact rays. `--images` writes the pictures, EXR and PNG.
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "scenes/sky.hpp"
#include "tools/bench/maps_bench.hpp"
#include "tools/exposure.hpp"
#include "tools/exr.hpp"
#include "tools/metrics.hpp"
#include "tools/png.hpp"
#include "tools/render_image.hpp"

namespace myriad::tools {
namespace {

using passes::Brdf;
using passes::Visibility;

constexpr uint32_t least_points = 64;
constexpr double near_enough = 0.05;  // of the time
constexpr int tries = 6;

struct Stage {
    engine::Device& device;
    const BenchOptions& options;
    std::string source;
    const scenes::Scene& scene;
    const scenes::Triangles& triangles;
    scenes::Camera camera;
};

struct Made {
    BenchRow row;
    Image image;
    Picture picture;
};

// A first frame that warms up, then `repeats` that count. `exposure`: of the picture; 0: found here.
Made make(const Stage& stage, const passes::FrameSettings& settings, const char* technique, uint32_t repeats, double& exposure) {
    stage.device.reset_memory_peaks();
    passes::Frame frame(stage.device, stage.scene, stage.triangles, settings);
    Made made;
    made.row = maps_row("manylods-ism", stage.source, technique, settings);
    made.row.settings["brdf"] = settings.brdf == Brdf::gltf ? "gltf" : "diffuse";
    for (uint32_t r = 0; r <= repeats; ++r) {
        frame.render(stage.camera);
        if (r > 0) add_maps_times(made.row, frame);
    }
    made.image = read_image(stage.device, frame, {});
    if (exposure == 0) exposure = auto_exposure(*made.image.rgb());
    made.picture = to_picture(frame.tonemapped(float(exposure)), made.image.width, made.image.height);
    if (frame.counters().maps && frame.counters().maps->cut) made.row.counters["cut"] = double(frame.counters().maps->cut);
    set_bytes(made.row, stage.device);
    return made;
}

// The points a map whose maps take `ms`, as near as a few tries come: the time is nearly a line over the points.
Made ism_in(const Stage& stage, passes::FrameSettings settings, double ms, double& exposure) {
    settings.visibility = Visibility::ism;
    const double most = double(uint64_t(1) << settings.log2_samples);
    double points = std::min(8192.0, most), last_points = 0, last_ms = 0;
    for (int i = 0;; ++i) {
        settings.maps.ism.points = uint32_t(points);
        Made made = make(stage, settings, "ism", i + 1 < tries ? 1 : stage.options.repeats, exposure);
        const double now = made.row.ms.median();
        std::printf("  ism with %u points a map: %.1f ms of %.1f\n", settings.maps.ism.points, now, ms);
        std::fflush(stdout);
        if (std::abs(now / ms - 1) <= near_enough || i + 1 >= tries || (points <= least_points && now > ms) || (points >= most && now < ms))
            return i + 1 >= tries ? std::move(made) : make(stage, settings, "ism", stage.options.repeats, exposure);
        const double slope = i > 0 && points != last_points ? (now - last_ms) / (points - last_points) : now / points;
        last_points = points, last_ms = now;
        points = std::clamp(std::round(slope > 0 ? points + (ms - now) / slope : 2 * points), double(least_points), most);
    }
}

}  // namespace

void bench_equal_time(engine::Device& device, const BenchOptions& options, const RowSink& sink) {
    const std::string source = options.scene.empty() ? "builtin:atrium" : options.scene;
    require_folder(options.images);
    scenes::Scene scene = scenes::load(source, options.seed);
    scenes::apply_sky(scene, scenes::SkyChoice::automatic);
    const scenes::Triangles triangles = scenes::flatten(scene);
    const Stage stage{device, options, source, scene, triangles, scenes::pick_camera(scene, triangles, options.camera)};
    for (const uint32_t views : options.views.empty() ? std::vector<uint32_t>{1024} : options.views)
        for (const Brdf brdf : {Brdf::diffuse, Brdf::gltf}) {
            passes::FrameSettings settings = frame_settings(options, views);
            settings.brdf = brdf;
            settings.subset = 0;
            settings.filter = false;
            const auto with = [&](Visibility visibility) {
                passes::FrameSettings s = settings;
                s.visibility = visibility;
                return s;
            };
            double exposure = 0;
            const Made reference = make(stage, with(Visibility::rays), "rays", 1, exposure);
            Made lods = make(stage, with(Visibility::manylods), "manylods", options.repeats, exposure);
            Made ism = ism_in(stage, settings, lods.row.ms.median(), exposure);
            for (Made* made : {&lods, &ism}) {
                const Metrics metrics = measure(reference.image, made->image, 0.01);
                made->row.error = {{"relMSE", metrics.rel_mse}, {"SSIM", metrics.ssim}};
                sink(made->row);
            }
            if (options.images.empty()) continue;
            const std::string stem = options.images + "/" + (brdf == Brdf::gltf ? "gltf" : "diffuse") + "-" + std::to_string(views) + "-";
            for (const Made* made : std::initializer_list<const Made*>{&reference, &lods, &ism}) {
                write_png(stem + made->row.technique + ".png", made->picture);
                write_exr(stem + made->row.technique + ".exr", made->image);
            }
        }
}

}  // namespace myriad::tools
