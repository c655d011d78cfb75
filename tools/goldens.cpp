#include "tools/goldens.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iterator>

#include "engine/error.hpp"
#include "tools/exr.hpp"
#include "tools/output_file.hpp"
#include "tools/xml.hpp"

namespace myriad::tools {
namespace {

namespace fs = std::filesystem;

bool is_exr(const fs::path& path) {
    std::string ending = path.extension().string();
    std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
    return ending == ".exr";
}

void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw InputError("cannot make the folder '" + folder.string() + "': " + error.message() + "; choose another path");
}

// A pipe would never end.
void require_file(const fs::path& path) {
    std::error_code ignored;
    if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored))
        throw InputError("'" + path.string() + "' is no file; replace it by an image");
}

Image read_golden(const fs::path& path) {
    require_file(path);
    return read_exr(path);
}

bool there(const fs::path& path) {
    std::error_code ignored;
    return fs::exists(fs::symlink_status(path, ignored));
}

// Metrics that a line has room for: those of the limits first.
std::vector<const MetricName*> columns(const std::vector<Limit>& limits) {
    std::vector<const MetricName*> out;
    const auto add = [&](const MetricName& metric) {
        if (std::ranges::find(out, &metric) == out.end()) out.push_back(&metric);
    };
    for (const Limit& limit : limits) add(*limit.metric);
    for (const MetricName& metric : metric_names())
        for (const char* usual : {"relMSE", "SSIM", "FLIP", "HDR-FLIP", "maxAbs"})
            if (std::string(usual) == metric.name) add(metric);
    return out;
}

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

// Without what could drive a terminal.
std::string printable(std::string text) {
    std::ranges::replace_if(text, [](unsigned char c) { return c < ' ' || c == 0x7f; }, '?');
    return text;
}

std::string bytes_of(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::string today() {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
    return text;
}

std::string one_line(std::string text) {
    std::ranges::replace_if(text, [](unsigned char c) { return c < ' ' || c == 0x7f; }, ' ');
    const size_t from = text.find_first_not_of(' ');
    return from == std::string::npos ? "" : text.substr(from, text.find_last_not_of(' ') - from + 1);
}

// How far a golden will move.
std::string moves(const fs::path& golden, const Image& test, const Comparison& comparison) {
    if (!there(golden)) return "new";
    try {
        const Metrics m = judge(read_golden(golden), test, comparison).metrics;
        std::string text;
        for (const MetricName* metric : columns(comparison.limits))
            text += (text.empty() ? "" : ", ") + (metric->name + (" " + number(m.*metric->value)));
        return text;
    } catch (const InputError& e) {
        return std::string("not comparable to the one before: ") + e.what();
    }
}

}  // namespace

std::vector<std::string> exr_names(const fs::path& folder) {
    if (!fs::is_directory(folder)) throw InputError("'" + folder.string() + "' is no folder; name one that holds images");
    std::vector<std::string> names;
    try {
        for (const auto& entry : fs::recursive_directory_iterator(folder))
            if (std::error_code ignored; is_exr(entry.path()) && !entry.is_directory(ignored))
                names.push_back(entry.path().lexically_relative(folder).generic_string());
    } catch (const fs::filesystem_error& e) {
        throw InputError("cannot look into '" + e.path1().string() + "': " + e.code().message() + "; change its permissions");
    }
    std::ranges::sort(names);
    return names;
}

