#include "tools/stats.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>

#include "tools/arguments.hpp"
#include "tools/render_options.hpp"
#include "tools/revision.hpp"

namespace myriad::tools {
namespace {

using nlohmann::ordered_json;

// Of the process, up to now; on a CPU device the device's memory is in it.
uint64_t peak_host_bytes() {
    rusage usage;
    return getrusage(RUSAGE_SELF, &usage) == 0 ? uint64_t(usage.ru_maxrss) * 1024 : 0;
}

double rounded(double ms) { return std::round(ms * 1e4) / 1e4; }  // finer is noise

ordered_json scene_json(const RunRecord& run) {
    ordered_json scene = {{"name", run.scene}, {"camera", run.camera}, {"triangles", run.size.triangles}, {"lights", run.size.lights},
                          {"glossy", run.size.glossy}, {"bvh_nodes", run.size.bvh_nodes}};
    if (run.size.instances) scene["instances"] = run.size.instances, scene["stored_triangles"] = run.size.stored_triangles;
    if (run.size.samples) scene["samples"] = run.size.samples;
    if (run.size.bsh_blocks) scene["bsh_blocks"] = run.size.bsh_blocks;
    if (const compute::SvoSize& o = run.size.octree; o.nodes)
        scene["octree"] = {{"nodes", o.nodes}, {"leaves", o.leaves}, {"pairs_of_cell_and_triangle", o.pairs}, {"bytes", o.bytes()}};
    return scene;
}

std::string format(const char* pattern, ...) __attribute__((format(printf, 1, 2)));
std::string format(const char* pattern, ...) {
    char text[512];
    va_list arguments;
    va_start(arguments, pattern);
    std::vsnprintf(text, sizeof text, pattern, arguments);
    va_end(arguments);
    return text;
}

double mebibytes(uint64_t bytes) { return double(bytes) / (1 << 20); }

std::string counters_text(const FrameRun& frame) {
    std::string text;
    if (frame.counters.vpls) text += format("%llu VPLs alive", static_cast<unsigned long long>(*frame.counters.vpls));
    if (frame.counters.point_lights) text += format(", %llu point lights gathered", static_cast<unsigned long long>(*frame.counters.point_lights));
    if (frame.counters.prepared) text += ", light paths prepared anew";
    const auto& maps = frame.counters.maps;
    if (maps && maps->triangle_views) text += format(", %llu triangles drawn in views, %u batches", static_cast<unsigned long long>(maps->triangle_views), maps->batches);
    if (maps && maps->pairs)
        text += format(", %llu pairs tested, %llu culled, %llu rendered for %.1f views each, %llu shared maps, %u batches, %u redone",
                       static_cast<unsigned long long>(maps->pairs), static_cast<unsigned long long>(maps->pairs_culled),
                       static_cast<unsigned long long>(maps->pairs_rendered), maps->pairs_rendered ? double(maps->views_of_rendered) / double(maps->pairs_rendered) : 0.0,
                       static_cast<unsigned long long>(maps->shared_maps), maps->batches, maps->redone);
    else if (maps && maps->list_capacity)
        text += format(", %llu node-views tested, %llu in the cuts, lists %llu of %llu, %u batches, %u redone",
                       static_cast<unsigned long long>(maps->node_views), static_cast<unsigned long long>(maps->cut),
                       static_cast<unsigned long long>(maps->list_peak), static_cast<unsigned long long>(maps->list_capacity), maps->batches,
                       maps->redone);
    if (const auto& points = frame.counters.points)
        text += format(", of the camera %llu node-views tested, %llu in its cut, %llu points drawn", static_cast<unsigned long long>(points->node_views),
                       static_cast<unsigned long long>(points->cut), static_cast<unsigned long long>(points->drawn));
    if (text.starts_with(", ")) text.erase(0, 2);
    return text.empty() ? text : text + "\n";
}

}  // namespace

ordered_json counters_json(const FrameRun& frame) {
    ordered_json counters = ordered_json::object();
    if (frame.counters.vpls) counters["vpls"] = *frame.counters.vpls;
    if (frame.counters.point_lights) counters["point_lights"] = *frame.counters.point_lights;
    if (frame.counters.prepared) counters["light_paths_prepared"] = *frame.counters.prepared;
    if (frame.counters.tree_growth) counters["tree_growth"] = *frame.counters.tree_growth;
    if (frame.counters.tree_overlap) counters["tree_overlap"] = *frame.counters.tree_overlap;
    if (frame.counters.tree_rebuilds) counters["tree_rebuilds"] = *frame.counters.tree_rebuilds;
    if (const auto& maps = frame.counters.maps) {
        if (maps->list_capacity) {
            if (!maps->pairs) counters["node_views"] = maps->node_views, counters["cut"] = maps->cut;
            if (maps->invalid) counters["cut_invalid"] = maps->invalid;
            if (maps->maps_drawn) counters["maps_drawn"] = *maps->maps_drawn;
            counters["cut_groups"] = maps->groups;
            counters["list_capacity"] = maps->list_capacity;
            counters["list_peak"] = maps->list_peak;
        }
        if (maps->pairs) {
            counters["pairs"] = maps->pairs, counters["pairs_culled"] = maps->pairs_culled, counters["pairs_edge_on"] = maps->pairs_edge_on, counters["pairs_rendered"] = maps->pairs_rendered;
            counters["views_per_rendered_pair"] = maps->pairs_rendered ? double(maps->views_of_rendered) / double(maps->pairs_rendered) : 0.0;
            counters["shared_maps"] = maps->shared_maps;
            for (const auto& step : maps->pair_steps)
                counters["pairs_by_step"].push_back({{"tested", step.tested}, {"culled", step.culled}, {"edge_on", step.edge_on}, {"rendered", step.rendered}});
        }
        if (maps->triangle_views) counters["triangle_views"] = maps->triangle_views;
        counters["batches"] = maps->batches;
        counters["redone"] = maps->redone;
    }
    if (const auto& points = frame.counters.points)
        counters["points"] = {{"node_views", points->node_views}, {"cut", points->cut}, {"cut_groups", points->groups}, {"drawn", points->drawn},
                              {"list_capacity", points->list_capacity}, {"list_peak", points->list_peak}, {"redone", points->redone}};
    counters["peak_bytes"] = frame.peak_bytes;
    return counters;
}

double shortest(float value) { return std::strtod(show_number(value).c_str(), nullptr); }

std::vector<PassSum> sum_passes(const std::vector<engine::PassTime>& passes) {
    std::vector<PassSum> sums;
    for (const engine::PassTime& pass : passes) {
        auto sum = std::ranges::find(sums, pass.name, &PassSum::name);
        if (sum == sums.end()) sum = sums.insert(sum, {pass.name});
        sum->gpu_ms += pass.gpu_ms;
        sum->cpu_ms += pass.cpu_ms;
    }
    return sums;
}

double median(std::vector<double> values) {
    std::ranges::sort(values);
    const size_t middle = values.size() / 2;
    return values.size() % 2 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

std::vector<PassSum> median_passes(const std::vector<FrameRun>& frames) {
    struct All {
        std::string name;
        std::vector<double> gpu, cpu;
    };
    std::vector<All> all;
    for (const FrameRun& frame : frames)
        for (const PassSum& sum : sum_passes(frame.passes)) {
            auto entry = std::ranges::find(all, sum.name, &All::name);
            if (entry == all.end()) entry = all.insert(entry, {sum.name, {}, {}});
            entry->gpu.push_back(sum.gpu_ms);
            entry->cpu.push_back(sum.cpu_ms);
        }
    std::vector<PassSum> medians;
    for (const All& entry : all) medians.push_back({entry.name, median(entry.gpu), median(entry.cpu)});
    return medians;
}

ordered_json settings_json(const passes::FrameSettings& s, float vpl_bound, bool other_lights) {
    ordered_json json = {{"width", s.width}, {"height", s.height}, {"seed", s.seed}, {"brdf", choice_name(brdfs(), s.brdf)}, {"vpls", s.vpls}};
    if (s.primary == passes::Primary::points) {
        json["primary"] = choice_name(primaries(), s.primary), json["primary_pixels"] = shortest(s.primary_pixels);
        json["append"] = choice_name(append_modes(), s.maps.append), json["log2_samples"] = s.log2_samples;
    }
    if (s.point_lights != passes::PointLighting::automatic) json["point_lights"] = choice_name(point_lightings(), s.point_lights);
    if (s.vpls == 0 && !other_lights) return json;
    if (s.vpls > 0) json["bounces"] = s.bounces;
    json["visibility"] = choice_name(visibilities(), s.visibility);
    json["gather"] = show_gather(s);
    if (std::isfinite(s.gather_distance)) json["gather_distance"] = shortest(s.gather_distance);
    json["filter"] = s.filter;
    if (s.vpls > 0) json["vpl_bound"] = shortest(vpl_bound);
    if (s.vpls > 0 && s.compensate > 0) json["compensate"] = s.compensate;
    if (s.visibility == passes::Visibility::rays || s.visibility == passes::Visibility::none) return json;
    json["map_size"] = s.maps.map_size;
    json["bias"] = shortest(s.bias);
    if (s.visibility == passes::Visibility::ism) json["ism_points"] = s.maps.ism.points, json["log2_samples"] = s.log2_samples;
    if (s.visibility != passes::Visibility::manylods && s.visibility != passes::Visibility::megaviews) return json;
    json["append"] = choice_name(append_modes(), s.maps.append);
    if (s.visibility == passes::Visibility::manylods) json["update"] = show_update(s.maps);
    if (s.visibility == passes::Visibility::megaviews) json["fusion"] = choice_name(fusions(), s.maps.asks);
    json["epsilon"] = shortest(s.maps.epsilon);
    if (s.maps.coverage != coverage_exact) json["coverage"] = choice_name(coverages(), s.maps.coverage);
    json["tree"] = show_tree(s);
    if (s.octree_levels) return json;
    json["log2_samples"] = s.log2_samples;
    json["arity"] = s.maps.arity;
    if (std::isfinite(s.rebuild)) json["rebuild"] = shortest(s.rebuild);
    return json;
}

std::string stats_json(const RunRecord& run) {
    ordered_json json = {{"program", {{"version", version}, {"git_revision", git_revision}}},
                         {"device", {{"name", run.device.name}, {"driver", run.device.driver + " " + run.device.driver_version}}},
                         {"scene", scene_json(run)},
                         {"settings", run.settings}};
    for (const HostPhase& phase : run.phases) json["host_ms"][phase.name] = rounded(phase.ms);
    for (const passes::BuildStep& step : run.build) json["build_ms"][step.name] = rounded(step.ms);
    if (run.cache) json["cache"] = {{"found", run.cache->found}, {"missing", run.cache->missing}, {"damaged", run.cache->damaged}};
    json["peak_host_bytes"] = peak_host_bytes();
    json["frames"] = ordered_json::array();
    for (const FrameRun& frame : run.frames) {
        ordered_json passes = ordered_json::array();
        for (const PassSum& sum : sum_passes(frame.passes))
            passes.push_back({{"name", sum.name}, {"gpu_ms", rounded(sum.gpu_ms)}, {"cpu_ms", rounded(sum.cpu_ms)}});
        ordered_json row = ordered_json::object();
        if (frame.number) row["frame"] = *frame.number;
        if (frame.seconds) row["seconds"] = *frame.seconds;
        row["ms"] = rounded(frame.host.ms), row["passes"] = passes, row["counters"] = counters_json(frame);
        json["frames"].push_back(std::move(row));
    }
    if (run.exposure) json["exposure"] = *run.exposure;
    return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::string stats_table(const RunRecord& run) {
    std::string text = format("%s, camera %s, %llu triangles, on %s\n", run.scene.c_str(), run.camera.c_str(),
                              static_cast<unsigned long long>(run.size.triangles), run.device.name.c_str());
    if (run.size.instances)
        text.insert(text.find(" triangles") + 10, format(" (%llu stored; %llu instances share them)",
                                                         static_cast<unsigned long long>(run.size.stored_triangles),
                                                         static_cast<unsigned long long>(run.size.instances)));
    const bool many = run.frames.size() > 1;
    text += format("%-12s %10s %10s%s\n", "pass", "gpu ms", "cpu ms",
                   many ? format("   (medians of %zu frames)", run.frames.size()).c_str() : "");
    const auto row = [&](const PassSum& pass) {
        text += format("%-12s %10.2f %10.2f\n", pass.name.c_str(), pass.gpu_ms, pass.cpu_ms);
    };
    for (const PassSum& pass : median_passes(run.frames)) row(pass);
    // Not the sum of the rows: the first frame has passes that the others lack.
    std::vector<FrameRun> totals = run.frames;
    for (FrameRun& frame : totals)
        for (engine::PassTime& pass : frame.passes) pass.name = "total";
    for (const PassSum& total : median_passes(totals)) row(total);
    std::vector<double> walls;
    for (const FrameRun& frame : run.frames) walls.push_back(frame.host.ms);
    if (!walls.empty()) text += format("frame %.0f ms", median(walls));
    for (const HostPhase& phase : run.phases)
        if (!phase.name.starts_with("frame ")) text += format(", %s %.0f ms", phase.name.c_str(), phase.ms);
    text += "\n";
    if (run.frames.empty()) return text;
    text += counters_text(run.frames.back());
    text += "peak MiB:";
    for (const auto& [kind, bytes] : run.frames.back().peak_bytes) text += format(" %s %.1f", kind.c_str(), mebibytes(bytes));
    text += "\n";
    if (run.exposure) text += format("exposure %.6g\n", *run.exposure);
    constexpr size_t most = 8;  // of a film the first and the last
    for (size_t i = 0; i < run.files.size(); ++i) {
        if (run.files.size() > most && i == most / 2) text += format("… and %zu more, up to\n", run.files.size() - most), i = run.files.size() - most / 2;
        text += "wrote " + run.files[i] + "\n";
    }
    return text;
}

}  // namespace myriad::tools
