#include "tools/judge.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/error.hpp"
#include "tools/exr.hpp"
#include "tools/png.hpp"

namespace myriad::tools {
namespace {

std::string about_nonfinite(const Image& image, const NonFinite& count) {
    return "'" + image.origin + "' has " + std::to_string(count.nan) + " NaN and " + std::to_string(count.inf) +
           " Inf values, the first at pixel " + std::to_string(count.x) + "," + std::to_string(count.y);
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

Image grey(const std::vector<float>& values, const Image& like) {
    Image image;
    image.width = like.width, image.height = like.height;
    for (const char* channel : {"R", "G", "B"}) image.add(channel) = values;
    return image;
}

}  // namespace

const Choices<DiffMetric> diff_metrics = {{"abs", DiffMetric::absolute}, {"FLIP", DiffMetric::flip}, {"HDR-FLIP", DiffMetric::hdr_flip}};

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

std::string show_limit(const Limit& limit) {
    char text[64];
    std::snprintf(text, sizeof text, "%s %s %g", limit.metric->name, limit.above ? "<=" : ">=", limit.value);
    return text;
}

double Tolerance::of(const Image& reference, std::string_view layer) const {
    const auto rgb = reference.rgb(layer);
    if (!relative || !rgb || !reference.pixels()) return value;  // `measure` refuses what has none
    double sum = 0;
    for (const auto& plane : {rgb->r, rgb->g, rgb->b})
        for (float v : plane) sum += v;
    return value * sum / (3 * static_cast<double>(reference.pixels()));
}

Tolerance parse_tolerance(const std::string& option, const std::string& text) {
    const bool relative = text.ends_with('%');
    const std::string number = relative ? text.substr(0, text.size() - 1) : text;
    char* end = nullptr;
    const double value = std::strtod(number.c_str(), &end);
    if (number.empty() || *end || !std::isfinite(value) || !(value >= 0))
        throw InputError(option + " '" + text + "': give a number from 0 on, such as 0.01, or a share of the mean of the reference, such as 2%");
    return {relative ? value / 100 : value, relative};
}

Verdict judge(const Image& reference, const Image& test, const Comparison& comparison) {
    Verdict verdict{measure(reference, test, comparison.tolerance.of(reference, comparison.layer), comparison.layer), {}};
    Metrics& m = verdict.metrics;
    measure_flip(m, reference, test, comparison.ppd, comparison.layer);
    if (m.reference.total()) verdict.failures.push_back(about_nonfinite(reference, m.reference));
    if (m.test.total()) verdict.failures.push_back(about_nonfinite(test, m.test));
    for (const Limit& limit : comparison.limits) {
        const double value = m.*limit.metric->value;
        if (limit.above ? value <= limit.value : value >= limit.value) continue;  // NaN never holds
        char text[96];
        const char* bound = limit.above ? "at most" : "at least";
        std::snprintf(text, sizeof text, "%s = %.6g is not %s %g", limit.metric->name, value, bound, limit.value);
        verdict.failures.push_back(text);
    }
    return verdict;
}

nlohmann::ordered_json to_json(const Metrics& m) {
    nlohmann::ordered_json json;
    for (const MetricName& metric : metric_names()) json[metric.name] = m.*metric.value;
    json["tolerance"] = m.tolerance;
    for (auto [name, count] : {std::pair{"reference", &m.reference}, {"test", &m.test}})
        json["nonFinite"][name] = {{"NaN", count->nan}, {"Inf", count->inf}};
    return json;
}

void require_map_name(const std::string& option, const std::string& path) {
    if (!path.ends_with(".exr") && !path.ends_with(".png"))
        throw InputError(option + " " + path + ": unknown format; name an .exr or a .png file");
}

ErrorMap write_error_map(const std::filesystem::path& path, const Image& reference, const Image& test, DiffMetric metric,
                         const Comparison& comparison) {
    const bool exr = path.extension() == ".exr";
    std::vector<float> errors;
    if (metric == DiffMetric::absolute) {
        const Image difference = absolute_difference(reference, test, comparison.layer);
        if (exr) {
            write_exr(path, difference, ExrColour::full);
            return {"|t-r|, linear"};
        }
        errors = greatest_channel(*difference.rgb());
    } else {
        errors = flip_errors(metric == DiffMetric::flip ? Flip::ldr : Flip::hdr, reference, test, comparison.ppd, comparison.layer);
        if (exr) {
            write_exr(path, grey(errors, reference), ExrColour::full);
            return {choice_name(diff_metrics, metric)};
        }
    }
    // FLIP is in [0, 1] whatever the image, and so is its map.
    const double scale = metric == DiffMetric::absolute ? heat_scale(errors) : 1;
    write_png(path, heat_map(errors, reference.width, reference.height, scale));
    char text[96];
    std::snprintf(text, sizeof text, "%s, dark blue 0 to light yellow %.6g",
                  metric == DiffMetric::absolute ? "max over channels of |t-r|" : choice_name(diff_metrics, metric).c_str(), scale);
    return {text, scale};
}

}  // namespace myriad::tools