GoldenResult judge_golden(const fs::path& golden, const fs::path& test, const std::string& name, const GoldenOptions& options) {
    const auto began = std::chrono::steady_clock::now();
    GoldenResult result{.name = name};
    const auto fail = [&](const std::string& kind, const std::string& what) {
        if (result.kind.empty()) result.kind = kind;
        result.failures.push_back(what);
    };
    Image reference, image;
    if (!there(golden)) {
        fail("extra", "there is no golden '" + golden.string() + "' for it; bless it if it is right");
    } else if (!there(test)) {
        fail("missing", "there is no '" + test.string() + "'; render it, or delete its golden");
    } else {
        try {
            reference = read_golden(golden), image = read_golden(test);
            result.golden_metadata = reference.metadata;
            const auto size = [](const Image& i) { return std::to_string(i.width) + "x" + std::to_string(i.height); };
            if (size(reference) != size(image)) {
                fail("size", "it is " + size(image) + " and its golden " + size(reference));
            } else {
                Verdict verdict = judge(reference, image, options.comparison);
                result.metrics = verdict.metrics;
                for (const std::string& failure : verdict.failures) fail(verdict.metrics.finite() ? "limit" : "nonfinite", failure);
            }
        } catch (const InputError& e) {
            fail("unreadable", e.what());
        }
    }
    if (result.metrics && !options.heat_maps.empty() && (options.all_maps || !result.passed())) {
        result.heat_map = (options.heat_maps / name).replace_extension(".png");
        make_folder(result.heat_map.parent_path());
        write_error_map(result.heat_map, reference, image, options.map_metric, options.comparison);
    }
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    return result;
}

std::vector<GoldenResult> judge_goldens(const fs::path& golden, const fs::path& test, const GoldenOptions& options) {
    std::vector<std::string> names = exr_names(golden), tested = exr_names(test), all;
    if (fs::equivalent(golden, test)) throw InputError("'" + golden.string() + "' is both the goldens and what is tested; name two folders");
    if (names.empty()) throw InputError("'" + golden.string() + "' holds no .exr; make it of images that are right with --bless REASON");
    std::ranges::set_union(names, tested, std::back_inserter(all));
    std::vector<GoldenResult> results;
    for (const std::string& name : all) results.push_back(judge_golden(golden / name, test / name, name, options));
    std::ranges::stable_sort(results, std::greater(), [](const GoldenResult& r) {
        return std::pair(!r.passed(), r.metrics && r.metrics->finite() ? r.metrics->flip : 2);
    });
    return results;
}

std::string golden_table(const std::vector<GoldenResult>& results, const std::vector<Limit>& limits) {
    const auto metrics = columns(limits);
    size_t width = 5;
    for (const GoldenResult& r : results) width = std::max(width, std::min<size_t>(printable(r.name).size(), 60));
    const auto padded = [](std::string text, size_t to) { return text + std::string(text.size() < to ? to - text.size() : 0, ' '); };
    const auto line = [&](const std::string& verdict, const std::string& name, const auto& cell) {
        std::string text = padded(verdict, 7) + padded(name, width);
        for (const MetricName* metric : metrics) text += "  " + padded(cell(*metric), 11);
        return text.substr(0, text.find_last_not_of(' ') + 1) + "\n";
    };
    std::string text = line("", "image", [](const MetricName& metric) { return std::string(metric.name); });
    std::map<std::string, size_t> failed;
    size_t passed = 0;
    for (const GoldenResult& r : results) {
        text += line(r.passed() ? "passed" : "FAILED", printable(r.name), [&](const MetricName& metric) {
            return r.metrics ? number(*r.metrics.*metric.value) : std::string("-");
        });
        for (const std::string& failure : r.failures) text += "       " + printable(failure) + "\n";
        if (!r.heat_map.empty()) text += "       " + printable(r.heat_map.string()) + "\n";
        r.passed() ? ++passed : ++failed[r.kind];
    }
    text += std::to_string(results.size()) + (results.size() == 1 ? " image: " : " images: ") + std::to_string(passed) + " passed, " +
            std::to_string(results.size() - passed) + " failed";
    std::string kinds;
    for (const auto& [kind, count] : failed) kinds += (kinds.empty() ? "" : ", ") + std::to_string(count) + " " + kind;
    return text + (kinds.empty() ? "" : " (" + kinds + ")") + "\n";
}

