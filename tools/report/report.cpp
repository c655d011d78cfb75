#include "tools/report/report.hpp"

#include <algorithm>
#include <cstdio>

#include "tools/plot.hpp"
#include "tools/xml.hpp"

namespace myriad::tools {
namespace {

std::string number(double value, const char* format = "%.3g") {
    char text[32];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

std::string element(const std::string& tag, const std::string& inner) { return "<" + tag + ">" + inner + "</" + tag.substr(0, tag.find(' ')) + ">"; }

std::string row(const std::vector<std::string>& cells, const char* tag = "td") {
    std::string inner;
    for (const std::string& cell : cells) inner += element(tag, cell);
    return element("tr", inner) + "\n";
}

// Told apart with any colour vision (Okabe and Ito 2008).
const char* colour_of(size_t group) {
    static constexpr const char* colours[] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"};
    return colours[group % std::size(colours)];
}

std::string plot_of(const Report& report, const ReportScene& scene, const std::string& metric) {
    Plot plot;
    plot.title = metric + " against seconds: the best of each technique";
    plot.x_label = "seconds a frame", plot.y_label = metric;
    plot.logarithmic = true;
    for (size_t g = 0; g < report.groups.size(); ++g) {
        Plot::Line line{report.groups[g], colour_of(g), {}};
        for (const size_t i : pareto_front(scene.trials, report.groups[g], metric))
            if (const double error = scene.trials[i].error.at(metric); error > 0) line.points.push_back({scene.trials[i].seconds(), error});
        if (!line.points.empty()) plot.lines.push_back(std::move(line));
    }
    return plot.lines.empty() ? "" : to_svg(plot);
}

std::string budget_table(const Report& report, const ReportScene& scene, const std::string& metric) {
    std::vector<std::string> head = {"budget, s"};
    for (const std::string& group : report.groups) head.push_back(xml_escaped(group));
    std::string rows = row(head, "th");
    for (const double budget : scene.budgets) {
        std::vector<std::string> cells = {number(budget)};
        std::optional<double> least;
        for (const std::string& group : report.groups)
            if (const auto best = best_within(scene.trials, group, metric, budget))
                least = std::min(scene.trials[*best].error.at(metric), least.value_or(scene.trials[*best].error.at(metric)));
        for (const std::string& group : report.groups) {
            const auto best = best_within(scene.trials, group, metric, budget);
            if (!best) {
                cells.push_back("–");
                continue;
            }
            const Trial& t = scene.trials[*best];
            const std::string value = number(t.error.at(metric), "%.4g");
            cells.push_back((t.error.at(metric) == *least ? element("b", value) : value) +
                            element("small", "<br>" + number(t.seconds()) + " s: " + xml_escaped(t.options)));
        }
        rows += row(cells);
    }
    return element("h3", xml_escaped(metric) + " within a budget") + "\n" + element("table", rows) + "\n";
}

std::string parts_table(const ReportScene& scene) {
    if (scene.parts.empty()) return "";
    std::vector<std::string> head = {"what is wrong", "measured against"};
    for (const auto& [metric, value] : scene.parts.front().error) head.push_back(xml_escaped(metric));
    std::string rows = row(head, "th");
    for (const ErrorPart& part : scene.parts) {
        std::vector<std::string> cells = {xml_escaped(part.what), xml_escaped(part.against)};
        for (const auto& [metric, value] : part.error) cells.push_back(number(value, "%.4g"));
        rows += row(cells);
    }
    return element("h3", "What the error is made of") + "\n" + element("p", "Of " + element("code", xml_escaped(scene.parts_of)) + ", each part by itself.") + "\n" + element("table", rows) + "\n";
}

std::string pictures_of(const ReportScene& scene) {
    std::string out;
    for (const auto& shown : scene.pictures) {
        std::string figures;
        for (const auto& [title, picture] : shown) {
            const std::vector<char> png = png_bytes(picture);
            figures += "<figure><img alt=\"" + xml_escaped(title) + "\" src=\"data:image/png;base64," + base64({png.data(), png.size()}) + "\"><figcaption>" + xml_escaped(title) +
                       "</figcaption></figure>\n";
        }
        out += "<div class=\"pictures\">\n" + figures + "</div>\n";
    }
    return out;
}

const char* const style =
    "body{font:15px/1.45 system-ui,sans-serif;max-width:1320px;margin:2em auto;padding:0 1em;color:#222}"
    "table{border-collapse:collapse;margin:1em 0}td,th{border:1px solid #ccc;padding:.25em .6em;text-align:left;vertical-align:top}"
    "small{color:#666}figure{margin:0}figure img{width:100%;display:block}figcaption{font-size:13px;color:#444}"
    ".pictures{display:grid;grid-template-columns:repeat(auto-fit,minmax(300px,1fr));gap:10px;margin:10px 0}.plots{display:flex;flex-wrap:wrap;gap:16px}code{font-size:13px}";

}  // namespace

double Trial::seconds() const {
    std::vector<double> sorted = runs;
    std::ranges::sort(sorted);
    return sorted[sorted.size() / 2];
}

std::vector<size_t> pareto_front(std::span<const Trial> trials, std::string_view group, const std::string& metric) {
    std::vector<size_t> order;
    for (size_t i = 0; i < trials.size(); ++i)
        if (trials[i].group == group && trials[i].error.contains(metric)) order.push_back(i);
    const auto error = [&](size_t i) { return trials[i].error.at(metric); };
    std::ranges::stable_sort(order, [&](size_t a, size_t b) { return trials[a].seconds() != trials[b].seconds() ? trials[a].seconds() < trials[b].seconds() : error(a) < error(b); });
    std::vector<size_t> front;
    for (const size_t i : order)
        if (front.empty() || error(i) < error(front.back())) front.push_back(i);
    return front;
}

std::optional<size_t> best_within(std::span<const Trial> trials, std::string_view group, const std::string& metric, double budget) {
    std::optional<size_t> best;
    for (const size_t i : pareto_front(trials, group, metric))
        if (trials[i].seconds() <= budget) best = i;
    return best;
}

std::string to_html(const Report& report) {
    std::string out = "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>Myriad: speed against error</title><style>" + std::string(style) + "</style>\n";
    out += element("h1", "Speed against error") + "\n";
    out += element("p", "Made by " + element("code", xml_escaped(report.command)) + ", Myriad " + xml_escaped(report.revision) + ", on " + xml_escaped(report.device) + " (" +
                            xml_escaped(report.driver) + "), " + xml_escaped(report.cpu) + ".") + "\n";
    out += element("p", "Errors are against a path-traced reference without virtual lights, made on the CPU by code of its own (<code>myriad reference</code>). Seconds are of one frame on a warm device, all "
                        "passes included; loading, and trees that are built once a scene, are not, for any technique. Of each technique the best settings found are shown, so each is at its best at every "
                        "time. relMSE is the mean of (t&nbsp;−&nbsp;r)²/(r²&nbsp;+&nbsp;0.01), dominated by bright outliers; FLIP is the mean difference that is seen when two images are flipped, 0 to 1. "
                        "A path tracer's error is noise, and falls with time; virtual lights' is bias, and stays.") + "\n";
    for (const ReportScene& scene : report.scenes) {
        out += element("h2", xml_escaped(scene.name + (scene.camera.empty() ? "" : ", camera " + scene.camera))) + "\n";
        out += element("p", std::to_string(scene.triangles) + " triangles, " + std::to_string(scene.width) + "×" + std::to_string(scene.height) + ", bounces of indirect light: " +
                                std::to_string(scene.bounces) + ". Reference: " + std::to_string(scene.reference_samples) + " paths a pixel, whose own noise is a relMSE of about " +
                                number(scene.reference_noise) + ".") + "\n<div class=\"plots\">\n";
        for (const std::string& metric : report.metrics) out += "<div>" + plot_of(report, scene, metric) + "</div>\n";
        out += "</div>\n";
        for (const std::string& metric : report.metrics) out += budget_table(report, scene, metric);
        out += parts_table(scene) + pictures_of(scene);
    }
    return out + "</html>\n";
}

std::string to_csv(const Report& report) {
    std::string out = "scene,camera,group,technique,seconds,least,most,runs";
    for (const std::string& metric : report.metrics) out += "," + metric;
    out += ",options\n";
    const auto quoted = [](const std::string& text) {
        std::string q = "\"";
        for (const char c : text) q += c == '"' ? "\"\"" : std::string(1, c);
        return q + "\"";
    };
    for (const ReportScene& scene : report.scenes)
        for (const Trial& t : scene.trials) {
            out += quoted(scene.name) + "," + quoted(scene.camera) + "," + quoted(t.group) + "," + t.technique;
            for (const double s : {t.seconds(), *std::ranges::min_element(t.runs), *std::ranges::max_element(t.runs)}) out += "," + number(s, "%.6g");
            out += "," + std::to_string(t.runs.size());
            for (const std::string& metric : report.metrics) out += "," + (t.error.contains(metric) ? number(t.error.at(metric), "%.6g") : "");
            out += "," + quoted(t.options) + "\n";
        }
    return out;
}

std::string base64(std::string_view bytes) {
    static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t word = 0;
        const size_t have = std::min<size_t>(bytes.size() - i, 3);
        for (size_t k = 0; k < 3; ++k) word = word << 8 | (k < have ? uint8_t(bytes[i + k]) : 0);
        for (size_t k = 0; k < 4; ++k) out += k <= have ? digits[word >> (18 - 6 * k) & 63] : '=';
    }
    return out;
}

}  // namespace myriad::tools
