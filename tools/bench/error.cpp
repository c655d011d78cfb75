// `myriad bench error`: speed against total error. For each scene every technique is tried with many settings; each image is judged against a path-traced reference
// (tools/reference), and of each technique the best within every budget of time counts. Competitors in the same run: the same VPLs with exact rays, imperfect shadow
// maps, maps of all triangles, and the path tracer itself, stopped at each budget. The best within the middle budget is taken apart: what the VPLs, the maps, their level
// of detail, the gather and the filter cost, each by itself. `--report` writes it all as one HTML file.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "passes/tonemap/tonemap_io.h"
#include "tools/bench/maps_bench.hpp"
#include "tools/bench/path_reference.hpp"
#include "tools/exposure.hpp"
#include "tools/metrics.hpp"
#include "tools/output_file.hpp"
#include "tools/png.hpp"
#include "tools/progress.hpp"
#include "tools/render_image.hpp"
#include "tools/render_options.hpp"
#include "tools/report/report.hpp"
#include "tools/revision.hpp"

namespace myriad::tools {
namespace {

using passes::FrameSettings;
using passes::GatherMethod;
using passes::Visibility;

const char* const maps_group = "Myriad: maps";
const char* const tree_group = "Myriad: rays to VPLs that the light tree picks";
const char* const rays_group = "rays to subsets of VPLs";
const char* const ism_group = "imperfect shadow maps";
const char* const brute_group = "maps of all triangles";
const char* const path_group = "path tracer";

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// Settings that are tried with more and more VPLs until they take too long.
struct Candidate {
    const char* group;
    const char* technique;
    FrameSettings settings;
    std::vector<uint32_t> vpls;  // rising
};

// What makes the image again, beside the scene and the report's size and bounces.
std::string options_of(const FrameSettings& s) {
    const FrameSettings usual;
    std::string text = "--visibility " + choice_name(visibilities(), s.visibility) + " --vpls " + std::to_string(s.vpls) + " --gather " + show_gather(s);
    if (s.compensate != usual.compensate) text += " --compensate " + std::to_string(s.compensate);
    if (s.seed != usual.seed) text += " --seed " + std::to_string(s.seed);
    if (s.visibility == Visibility::rays) return text;
    text += " --map-size " + std::to_string(s.maps.map_size);
    if (s.log2_samples != usual.log2_samples && s.visibility != Visibility::brute) text += " --samples " + std::to_string(s.log2_samples);
    if (s.visibility != Visibility::manylods && s.visibility != Visibility::megaviews) return text;
    text += " --tree " + show_tree(s);
    if (s.maps.arity != usual.maps.arity) text += " --arity " + std::to_string(s.maps.arity);
    if (s.maps.epsilon != usual.maps.epsilon) text += " --epsilon " + show_number(s.maps.epsilon);
    return text;
}

std::vector<Candidate> candidates(const FrameSettings& base) {
    std::vector<Candidate> all;
    const auto add = [&](const char* group, const char* technique, Visibility visibility, uint32_t map_size, GatherMethod gather, uint32_t picks, uint32_t levels, std::vector<uint32_t> vpls,
                         uint32_t compensate = 0) {
        FrameSettings s = base;
        s.visibility = visibility, s.maps.map_size = map_size, s.gather = gather, s.subset = picks, s.octree_levels = levels, s.compensate = compensate;
        all.push_back({group, technique, s, std::move(vpls)});
    };
    for (const uint32_t compensate : {0u, 2u}) {
        for (const uint32_t map_size : {16u, 32u, 64u}) {
            add(maps_group, "manylods", Visibility::manylods, map_size, GatherMethod::subset, 256, 0, {256, 1024, 4096, 16384}, compensate);
            add(maps_group, "manylods", Visibility::manylods, map_size, GatherMethod::tree, 32, 0, {1024, 4096, 16384}, compensate);
        }
        for (const uint32_t map_size : {16u, 32u}) add(maps_group, "megaviews", Visibility::megaviews, map_size, GatherMethod::tree, 32, 9, {16384, 65536}, compensate);
        for (const uint32_t picks : {8u, 32u, 128u}) add(tree_group, "rays", Visibility::rays, 32, GatherMethod::tree, picks, 0, {1024, 4096, 16384, 65536}, compensate);
    }
    add(maps_group, "manylods", Visibility::manylods, 32, GatherMethod::subset, 64, 0, {256, 1024, 4096});
    for (const uint32_t subset : {64u, 256u}) add(rays_group, "rays", Visibility::rays, 32, GatherMethod::subset, subset, 0, {256, 1024, 4096, 16384});
    add(ism_group, "ism", Visibility::ism, 32, GatherMethod::subset, 256, 0, {256, 1024, 4096});
    add(brute_group, "brute", Visibility::brute, 32, GatherMethod::subset, 256, 0, {64, 256, 1024});
    return all;
}

std::map<std::string, double> errors_of(const Image& reference, const Image& test) {
    const Metrics m = measure(reference, test, 0.01);
    return {{"relMSE", m.rel_mse}, {"FLIP", mean_flip(reference, test)}, {"SSIM", m.ssim}};
}

Picture toned(const Image& image, float exposure) {
    const Image::Rgb light = *image.rgb();
    std::vector<uint32_t> pixels;
    for (size_t i = 0; i < image.pixels(); ++i) pixels.push_back(tonemap(vec3(light.r[i], light.g[i], light.b[i]), exposure));
    return to_picture(pixels, image.width, image.height);
}

class SceneErrors {
public:
    SceneErrors(engine::Device& device, const BenchOptions& options, const RowSink& sink)
        : device_(device), options_(options), sink_(sink), still_(options, "builtin:cornell"), base_(frame_settings(options, 0)) {
        base_.width = options.width, base_.height = options.height;
        base_.bounces = options.bounces;
        if (const auto folder = engine::default_cache_folder(); !folder.empty()) base_.cache = &cache_.emplace(folder);
        out_.name = still_.name(), out_.camera = options.camera;
        out_.triangles = still_.triangles.count(), out_.width = base_.width, out_.height = base_.height, out_.bounces = base_.bounces;
        out_.budgets = options.budgets;
        std::ranges::sort(out_.budgets);
        std::printf("scene: %s, %llu triangles, %ux%u, bounces %u\n", still_.source.c_str(), static_cast<unsigned long long>(out_.triangles), base_.width, base_.height, base_.bounces);
    }

