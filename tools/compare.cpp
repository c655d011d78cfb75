// `myriad compare REF.exr TEST.exr`: how far a test image is from its reference, and whether that is too far.
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "engine/error.hpp"
#include "tools/arguments.hpp"
#include "tools/commands.hpp"
#include "tools/exr.hpp"
#include "tools/metrics.hpp"
#include "tools/png.hpp"

namespace myriad::tools {
namespace {

enum class DiffMetric { absolute, flip, hdr_flip };
const Choices<DiffMetric> diff_metrics = {{"abs", DiffMetric::absolute}, {"FLIP", DiffMetric::flip}, {"HDR-FLIP", DiffMetric::hdr_flip}};

struct Options {
    std::string reference, test, layer, diff;
    DiffMetric diff_metric = DiffMetric::absolute;
    float ppd = float(flip_ppd);
    std::vector<std::string> above, below;  // METRIC=VALUE
    double tolerance = 0.01;
    bool json = false;
};

struct Limit {
    const MetricName* metric;
    double value;
    bool above;  // fails above the value, or below it
};

Limit parse_limit(const std::string& text, bool above) {
    const std::string option = above ? "--fail-above" : "--fail-below";
    const size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    std::string known;
    for (const MetricName& metric : metric_names()) {
        known += (known.empty() ? "" : ", ") + std::string(metric.name);
        if (name != metric.name) continue;
        const std::string number = equals == std::string::npos ? "" : text.substr(equals + 1);
        char* end = nullptr;
        const double value = std::strtod(number.c_str(), &end);
        if (number.empty() || *end || !std::isfinite(value))
            throw InputError(option + " " + text + ": no number after the metric; write " + name + "=VALUE");
        return {&metric, value, above};
    }
    throw InputError(option + " " + text + ": unknown metric '" + name + "'; known are " + known);
}

// The greatest error of the map, in the unit of the layer: the 99th percentile, so that one firefly does not blacken the
// rest; the maximum where 99 pixels in 100 are exact.
double heat_scale(const std::vector<float>& values) {
    std::vector<float> finite;
    std::ranges::copy_if(values, std::back_inserter(finite), [](float v) { return std::isfinite(v); });
    if (finite.empty()) return 0;
    const double scale = percentile(finite, 0.99);
    return scale > 0 ? scale : *std::ranges::max_element(finite);
}

struct Difference {
    std::string text;
    nlohmann::ordered_json json;
};

// FLIP is in [0, 1] whatever the image, and so is its map.
Difference write_flip(const std::string& path, Flip kind, const Image& reference, const Image& test, const Options& options) {
    const std::vector<float> errors = flip_errors(kind, reference, test, options.ppd, options.layer);
    const std::string& name = choice_name(diff_metrics, options.diff_metric);
    nlohmann::ordered_json json = {{"file", path}, {"metric", name}};
    if (path.ends_with(".exr")) {
        Image image;
        image.width = reference.width, image.height = reference.height;
        for (const char* channel : {"R", "G", "B"}) image.add(channel) = errors;
        write_exr(path, image, ExrColour::full);
        return {path + ": " + name, json};
    }
    write_png(path, heat_map(errors, reference.width, reference.height, 1));
    json["scale"] = 1;
    return {path + ": " + name + ", dark blue 0 to light yellow 1", json};
}

Difference write_difference(const Image& reference, const Image& test, const Options& options) {
    const std::string &path = options.diff, &layer = options.layer;
    if (options.diff_metric == DiffMetric::flip) return write_flip(path, Flip::ldr, reference, test, options);
    if (options.diff_metric == DiffMetric::hdr_flip) return write_flip(path, Flip::hdr, reference, test, options);
    const Image difference = absolute_difference(reference, test, layer);
    if (path.ends_with(".exr")) {
        write_exr(path, difference, ExrColour::full);
        return {path + ": |t-r|, linear", {{"file", path}}};
    }
    const std::vector<float> values = greatest_channel(*difference.rgb());
    const double scale = heat_scale(values);
    write_png(path, heat_map(values, difference.width, difference.height, scale));
    char text[96];
    std::snprintf(text, sizeof text, ": max over channels of |t-r|, dark blue 0 to light yellow %.6g", scale);
    return {path + text, {{"file", path}, {"scale", scale}}};
}

nlohmann::ordered_json to_json(const Metrics& m) {
    nlohmann::ordered_json json;
    for (const MetricName& metric : metric_names()) json[metric.name] = m.*metric.value;  // NaN prints as null
    json["tolerance"] = m.tolerance;
    for (auto [name, count] : {std::pair{"reference", &m.reference}, {"test", &m.test}})
        json["nonFinite"][name] = {{"NaN", count->nan}, {"Inf", count->inf}};
    return json;
}

void print_table(const Metrics& m) {
    for (const MetricName& metric : metric_names())
        std::printf("%-11s %12.6g   %s\n", metric.name, m.*metric.value, metric.meaning);
    std::printf("tolerance %g\n", m.tolerance);
}

void run(const Options& options) {
    std::vector<Limit> limits;  // bad usage is told before files are read
    for (const std::string& text : options.above) limits.push_back(parse_limit(text, true));
    for (const std::string& text : options.below) limits.push_back(parse_limit(text, false));
    if (!options.diff.empty() && !options.diff.ends_with(".exr") && !options.diff.ends_with(".png"))
        throw InputError("--diff " + options.diff + ": unknown format; name an .exr or a .png file");
    if (options.diff.empty() && options.diff_metric != DiffMetric::absolute)
        throw InputError("--diff-metric says what a map shows, and none is asked for; name it with --diff FILE");

    const Image reference = read_exr(options.reference), test = read_exr(options.test);
    Metrics m = measure(reference, test, options.tolerance, options.layer);
    measure_flip(m, reference, test, options.ppd, options.layer);
    Difference difference;
    if (!options.diff.empty()) difference = write_difference(reference, test, options);

    std::string failures;
    const auto fail = [&](const std::string& what) { failures += (failures.empty() ? "" : "; ") + what; };
    for (auto [path, count] : {std::pair{&options.reference, &m.reference}, {&options.test, &m.test}})
        if (count->total())
            fail("'" + *path + "' has " + std::to_string(count->nan) + " NaN and " + std::to_string(count->inf) +
                 " Inf values, the first at pixel " + std::to_string(count->x) + "," + std::to_string(count->y));
    for (const Limit& limit : limits) {
        const double value = m.*limit.metric->value;
        if (limit.above ? value <= limit.value : value >= limit.value) continue;  // NaN never holds
        char text[96];
        const char* bound = limit.above ? "at most" : "at least";
        std::snprintf(text, sizeof text, "%s = %.6g is not %s %g", limit.metric->name, value, bound, limit.value);
        fail(text);
    }

    if (options.json) {
        nlohmann::ordered_json json = to_json(m);
        if (!options.diff.empty()) json["diff"] = difference.json;
        json["failed"] = !failures.empty();
        std::printf("%s\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
    } else {
        print_table(m);
        if (!options.diff.empty()) std::printf("%s\n", difference.text.c_str());
    }
    std::fflush(stdout);
    if (m.clipped > 0.5)
        std::fprintf(stderr, "note: %.0f %% of the reference is above 1, where PSNR, SSIM and FLIP see nothing\n", 100 * m.clipped);
    if (!failures.empty()) throw Error(Error::Kind::check_failed, "comparison failed: " + failures);
}

}  // namespace

void add_compare(CLI::App& app) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("compare", "How far an image is from its reference");
    command->footer(
        "Formulas, r the reference and t the test, linear, over all pixels and R, G, B:\n"
        "  MSE mean (t-r)^2; relMSE mean (t-r)^2/(r^2+0.01); PSNR and SSIM on values clamped to [0,1] and encoded as sRGB,\n"
        "  PSNR with peak 1 and at most 200 dB (identical images), SSIM (Wang 2004) on luma, 11x11 Gaussian windows;\n"
        "  FLIP (Andersson 2020) on values clamped to [0,1], HDR-FLIP (Andersson 2021) the greatest FLIP of each pixel over exposures\n"
        "  found from r, ACES tone map: means over pixels, 0 is not to be seen, 1 is green against blue; p95... the 95th percentile,\n"
        "  nearest rank, over pixels (p95Abs: of the greatest |t-r| of R, G, B); failing and clipped: see the table.\n"
        "Exit status 1 when a limit is broken or either image holds NaN or Inf (metrics are then null in JSON).");
    command->add_option("REF", options->reference, "reference, EXR")->required();
    command->add_option("TEST", options->test, "image to judge, EXR")->required();
    command->add_option("--layer", options->layer, "layer to compare (direct, indirect, albedo, N, P, Z); beauty unless given");
    command->add_option("--tolerance", options->tolerance, "|t-r| beyond which a pixel counts as failing")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    // One value an option, or the list would swallow the file names after it.
    command->add_option("--fail-above", options->above, "exit 1 when a metric is above a value; repeatable")
        ->type_name("METRIC=VALUE")
        ->allow_extra_args(false);
    command->add_option("--fail-below", options->below, "exit 1 when a metric is below a value (PSNR, SSIM); repeatable")
        ->type_name("METRIC=VALUE")
        ->allow_extra_args(false);
    command->add_option("--diff", options->diff, "write the error of each pixel: as it is (.exr) or as a heat map (.png)")->type_name("FILE");
    add_choice(*command, "--diff-metric", options->diff_metric, diff_metrics, "what --diff shows");
    add_number(*command, "--ppd", options->ppd, flip_least_ppd, flip_most_ppd,
               "pixels per degree of the eye, for FLIP; unless given, 0.7 m before a screen of 0.7 m and 3840 pixels");
    command->add_flag("--json", options->json, "print one JSON object");
    command->callback([options] { run(*options); });
}

}  // namespace myriad::tools
