// What maps cost in error. All VPLs are gathered and nothing is filtered, so that maps make the whole error, which is the image's against the same VPLs with exact
// rays. `--images` writes the pictures.
//   `myriad bench megaviews-resolution`: Figures 12 to 15 of MegaViews. What larger maps take, drawn for many views at once and for each, and what less of a scene's
//   tree does: its octree with fewer and more levels.
//   `myriad bench coverage`: what nodes smaller than a texel cover, and how much light that loses or lets through.
#include <cstdio>

#include "tools/bench/maps_bench.hpp"
#include "tools/exposure.hpp"
#include "tools/metrics.hpp"
#include "tools/png.hpp"
#include "tools/render_image.hpp"
#include "tools/render_options.hpp"

namespace myriad::tools {
namespace {

using passes::Visibility;

class Experiment {
public:
    Experiment(const char* bench, engine::Device& device, const BenchOptions& options, const RowSink& sink)
        : bench_(bench), device_(device), options_(options), sink_(sink), still_(options, "builtin:atrium") {
        std::printf("scene: %s, %zu triangles, epsilon %g\n", still_.source.c_str(), size_t(still_.triangles.count()), options.epsilon);
    }

    void resolution(uint32_t views) {
        passes::FrameSettings settings = all_of(views);
        const Image reference = render(settings, "rays", nullptr);
        for (const uint32_t size : options_.map_sizes.empty() ? std::vector<uint32_t>{16, 32, 64, 128, 256} : options_.map_sizes) {
            settings.maps.map_size = size;
            for (const auto& [technique, visibility] : {std::pair{"manylods", Visibility::manylods}, std::pair{"megaviews", Visibility::megaviews}}) {
                settings.visibility = visibility;
                render(settings, technique, &reference);
            }
        }
        settings.maps.map_size = options_.map_size;
        settings.visibility = Visibility::megaviews;
        for (const uint32_t levels : options_.levels.empty() ? std::vector<uint32_t>{8, 9, 10, 11} : options_.levels) {
            settings.octree_levels = levels;
            render(settings, "megaviews", &reference);
        }
    }

    void coverage(uint32_t views) {
        passes::FrameSettings settings = all_of(views);
        const Image reference = render(settings, "rays", nullptr);
        for (const auto& [technique, visibility] : {std::pair{"manylods", Visibility::manylods}, std::pair{"megaviews", Visibility::megaviews}}) {
            settings.visibility = visibility;
            if (visibility == Visibility::megaviews && !options_.levels.empty()) settings.octree_levels = options_.levels[0];
            for (const auto& choice : coverages()) {
                settings.maps.coverage = choice.second;
                render(settings, technique, &reference);
            }
        }
        settings.octree_levels = 0;
        settings.visibility = Visibility::brute;
        render(settings, "brute", &reference);
    }

private:
    passes::FrameSettings all_of(uint32_t views) const {
        passes::FrameSettings settings = frame_settings(options_, views);
        settings.subset = 0;
        settings.filter = false;
        settings.visibility = Visibility::rays;
        return settings;
    }

    // A first frame that warms up, then those that count. Without a reference it is the reference that is made: once, and no row.
    Image render(const passes::FrameSettings& settings, const char* technique, const Image* reference) {
        device_.reset_memory_peaks();
        passes::Frame frame(device_, still_.scene, still_.triangles, settings);
        BenchRow row = maps_row(bench_, still_.source, technique, settings);
        for (uint32_t r = 0; r <= (reference ? options_.repeats : 0); ++r) {
            frame.render(still_.camera);
            if (r > 0) add_maps_times(row, frame);
        }
        const Image image = read_image(device_, frame, {"indirect"});
        if (!reference) exposure_ = auto_exposure(*image.rgb());
        if (!options_.images.empty()) {
            const std::string kind = !reference ? "" : "-" + std::to_string(settings.maps.map_size) + (settings.octree_levels ? "-svo" + std::to_string(settings.octree_levels) : "") +
                                     (settings.maps.coverage == coverage_exact ? "" : "-" + choice_name(coverages(), settings.maps.coverage));
            write_png(options_.images + "/" + technique + "-" + std::to_string(settings.vpls) + kind + ".png",
                      to_picture(frame.tonemapped(float(exposure_)), image.width, image.height));
        }
        if (!reference) return image;
        const Metrics metrics = measure(*reference, image, 0.01);
        row.error = {{"relMSE", metrics.rel_mse}, {"SSIM", metrics.ssim}, {"PSNR", metrics.psnr}, {"bias", indirect_light(image) / indirect_light(*reference) - 1}};
        const passes::MapCounters& maps = *frame.counters().maps;
        row.counters = {{"batches", double(maps.batches)}, {"groups", double(maps.groups)}};
        if (settings.visibility == Visibility::manylods) row.counters["cut"] = double(maps.cut);
        if (settings.visibility == Visibility::megaviews) row.counters["pairs"] = double(maps.pairs), row.counters["pairs_rendered"] = double(maps.pairs_rendered), row.counters["shared_maps"] = double(maps.shared_maps);
        if (settings.visibility == Visibility::megaviews && maps.pairs_rendered)
            row.counters["views_per_rendered_pair"] = double(maps.views_of_rendered) / double(maps.pairs_rendered);
        set_bytes(row, device_);
        sink_(row);
        return image;
    }

    const char* bench_;
    engine::Device& device_;
    const BenchOptions& options_;
    const RowSink& sink_;
    StillScene still_;
    double exposure_ = 1;  // the reference's, for all pictures
};

template <class Run>
void for_each_count(const char* bench, engine::Device& device, const BenchOptions& options, const RowSink& sink, const Run& run) {
    require_folder(options.images);
    Experiment experiment(bench, device, options, sink);
    for (const uint32_t views : options.views.empty() ? std::vector<uint32_t>{1024} : options.views) run(experiment, views);
}

}  // namespace

void bench_resolution(engine::Device& device, const BenchOptions& options, const RowSink& sink) {
    for_each_count("megaviews-resolution", device, options, sink, [](Experiment& experiment, uint32_t views) { experiment.resolution(views); });
}

void bench_coverage(engine::Device& device, const BenchOptions& options, const RowSink& sink) {
    for_each_count("coverage", device, options, sink, [](Experiment& experiment, uint32_t views) { experiment.coverage(views); });
}

}  // namespace myriad::tools