    ReportScene run() {
        flat_ = scenes::flatten(still_.scene, scenes::Sharing::never);
        const PathReference made = path_reference(options_, out_.name, still_.scene, flat_, still_.camera, base_);
        reference_ = made.image, out_.reference_samples = made.samples, out_.reference_noise = made.noise;
        progress_.show("tracing paths", 0);
        trace();
        std::vector<Candidate> all = candidates(base_);
        if (!options_.techniques.empty()) std::erase_if(all, [&](const Candidate& c) { return std::ranges::find(options_.techniques, c.technique) == options_.techniques.end(); });
        for (size_t i = 0; i < all.size(); ++i) {
            progress_.show("trying " + out_.name, double(i) / double(all.size()));
            sweep(all[i]);
        }
        time_the_best();
        progress_.clear();
        for (const Trial& trial : out_.trials) emit(trial);
        take_apart();
        show();
        return std::move(out_);
    }

private:
    double longest() const { return out_.budgets.back(); }
    double middle() const { return out_.budgets[out_.budgets.size() / 2]; }

    // The path tracer, looked at whenever a budget is about to be spent. What looking takes does not count.
    void trace() {
        reference::Film film(base_.width, base_.height);
        reference::Settings settings = path_settings(base_, options_.seed);
        double looking = 0, before = 0;
        size_t next = 0;
        settings.after_pass = [&](const reference::Film& f, double seconds) {
            const double spent = seconds - looking, pass = spent - before;
            before = spent;
            if (next < out_.budgets.size() && spent + pass > out_.budgets[next]) {
                const double from = now();
                add_path_trial(f, spent);
                while (next < out_.budgets.size() && spent + pass > out_.budgets[next]) ++next;
                looking += now() - from;
            }
            return next < out_.budgets.size();
        };
        reference::Reference(still_.scene, still_.scene.lights, flat_, still_.camera, settings).add_to(film);
    }

