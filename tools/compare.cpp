// `myriad compare REF.exr TEST.exr`: how far a test image is from its reference, and whether that is too far;
// `myriad compare --golden GOLDEN_DIR TEST_DIR`: the same of all images of a folder.
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/error.hpp"
#include "tools/arguments.hpp"
#include "tools/commands.hpp"
#include "tools/exr.hpp"
#include "tools/goldens.hpp"
#include "tools/judge.hpp"
#include "tools/output_file.hpp"
#include "tools/revision.hpp"

namespace myriad::tools {
namespace {

struct Options {
    std::vector<std::string> files;
    std::string layer, diff, tolerance = "0.01";
    std::vector<std::string> above, below;  // METRIC=VALUE
    DiffMetric diff_metric = DiffMetric::absolute;
    float ppd = float(flip_ppd);
    bool json = false;

    std::string golden, heat_maps, junit, reason;
    bool all_maps = false, bless = false;
};

Comparison comparison_of(const Options& options) {
    Comparison comparison{.layer = options.layer, .tolerance = parse_tolerance("--tolerance", options.tolerance), .ppd = options.ppd, .limits = {}};
    for (const std::string& text : options.above) comparison.limits.push_back(parse_limit(text, true));
    for (const std::string& text : options.below) comparison.limits.push_back(parse_limit(text, false));
    return comparison;
}

void print(const nlohmann::ordered_json& json) {
    std::printf("%s\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
}

void print_table(const Metrics& m) {
    for (const MetricName& metric : metric_names())
        std::printf("%-11s %12.6g   %s\n", metric.name, m.*metric.value, metric.meaning);
    std::printf("tolerance %g\n", m.tolerance);
}

// ---- Two images ----

void compare_images(const Options& options, const Comparison& comparison) {
    const Image reference = read_exr(options.files[0]), test = read_exr(options.files[1]);
    const auto& [m, broken] = judge(reference, test, comparison);
    ErrorMap map;
    if (!options.diff.empty()) map = write_error_map(options.diff, reference, test, options.diff_metric, comparison);

    std::string failures;
    for (const std::string& failure : broken) failures += (failures.empty() ? "" : "; ") + failure;
    if (options.json) {
        nlohmann::ordered_json json = to_json(m);
        if (!options.diff.empty()) {
            json["diff"] = {{"file", options.diff}, {"metric", choice_name(diff_metrics, options.diff_metric)}};
            if (map.scale > 0) json["diff"]["scale"] = map.scale;
        }
        json["failed"] = !failures.empty();
        print(json);
    } else {
        print_table(m);
        if (!options.diff.empty()) std::printf("%s: %s\n", options.diff.c_str(), map.text.c_str());
    }
    std::fflush(stdout);
    if (m.clipped > 0.5)
        std::fprintf(stderr, "note: %.0f %% of the reference is above 1, where PSNR, SSIM and FLIP see nothing\n", 100 * m.clipped);
    if (!failures.empty()) throw Error(Error::Kind::check_failed, "comparison failed: " + failures);
}

// ---- Two folders ----

void bless_folder(const Options& options, const Comparison& comparison) {
    const std::string& tested = options.files[0];
    // Where there are no goldens yet they are made; one that nobody rendered is not there to be judged.
    if (std::filesystem::is_directory(options.golden))
        for (const std::string& name : exr_names(options.golden))
            if (!std::filesystem::exists(tested + "/" + name))
                throw InputError("--bless: there is no '" + tested + "/" + name + "'; nothing is blessed, render it, or delete its golden");
    const Blessing blessing{options.reason, std::string("myriad ") + git_revision};
    const std::vector<std::string> moved = bless(options.golden, tested, exr_names(tested), comparison, blessing);
    if (options.json) return print({{"blessed", moved}});
    for (const std::string& name : moved) std::printf("blessed %s\n", name.c_str());
    std::printf("%zu blessed; %s\n", moved.size(), moved.empty() ? "all are as they were" : (options.golden + "/blessed.log says why").c_str());
}

void compare_folders(const Options& options, const Comparison& comparison) {
    const GoldenOptions how{comparison, options.heat_maps, options.all_maps, options.diff_metric};
    const std::vector<GoldenResult> results = judge_goldens(options.golden, options.files[0], how);
    if (!options.junit.empty()) write_text(options.junit, golden_junit(results));
    if (options.json) print(golden_json(results, comparison.limits));
    else std::fputs(golden_table(results, comparison.limits).c_str(), stdout);
    std::fflush(stdout);
    const auto failed = std::ranges::count_if(results, [](const GoldenResult& r) { return !r.passed(); });
    if (failed)
        throw Error(Error::Kind::check_failed, std::to_string(failed) + " of " + std::to_string(results.size()) + " images failed; the worst, '" +
                                                   results[0].name + "': " + results[0].failures[0]);
}

void require_two_images(const Options& o) {
    for (const auto& [given, name] : {std::pair(!o.heat_maps.empty(), "--heat-maps"), {o.all_maps, "--all-heat-maps"},
                                      {!o.junit.empty(), "--junit"}, {o.bless, "--bless"}})
        if (given) throw InputError(std::string(name) + " is about folders of images; name that of the goldens with --golden GOLDEN_DIR");
    if (o.files.size() != 2)
        throw InputError(std::string(o.files.empty() ? "REF is required" : o.files.size() == 1 ? "TEST is required" : "a file too many is given") +
                         "; compare takes two images, REF.exr and TEST.exr, or --golden GOLDEN_DIR and TEST_DIR");
    if (o.diff.empty() && o.diff_metric != DiffMetric::absolute)
        throw InputError("--diff-metric says what a map shows, and none is asked for; name it with --diff FILE");
    if (!o.diff.empty()) require_map_name("--diff", o.diff);
}

void require_folders(const Options& o) {
    if (o.files.size() != 1)
        throw InputError("--golden GOLDEN_DIR takes one folder beside it, TEST_DIR; " + std::to_string(o.files.size()) + " given");
    if (!o.diff.empty()) throw InputError("--diff is about two images; for folders give --heat-maps DIR");
    if (o.heat_maps.empty() && (o.all_maps || o.diff_metric != DiffMetric::absolute))
        throw InputError(std::string(o.all_maps ? "--all-heat-maps" : "--diff-metric") +
                         " is about maps, and none are asked for; name their folder with --heat-maps DIR");
    if (o.bless && (!o.heat_maps.empty() || !o.junit.empty()))
        throw InputError("--bless compares nothing that " + std::string(o.junit.empty() ? "--heat-maps could draw" : "--junit could tell") +
                         "; compare first, without it");
    if (!o.bless && o.above.empty() && o.below.empty())
        throw InputError("no limit is given, and so nothing could fail; give --fail-above METRIC=VALUE, such as maxAbs=0 where nothing may differ");
    if (!o.junit.empty()) require_writable(o.junit);
}

void run(const Options& options) {  // bad usage is told before files are read
    const Comparison comparison = comparison_of(options);
    if (options.golden.empty()) require_two_images(options), compare_images(options, comparison);
    else require_folders(options), options.bless ? bless_folder(options, comparison) : compare_folders(options, comparison);
}

}  // namespace

void add_compare(CLI::App& app) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("compare", "How far an image is from its reference, or a folder of images from its goldens");
    command->footer(
        "Formulas, r the reference and t the test, linear, over all pixels and R, G, B:\n"
        "  MSE mean (t-r)^2; relMSE mean (t-r)^2/(r^2+0.01); MAE mean |t-r|; maxAbs max |t-r|; PSNR and SSIM on values clamped\n"
        "  to [0,1] and encoded as sRGB, PSNR with peak 1 and at most 200 dB (identical images), SSIM (Wang 2004) on luma, 11x11\n"
        "  Gaussian windows; FLIP (Andersson 2020) on values clamped to [0,1], HDR-FLIP (Andersson 2021) the greatest FLIP of\n"
        "  each pixel over exposures found from r, ACES tone map: means over pixels, 0 is not to be seen, 1 is green against\n"
        "  blue; p95Abs, p95FLIP, p95HDR-FLIP the 95th percentile, nearest rank, over pixels (p95Abs: of the greatest |t-r| of\n"
        "  R, G, B); failing the share of pixels whose greatest |t-r| is beyond the tolerance; clipped the share of r above 1.\n"
        "Folders: each .exr below GOLDEN_DIR against its namesake below TEST_DIR. Missing, extra and unreadable files and other\n"
        "sizes fail; limits hold for every image. --bless replaces the goldens by what is in TEST_DIR, once all of it was read\n"
        "and is finite, and appends date, reason, revision, files and how far they move to GOLDEN_DIR/blessed.log.\n"
        "Exit status 1 when a limit is broken, an image holds NaN or Inf (metrics are then null in JSON), or one of a folder fails.");
    // Which ones and how many is told by --golden.
    command->add_option("FILES", options->files, "REF.exr and TEST.exr; or TEST_DIR")->type_name("")->expected(0, -1);
    command->add_option("--layer", options->layer, "layer to compare (direct, indirect, albedo, N, P, Z); beauty unless given");
    command->add_option("--tolerance", options->tolerance, "|t-r| beyond which a pixel counts as failing; P%: of the mean of r")
        ->type_name("X|P%")
        ->capture_default_str();
    // One value an option, or the list would swallow the file names after it.
    command->add_option("--fail-above", options->above, "exit 1 when a metric is above a value; repeatable")
        ->type_name("METRIC=VALUE")
        ->allow_extra_args(false);
    command->add_option("--fail-below", options->below, "exit 1 when a metric is below a value (PSNR, SSIM); repeatable")
        ->type_name("METRIC=VALUE")
        ->allow_extra_args(false);
    command->add_option("--diff", options->diff, "write the error of each pixel: as it is (.exr) or as a heat map (.png)")->type_name("FILE");
    add_choice(*command, "--diff-metric", options->diff_metric, diff_metrics, "what maps show");
    add_number(*command, "--ppd", options->ppd, flip_least_ppd, flip_most_ppd,
               "pixels per degree of the eye, for FLIP; unless given, 0.7 m before a screen of 0.7 m and 3840 pixels");
    command->add_flag("--json", options->json, "print one JSON object");
    command->add_option("--golden", options->golden, "folder of references; each image against its namesake in TEST_DIR")->type_name("GOLDEN_DIR");
    command->add_option("--heat-maps", options->heat_maps, "folder for a heat map (.png) of each image that fails; made where it is absent")
        ->type_name("DIR");
    command->add_flag("--all-heat-maps", options->all_maps, "of those that pass, too");
    command->add_option("--junit", options->junit, "write the outcome as JUnit XML, a test case an image")->type_name("FILE");
    CLI::Option* bless = command->add_option("--bless", options->reason, "replace the goldens by what is tested, and log why")->type_name("REASON");
    command->callback([options, bless] {
        options->bless = bless->count() > 0;
        run(*options);
    });
}

}  // namespace myriad::tools