nlohmann::ordered_json golden_json(const std::vector<GoldenResult>& results, const std::vector<Limit>& limits) {
    nlohmann::ordered_json json, images = nlohmann::ordered_json::array(), bounds = nlohmann::ordered_json::array();
    for (const Limit& limit : limits) bounds.push_back(show_limit(limit));
    for (const GoldenResult& r : results) {
        nlohmann::ordered_json image = {{"name", r.name}, {"passed", r.passed()}};
        if (!r.passed()) image["kind"] = r.kind, image["failures"] = r.failures;
        if (r.metrics) image["metrics"] = to_json(*r.metrics);
        if (!r.heat_map.empty()) image["heatMap"] = r.heat_map.string();
        if (!r.golden_metadata.empty()) image["goldenMetadata"] = r.golden_metadata;
        images.push_back(std::move(image));
    }
    json["limits"] = std::move(bounds);
    json["failed"] = std::ranges::count_if(results, [](const GoldenResult& r) { return !r.passed(); });
    json["images"] = std::move(images);
    return json;
}

std::string golden_junit(const std::vector<GoldenResult>& results) {
    double seconds = 0;
    for (const GoldenResult& r : results) seconds += r.seconds;
    const auto failed = std::ranges::count_if(results, [](const GoldenResult& r) { return !r.passed(); });
    std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n  <testsuite name=\"myriad compare --golden\" tests=\"" +
                       std::to_string(results.size()) + "\" failures=\"" + std::to_string(failed) + "\" errors=\"0\" skipped=\"0\" time=\"" +
                       number(seconds) + "\">\n";
    for (const GoldenResult& r : results) {
        text += "    <testcase classname=\"goldens\" name=\"" + xml_escaped(r.name) + "\" time=\"" + number(r.seconds) + "\">\n";
        if (!r.passed()) {
            std::string what;
            for (const std::string& failure : r.failures) what += (what.empty() ? "" : "; ") + failure;
            const std::string map = r.heat_map.empty() ? "" : "see " + r.heat_map.string();
            text += "      <failure type=\"" + r.kind + "\" message=\"" + xml_escaped(what) + "\">" + xml_escaped(map) + "</failure>\n";
        }
        if (r.metrics) {
            text += "      <system-out>";
            for (const MetricName& metric : metric_names()) text += std::string(metric.name) + " " + number(*r.metrics.*metric.value) + "\n";
            text += "</system-out>\n";
        }
        text += "    </testcase>\n";
    }
    return text + "  </testsuite>\n</testsuites>\n";
}

std::vector<std::string> bless(const fs::path& golden, const fs::path& test, std::vector<std::string> names, const Comparison& comparison,
                               const Blessing& blessing) {
    const std::string reason = one_line(blessing.reason);
    if (reason.empty())
        throw InputError("--bless: no reason is given; write why the images are right as they are now, such as --bless \"softer shadows\"");
    std::string log = today() + "  " + blessing.by + "  " + reason + "\n";
    std::erase_if(names, [&](const std::string& name) {
        const fs::path path = test / name;
        const Image image = read_golden(path);
        for (const Image::Channel& channel : image.channels)
            if (!std::ranges::all_of(channel.values, [](float v) { return std::isfinite(v); }))
                throw InputError("--bless: '" + path.string() + "' has values that are NaN or Inf in " + channel.name +
                                 "; nothing is blessed, render it right first");
        if (there(golden / name) && bytes_of(golden / name) == bytes_of(path)) return true;
        log += "  " + one_line(name) + ": " + moves(golden / name, image, comparison) + "\n";
        return false;
    });
    if (names.empty()) return names;
    make_folder(golden);
    // The log comes first: of a step that ends halfway it then tells all that may have moved.
    const fs::path journal = golden / "blessed.log";
    write_text(journal, (there(journal) ? bytes_of(journal) : "") + log);
    for (const std::string& name : names) {
        make_folder((golden / name).parent_path());
        write_text(golden / name, bytes_of(test / name));
    }
    return names;
}

}  // namespace myriad::tools