    void add_path_trial(const reference::Film& film, double spent) {
        Trial trial{path_group, "path-tracer", "--spp " + std::to_string(film.samples()), {spent}, {}};
        const Image image = film.image(false);
        trial.error = errors_of(reference_, image);
        images_.push_back(image);
        out_.trials.push_back(std::move(trial));
        settings_.emplace_back();
    }

    void sweep(const Candidate& candidate) {
        for (const uint32_t vpls : candidate.vpls) {
            FrameSettings settings = candidate.settings;
            settings.vpls = vpls;
            passes::Frame frame(device_, still_.scene, still_.triangles, settings);
            double from = now();
            frame.render(still_.camera);  // warms up
            if (now() - from > 2 * longest()) return;
            from = now();
            frame.render(still_.camera);
            const double seconds = now() - from;
            if (seconds > longest()) return;  // with more VPLs it takes longer
            Trial trial{candidate.group, candidate.technique, options_of(settings), {seconds}, {}};
            Image image = read_image(device_, frame, {});
            trial.error = errors_of(reference_, image);
            images_.push_back(std::move(image));
            out_.trials.push_back(std::move(trial));
            settings_.push_back(settings);
        }
    }

    // Medians, of those that are best within some budget.
    void time_the_best() {
        std::vector<size_t> best;
        for (const char* group : {maps_group, tree_group, rays_group, ism_group, brute_group})
            for (const char* metric : {"relMSE", "FLIP"})
                for (const double budget : out_.budgets)
                    if (const auto i = best_within(out_.trials, group, metric, budget)) best.push_back(*i);
        std::ranges::sort(best);
        best.erase(std::unique(best.begin(), best.end()), best.end());
        for (const size_t i : best) {
            progress_.show("timing the best of " + out_.name, 0);
            passes::Frame frame(device_, still_.scene, still_.triangles, *settings_[i]);
            frame.render(still_.camera);
            std::vector<double> runs;
            for (uint32_t r = 0; r < options_.repeats; ++r) {
                const double from = now();
                frame.render(still_.camera);
                runs.push_back(now() - from);
            }
            out_.trials[i].runs = runs;
        }
    }

    Image image_of(FrameSettings settings) {
        passes::Frame frame(device_, still_.scene, still_.triangles, settings);
        frame.render(still_.camera);
        return read_image(device_, frame, {});
    }

    // What each shortcut costs, with all else exact. All VPLs are gathered where the gather is not what is looked at, so there should not be too many.
    void take_apart() {
        const auto best = best_within(out_.trials, maps_group, "FLIP", middle());
        if (!best) return;
        FrameSettings chosen = *settings_[*best];
        chosen.vpls = std::min(chosen.vpls, 1024u), chosen.compensate = 0;
        out_.parts_of = options_of(chosen);
        FrameSettings exact = chosen;
        exact.visibility = Visibility::rays, exact.octree_levels = 0, exact.gather = GatherMethod::subset, exact.subset = 0, exact.filter = false;
        const Image all = image_of(exact);
        const auto part = [&](const char* what, const char* against, const Image& reference, const Image& test) { out_.parts.push_back({what, against, errors_of(reference, test)}); };
        const Image made = image_of(chosen);
        part("everything", "path-traced reference", reference_, made);
        part("VPLs: few, bounded, diffuse", "path-traced reference", reference_, all);
        FrameSettings compensated = exact;
        compensated.compensate = 32;
        part("VPLs: few, diffuse (bound compensated)", "path-traced reference", reference_, image_of(compensated));
        part("maps, gather and filter", "exact rays to all of the same VPLs", all, made);
        FrameSettings maps = exact;
        maps.visibility = chosen.visibility, maps.octree_levels = chosen.octree_levels;
        const Image drawn = image_of(maps);
        part("maps: resolution and level of detail", "exact rays to all of the same VPLs", all, drawn);
        FrameSettings brute = exact;
        brute.visibility = Visibility::brute;
        const Image triangles = image_of(brute);
        part("resolution of maps alone", "exact rays to all of the same VPLs", all, triangles);
        part("level of detail alone", "maps of all triangles", triangles, drawn);
        FrameSettings gather = exact;
        gather.gather = chosen.gather, gather.subset = chosen.subset;
        part("gather: some VPLs for each pixel, no filter", "exact rays to all of the same VPLs", all, image_of(gather));
        gather.filter = true;
        part("gather and filter", "exact rays to all of the same VPLs", all, image_of(gather));
        std::printf("the error of %s, taken apart:\n", out_.parts_of.c_str());
        for (const ErrorPart& p : out_.parts) std::printf("  %-45s against %-40s relMSE %.4g  FLIP %.4g\n", p.what.c_str(), p.against.c_str(), p.error.at("relMSE"), p.error.at("FLIP"));
    }

