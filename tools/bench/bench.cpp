#include "tools/bench/bench.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "tools/arguments.hpp"
#include "tools/commands.hpp"
#include "tools/output_file.hpp"

namespace myriad::tools {

double Samples::median() const {
    if (ms.empty()) return 0;
    std::vector<double> sorted = ms;
    std::sort(sorted.begin(), sorted.end());
    const size_t middle = sorted.size() / 2;
    return sorted.size() % 2 ? sorted[middle] : 0.5 * (sorted[middle - 1] + sorted[middle]);
}

nlohmann::json Samples::json() const {
    const auto [lo, hi] = std::minmax_element(ms.begin(), ms.end());
    return {{"median", median()}, {"min", *lo}, {"max", *hi}, {"n", ms.size()}};
}

nlohmann::json BenchRow::json(const engine::DeviceInfo& device) const {
    nlohmann::json stage_medians = nlohmann::json::object();
    for (const auto& [name, samples] : stages) stage_medians[name] = samples.median();
    return {{"bench", bench},       {"scene", scene},       {"technique", technique}, {"views", views},
            {"settings", settings}, {"ms", ms.json()},      {"stages", stage_medians}, {"counters", counters},
            {"bytes", bytes},       {"error", error},       {"extrapolated", extrapolated},
            {"device", {{"name", device.name}, {"driver", device.driver_version}}}};
}

const std::vector<Bench>& benches() {
    static const std::vector<Bench> all = {
        {"manylods", "cut and splat of many VPL views: the device's lists and walks against native ones", bench_manylods, {"--arity"}},
        {"manylods-table1", "maps of a moving light's VPLs: brute, ISM, basic, incremental and lazy cuts, with their errors", bench_table1, {"--arity"}},
        {"manylods-table2", "the tree's build and update, and one view of the scene: rays, and points at c = 1, 2 and 4 pixels", bench_table2},
        {"manylods-fig8", "cuts over a clip, frame by frame: basic, incremental and lazy", bench_fig8,
         {"--animation", "--frames", "--csv", "--plot", "--arity"}},
        {"manylods-ism", "imperfect shadow maps with the points a map that take ManyLoDs' time, diffuse and glossy", bench_equal_time, {"--images", "--arity"}},
        {"manylods-arity", "trees of arity 2, 4 and 8: what they take, to refit and to be cut, from the roots and from the frame before", bench_arity},
        {"megaviews-views", "maps of up to a million views: drawn for many at once, against ManyLoDs and all triangles", bench_megaviews,
         {"--csv", "--plot", "--arity", "--distributions", "--measured", "--levels"}, 16, 2.0f},
        {"megaviews-resolution", "maps of 16 to 256 texels a side, and octrees of 8 to 11 levels: what they take, and the image's error", bench_resolution,
         {"--arity", "--map-sizes", "--levels", "--images"}, 16, 2.0f},
        {"coverage", "what nodes smaller than a texel cover: their middles, whole texels, or a share by dice; how much light each way of drawing loses", bench_coverage,
         {"--arity", "--levels", "--images"}, 16},
        {"bias", "what each approximation costs in error, all else exact: the VPLs' bound, maps' resolution and level of detail, receiver bias, few VPLs a pixel", bench_bias,
         {"--parameters", "--references", "--reference-seconds", "--images", "--arity", "--bounces"}, {}, 2.0f},
        {"error", "seconds a frame against the error of the image, of every technique at its best, beside a path tracer", bench_error,
         {"--scenes", "--techniques", "--budgets", "--references", "--reference-seconds", "--report", "--size", "--csv", "--bounces", "--arity"}, {}, 2.0f},
        {"gather", "what pixels gather of many VPLs: all, subsets, some that are not culled, and what a light tree picks, with their errors", bench_gather,
         {"--arity", "--bounces", "--picks"}},
        {"sort", "radix sorts of keys with payload: the device's, in several shapes, against the host's", bench_sort, {"--items"}},
        {"octree", "sparse octrees over points of a scene's surface, built on the device and on the host, and over its triangles", bench_octree, {"--depth", "--levels"}},
        {"stability", "a scene scaled, far from the origin, and on a floor that is much larger: where images suffer", bench_stability, {"--arity"}},
    };
    return all;
}

namespace {

struct Arguments {
    std::string name, json, device;
    uint64_t memory_mib = 0;
    BenchOptions options;
};

void print_row(const BenchRow& row) {
    std::printf("%-20s %7llu views  %s%9.1f ms [%.1f … %.1f]", row.technique.c_str(), static_cast<unsigned long long>(row.views),
                row.extrapolated ? "extrapolated " : "", row.ms.median(), *std::min_element(row.ms.ms.begin(), row.ms.ms.end()), *std::max_element(row.ms.ms.begin(), row.ms.ms.end()));
    for (const auto& [name, value] : row.settings.items()) std::printf("  %s=%s", name.c_str(), (value.is_string() ? value.get<std::string>() : value.dump()).c_str());
    for (const auto& [name, samples] : row.stages) std::printf("  %s %.1f", name.c_str(), samples.median());
    for (const auto& [name, value] : row.counters) std::printf("  %s %.6g", name.c_str(), value);
    for (const auto& [name, value] : row.error) std::printf("  %s %.4g", name.c_str(), value);
    std::printf("\n");
    std::fflush(stdout);
}

// An option that changes nothing is refused.
void refuse_foreign(const CLI::App& command, const Bench& chosen) {
    for (const Bench& bench : benches())
        for (const std::string& option : bench.own)
            if (command.count(option) && std::ranges::find(chosen.own, option) == chosen.own.end())
                throw InputError(option + " is an option of bench " + bench.name + ", which " + chosen.name + " does not have; leave it out");
}

void run(const Arguments& arguments, const CLI::App& command) {
    if (arguments.name == "list") {
        for (const Bench& bench : benches()) std::printf("%-12s %s\n", bench.name, bench.what);
        return;
    }
    const auto bench = std::find_if(benches().begin(), benches().end(), [&](auto& b) { return arguments.name == b.name; });
    if (bench == benches().end()) throw InputError("no experiment is called \"" + arguments.name + "\"; see myriad bench list");
    refuse_foreign(command, *bench);
    if (!arguments.json.empty()) require_writable(arguments.json);
    engine::Device device({.select = arguments.device, .validation = false, .memory_limit = arguments.memory_mib << 20});
    std::printf("device: %s, %s\n", device.info().name.c_str(), device.info().driver_version.c_str());
    std::string lines;
    BenchOptions options = arguments.options;
    if (bench->map_size && !command.count("--map-size")) options.map_size = *bench->map_size;
    if (bench->epsilon && !command.count("--epsilon")) options.epsilon = *bench->epsilon;
    bench->run(device, options, [&](const BenchRow& row) {
        print_row(row);
        lines += row.json(device.info()).dump() + "\n";
    });
    if (!arguments.json.empty()) write_text(arguments.json, lines);
}

}  // namespace

void add_bench(CLI::App& app) {
    auto arguments = std::make_shared<Arguments>();
    CLI::App* bench = app.add_subcommand("bench", "timed experiments; `myriad bench list` names them");
    BenchOptions& o = arguments->options;
    bench->add_option("NAME", arguments->name, "an experiment, or `list`")->required();
    bench->add_option("--json", arguments->json, "write the rows as JSON Lines");
    bench->add_option("--scene", o.scene, "another scene than the experiment's own");
    bench->add_option("--camera", o.camera, "of the scene, by name or index, where an experiment makes images (the first)");
    bench->add_option("--views", o.views, "numbers of views, separated by commas")->delimiter(',')->check(CLI::Range(1u, 1u << 20));
    bench->add_option("--samples", o.log2_samples, "log2 of the number of surface samples (20)")->check(CLI::Range(0u, 26u));
    bench->add_option("--arity", o.arity, "children of a node of the tree: 2, 4 or 8 (8)")->check(CLI::IsMember({2u, 4u, 8u}));
    bench->add_option("--map-size", o.map_size, "texels a side of a half map (32; coverage, megaviews-views and -resolution: 16)")->check(CLI::Range(2u, 1024u));
    bench->add_option("--epsilon", o.epsilon, "criterion, texels (1; bias, error, megaviews-views and -resolution: 2)")->check(CLI::Range(0.01f, 1000.0f));
    bench->add_option("--repeat", o.repeats, "measured runs of each row, after a warm-up (5)")->check(CLI::Range(1u, 1000u));
    bench->add_option("--memory-limit", arguments->memory_mib, "MiB of device memory (all)")->check(CLI::Range(1u, 1u << 24));
    bench->add_option("--seed", o.seed, "seed (1)");
    bench->add_option("--animation", o.animation, "manylods-fig8: the clip that plays, by name or index (the first)");
    bench->add_option("--frames", o.frames, "manylods-fig8: of the clip, 1/24 s each (48)")->check(CLI::Range(1u, 100000u));
    bench->add_option("--items", o.items, "sort: numbers of keys, separated by commas (65536,1048576,4194304)")->delimiter(',')->check(CLI::Range(1u, 1u << 26));
    bench->add_option("--scenes", o.scenes, "error: scenes, separated by commas (--scene)")->delimiter(',');
    bench->add_option("--techniques", o.techniques, "error: those that are tried beside the path tracer, separated by commas: manylods, megaviews, rays, ism, brute (all)")
        ->delimiter(',')
        ->check(CLI::IsMember({"manylods", "megaviews", "rays", "ism", "brute"}));
    bench->add_option("--parameters", o.parameters, "bias: which are looked at, separated by commas: map-size, epsilon, bias, gather, vpl-bound (all)")
        ->delimiter(',')
        ->check(CLI::IsMember({"map-size", "epsilon", "bias", "gather", "vpl-bound"}));
    bench->add_option("--budgets", o.budgets, "error: seconds a frame, separated by commas (0.5,1,2,5,10)")->delimiter(',')->check(CLI::Range(0.01, 1e4));
    bench->add_option("--references", o.references, "bias, error: a folder where path-traced references are kept between runs");
    bench->add_option("--reference-seconds", o.reference_seconds, "bias, error: that a path-traced reference takes (120)")->check(CLI::Range(0.1, 1e6));
    bench->add_option("--report", o.report, "error: write an HTML file with plots, tables and pictures");
    add_parsed(*bench, "--size", "WxH", "640x360", "error: pixels", [&o](const std::string& text) { std::tie(o.width, o.height) = parse_size("--size", text); });
    bench->add_option("--bounces", o.bounces, "bias, error, gather: reflections of light before what is seen (1)")->check(CLI::Range(0u, 64u));
    bench->add_option("--picks", o.picks, "gather: VPLs that a pixel gathers, separated by commas (4,16,64,256,1024)")->delimiter(',')->check(CLI::Range(1u, 4096u));
    bench->add_option("--depth", o.depth, "octree: levels below the root (10)")->check(CLI::Range(0u, 21u));
    bench->add_option("--csv", o.csv, "manylods-fig8: write a line for each frame; megaviews-views: for each row");
    bench->add_option("--distributions", o.distributions, "megaviews-views: of views, separated by commas: 1-bounce, 4-bounce, random (all)")
        ->delimiter(',')
        ->check(CLI::IsMember({"1-bounce", "4-bounce", "random"}));
    bench->add_option("--measured", o.measured, "megaviews-views: the most views that ManyLoDs draws; more are extrapolated (65536)")->check(CLI::Range(1u, 1u << 20));
    bench->add_option("--plot", o.plot, "manylods-fig8: draw the cuts' times over the frames, as SVG; megaviews-views: the maps' over views");
    bench->add_option("--map-sizes", o.map_sizes, "megaviews-resolution: texels a side, separated by commas (16,32,64,128,256)")->delimiter(',')->check(CLI::Range(2u, 1024u));
    bench->add_option("--levels", o.levels, "of the scene's octree. megaviews-resolution: separated by commas (8,9,10,11); octree: such trees alone; coverage, megaviews-views: one, of what MegaViews draws in place of samples")->delimiter(',')->check(CLI::Range(1u, 12u));
    bench->add_option("--images", o.images, "coverage, manylods-ism, megaviews-resolution: a folder for the images that are compared, as EXR and PNG; bias: for plots");
    bench->add_option("--device", arguments->device, "part of a device's name, or its index");
    bench->callback([arguments, bench] { run(*arguments, *bench); });
}

}  // namespace myriad::tools
