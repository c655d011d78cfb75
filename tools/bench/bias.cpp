// `myriad bench bias`: what each approximation costs in error while all else is exact, so that a user can choose: the bound of VPLs' geometry term, against a path-traced
// reference; and the maps' resolution, their level of detail, the receiver bias, and how few VPLs a pixel gathers with and without the filter, against exact rays to
// all of the same VPLs. "light" is all indirect light over the reference's, less one. `--images` gets a plot of each.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "tools/bench/maps_bench.hpp"
#include "tools/bench/path_reference.hpp"
#include "tools/metrics.hpp"
#include "tools/output_file.hpp"
#include "tools/plot.hpp"
#include "tools/render_image.hpp"
#include "tools/render_options.hpp"

namespace myriad::tools {
namespace {

using passes::FrameSettings;
using passes::Visibility;

// One parameter over its values.
struct Sweep {
    const char* parameter;  // as `render` calls it
    const char* unit;
    std::vector<float> values;
    std::function<void(FrameSettings&, float)> set;
};

class Experiment {
public:
    Experiment(engine::Device& device, const BenchOptions& options, const RowSink& sink)
        : device_(device), options_(options), sink_(sink), still_(options, "builtin:atrium") {
        exact_ = frame_settings(options, options.views.empty() ? 1024 : options.views[0]);
        exact_.visibility = Visibility::rays;
        exact_.bounces = options.bounces;
        exact_.subset = 0;
        exact_.filter = false;
        if (const auto folder = engine::default_cache_folder(); !folder.empty()) exact_.cache = &cache_.emplace(folder);
        std::printf("scene: %s, %zu triangles, %u VPLs\n", still_.source.c_str(), size_t(still_.triangles.count()), exact_.vpls);
    }

    void run() {
        const Image all = wanted("map-size") || wanted("epsilon") || wanted("bias") || wanted("gather") ? image_of(exact_) : Image{};
        FrameSettings maps = exact_;
        maps.visibility = Visibility::manylods;
        if (wanted("map-size")) sweep(maps, all, {"--map-size", "texels a side", {8, 16, 32, 64, 128}, [](FrameSettings& s, float v) { s.maps.map_size = uint32_t(v); }});
        if (wanted("epsilon")) sweep(maps, all, {"--epsilon", "texels", {0.5f, 1, 2, 4, 8}, [](FrameSettings& s, float v) { s.maps.epsilon = v; }});
        if (wanted("bias")) sweep(maps, all, {"--bias", "half diagonals of a texel", {0.125f, 0.25f, 0.5f, 1, 2, 4}, [](FrameSettings& s, float v) { s.bias = v; }});
        if (wanted("gather"))
            for (const bool filter : {true, false}) {
                FrameSettings gather = exact_;
                gather.filter = filter;
                sweep(gather, all, {filter ? "--gather subset" : "--gather subset, --filter off", "VPLs a pixel", {16, 64, 256}, [](FrameSettings& s, float v) { s.subset = uint32_t(v); }});
            }
        if (!wanted("vpl-bound")) return;
        const scenes::Triangles flat = scenes::flatten(still_.scene, scenes::Sharing::never);
        const Image traced = path_reference(options_, still_.name(), still_.scene, flat, still_.camera, exact_).image;
        image_of(exact_);
        const float usual = usual_bound_;
        sweep(exact_, traced, {"--vpl-bound", "of the usual one", {0.01f, 0.1f, 1, 10, 100, 1000}, [usual](FrameSettings& s, float v) { s.vpl_bound = v * usual; }});
        FrameSettings compensated = exact_;
        compensated.compensate = 4, compensated.filter = true;  // which all VPLs at every pixel leave nothing to do but this
        sweep(compensated, traced, {"--vpl-bound, --compensate 4", "of the usual one", {0.01f, 0.1f, 1, 10, 100}, [usual](FrameSettings& s, float v) { s.vpl_bound = v * usual; }});
    }

private:
    bool wanted(const char* parameter) const { return options_.parameters.empty() || std::ranges::find(options_.parameters, parameter) != options_.parameters.end(); }

    Image image_of(const FrameSettings& settings) {
        passes::Frame frame(device_, still_.scene, still_.triangles, settings);
        frame.render(still_.camera);
        usual_bound_ = frame.vpl_bound();
        ms_ = 0;
        for (const engine::PassTime& pass : frame.times()) ms_ += pass.gpu_ms;
        return read_image(device_, frame, {"indirect"});
    }

    void sweep(const FrameSettings& base, const Image& reference, const Sweep& s) {
        Plot plot{.title = std::string(s.parameter) + ": error of the image, " + still_.name(), .x_label = std::string(s.parameter) + ", " + s.unit, .y_label = "error",
                  .lines = {{"relMSE", "#0072B2", {}}, {"FLIP", "#D55E00", {}}, {"light lost or gained", "#009E73", {}}}, .logarithmic = true};
        for (const float value : s.values) {
            FrameSettings settings = base;
            s.set(settings, value);
            const Image image = image_of(settings);
            const Metrics m = measure(reference, image, 0.01);
            const double flip = mean_flip(reference, image);
            const double light = indirect_light(image) / indirect_light(reference) - 1;
            BenchRow row = maps_row("bias", still_.source, choice_name(visibilities(), settings.visibility).c_str(), settings);
            row.settings["parameter"] = s.parameter, row.settings["value"] = value;
            row.error = {{"relMSE", m.rel_mse}, {"FLIP", flip}, {"SSIM", m.ssim}, {"light", light}};
            row.ms.ms = {ms_};
            sink_(row);
            const double heights[] = {m.rel_mse, flip, std::abs(light)};
            for (size_t i = 0; i < 3; ++i)
                if (heights[i] > 0) plot.lines[i].points.push_back({value, heights[i]});
        }
        if (options_.images.empty()) return;
        std::string name;
        for (const char c : std::string(s.parameter))
            if (std::isalnum(uint8_t(c))) name += c;
            else if (!name.empty() && name.back() != '-') name += '-';
        write_text(options_.images + "/bias-" + name + ".svg", to_svg(plot));
    }

    engine::Device& device_;
    const BenchOptions& options_;
    const RowSink& sink_;
    std::optional<engine::Cache> cache_;
    StillScene still_;
    FrameSettings exact_;
    float usual_bound_ = 0;  // of the frame that was rendered last
    double ms_ = 0;          // on the device, of the same
};

}  // namespace

void bench_bias(engine::Device& device, const BenchOptions& options, const RowSink& sink) {
    require_folder(options.images);
    require_folder(options.references);
    Experiment(device, options, sink).run();
}

}  // namespace myriad::tools