    void show() {
        const double exposure = auto_exposure(*reference_.rgb());
        const auto picture = [&](const Image& image) { return toned(image, float(exposure)); };
        out_.pictures.push_back({{"reference", picture(reference_)}});
        for (const char* group : {maps_group, tree_group, rays_group, ism_group, path_group})
            if (const auto i = best_within(out_.trials, group, "FLIP", middle())) {
                const Trial& t = out_.trials[*i];
                char title[160];
                std::snprintf(title, sizeof title, "%s, %.2g s: FLIP %.3f, relMSE %.3g", group, t.seconds(), t.error.at("FLIP"), t.error.at("relMSE"));
                const std::vector<float> flip = flip_errors(Flip::ldr, reference_, images_[*i]);
                out_.pictures.push_back({{title, picture(images_[*i])}, {std::string("FLIP of ") + group, heat_map(flip, reference_.width, reference_.height, 1)}});
            }
    }

    void emit(const Trial& t) const {
        BenchRow row;
        row.bench = "error", row.scene = out_.name, row.technique = t.technique;
        row.settings = {{"options", t.options}, {"width", base_.width}, {"height", base_.height}, {"bounces", base_.bounces}};
        for (const double seconds : t.runs) row.ms.ms.push_back(1e3 * seconds);
        row.error = t.error;
        sink_(row);
    }

    engine::Device& device_;
    const BenchOptions& options_;
    const RowSink& sink_;
    Progress progress_{false};
    std::optional<engine::Cache> cache_;  // trees are built once a scene
    StillScene still_;
    scenes::Triangles flat_;
    FrameSettings base_;
    Image reference_;
    std::vector<Image> images_;                          // by trial
    std::vector<std::optional<FrameSettings>> settings_; // by trial; none: the path tracer's
    ReportScene out_;
};

std::string cpu_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "unknown CPU";
}

}  // namespace

void bench_error(engine::Device& device, const BenchOptions& options, const RowSink& sink) {
    for (const std::string& path : {options.report, options.csv})
        if (!path.empty()) require_writable(path);
    require_folder(options.references);
    Report report;
    const std::vector<std::string> scenes = options.scenes.empty() ? std::vector<std::string>{options.scene.empty() ? "builtin:cornell" : options.scene} : options.scenes;
    const auto list = [](const auto& values, const auto& show) {
        std::string text;
        for (const auto& value : values) text += (text.empty() ? " " : ",") + show(value);
        return text;
    };
    report.command = "myriad bench error --scenes" + list(scenes, [](const std::string& scene) { return scene; }) + " --budgets" + list(options.budgets, [](double s) { return show_number(float(s)); }) +
                     " --repeat " + std::to_string(options.repeats) + " --reference-seconds " + show_number(float(options.reference_seconds));
    report.device = device.info().name, report.driver = device.info().driver_version, report.cpu = cpu_name(), report.revision = git_revision;
    report.groups = {maps_group, tree_group, path_group, rays_group, ism_group, brute_group};
    report.metrics = {"relMSE", "FLIP"};
    for (const std::string& scene : scenes) {
        BenchOptions of_scene = options;
        of_scene.scene = scene;
        report.scenes.push_back(SceneErrors(device, of_scene, sink).run());
        // After each scene: what takes long may be interrupted.
        if (!options.report.empty()) write_text(options.report, to_html(report));
        if (!options.csv.empty()) write_text(options.csv, to_csv(report));
    }
}

}  // namespace myriad::tools
