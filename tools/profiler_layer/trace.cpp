#include "tools/profiler_layer/trace.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

namespace myriad::profiler {
namespace {

// The text in quotes. Bytes from 128 stay as they are: UTF-8 is what Vulkan's names are.
std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\', out += c;
        else if (static_cast<unsigned char>(c) >= 32) out += c;
        else {
            char code[8];
            std::snprintf(code, sizeof code, "\\u%04x", unsigned(c));
            out += code;
        }
    }
    return out + "\"";
}

std::string csv_quoted(const std::string& text) {
    if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
    return out + "\"";
}

template <class... Values>
std::string print(const char* format, Values... values) {
    char text[256];
    std::snprintf(text, sizeof text, format, values...);
    return text;
}

bool on_host(Kind kind) { return kind >= Kind::host_frame; }

double median(std::vector<double>& values) {
    std::ranges::sort(values);
    const size_t half = values.size() / 2;
    return values.size() % 2 ? values[half] : (values[half - 1] + values[half]) / 2;
}

}  // namespace

const char* kind_name(Kind kind) {
    switch (kind) {
        case Kind::frame: return "frame";
        case Kind::commands: return "command buffer";
        case Kind::region: return "region";
        case Kind::render_pass: return "render pass";
        case Kind::command: return "command";
        case Kind::host_frame: return "host frame";
        case Kind::recording: return "recording";
        case Kind::submission: return "submission";
    }
    return "";
}

uint32_t Trace::interned(const std::string& name) {
    const auto [at, fresh] = name_index_.try_emplace(name, uint32_t(names_.size()));
    if (fresh) names_.push_back(name);
    return at->second;
}

uint32_t Trace::track(const std::string& name, int order) {
    const auto known = std::ranges::find(tracks_, name, &Track::name);
    if (known != tracks_.end()) return uint32_t(known - tracks_.begin());
    tracks_.push_back({name, order});
    return uint32_t(tracks_.size() - 1);
}

void Trace::span(uint32_t track, Kind kind, const std::string& name, double begin_ns, double ns, uint64_t frame) {
    spans_.push_back({track, interned(name), kind, begin_ns, ns, frame});
}

void Trace::counter(const std::string& name, double at_ns, double value) { samples_.push_back({interned(name), at_ns, value}); }

void Trace::arrow(uint32_t from_track, double from_ns, uint32_t to_track, double to_ns) {
    arrows_.push_back({from_track, to_track, from_ns, to_ns});
}

double Trace::origin_ns() const {
    double origin = spans_.empty() ? 0 : spans_.front().begin_ns;
    for (const Span& span : spans_) origin = std::min(origin, span.begin_ns);
    for (const Sample& sample : samples_) origin = std::min(origin, sample.at_ns);
    return origin;
}

std::string Trace::json() const {
    const double origin = origin_ns();
    const auto us = [&](double ns) { return (ns - origin) * 1e-3; };
    std::string out = "{\"displayTimeUnit\": \"ms\", \"traceEvents\": [\n"
                      "{\"ph\": \"M\", \"pid\": 1, \"tid\": 0, \"name\": \"process_name\", \"args\": {\"name\": \"Vulkan\"}}";
    for (size_t i = 0; i < tracks_.size(); ++i) {
        out += print(",\n{\"ph\": \"M\", \"pid\": 1, \"tid\": %zu, \"name\": \"thread_name\", \"args\": {\"name\": ", i + 1) + quoted(tracks_[i].name) + "}}";
        out += print(",\n{\"ph\": \"M\", \"pid\": 1, \"tid\": %zu, \"name\": \"thread_sort_index\", \"args\": {\"sort_index\": %d}}", i + 1, tracks_[i].order);
    }
    for (const Span& s : spans_)
        out += ",\n{\"ph\": \"X\", \"pid\": 1, \"tid\": " + std::to_string(s.track + 1) + ", \"name\": " + quoted(names_[s.name]) +
               print(", \"cat\": \"%s\", \"ts\": %.3f, \"dur\": %.3f, \"args\": {\"frame\": %llu}}", kind_name(s.kind), us(s.begin_ns), s.ns * 1e-3,
                     static_cast<unsigned long long>(s.frame));
    for (const Sample& s : samples_)
        out += ",\n{\"ph\": \"C\", \"pid\": 1, \"name\": " + quoted(names_[s.name]) + print(", \"ts\": %.3f, \"args\": {\"value\": %.17g}}", us(s.at_ns), s.value);
    size_t id = 0;
    for (const Arrow& a : arrows_) {
        out += print(",\n{\"ph\": \"s\", \"pid\": 1, \"tid\": %u, \"id\": %zu, \"name\": \"starts\", \"cat\": \"submission\", \"ts\": %.3f}", a.from_track + 1,
                     ++id, us(a.from_ns));
        out += print(",\n{\"ph\": \"f\", \"bp\": \"e\", \"pid\": 1, \"tid\": %u, \"id\": %zu, \"name\": \"starts\", \"cat\": \"submission\", \"ts\": %.3f}",
                     a.to_track + 1, id, us(a.to_ns));
    }
    out += "\n], \"otherData\": {";
    const char* comma = "";
    for (const auto& [text, count] : notes_) out += std::exchange(comma, ", ") + quoted(text) + ": " + std::to_string(count);
    return out + "}}\n";
}

std::string Trace::csv() const {
    struct Row {
        Kind kind;
        uint32_t name;
        std::vector<double> ms;
    };
    std::vector<Row> rows;
    std::map<std::pair<Kind, uint32_t>, size_t> index;
    for (const Span& span : spans_) {
        const auto [at, fresh] = index.try_emplace({span.kind, span.name}, rows.size());
        if (fresh) rows.push_back({span.kind, span.name, {}});
        rows[at->second].ms.push_back(span.ns * 1e-6);
    }
    std::ranges::stable_sort(rows, {}, [](const Row& row) { return std::pair(on_host(row.kind), row.kind); });
    std::string out = "kind,name,count,median_ms,total_ms,min_ms,max_ms\n";
    for (Row& row : rows) {
        double total = 0;
        for (const double ms : row.ms) total += ms;
        const double middle = median(row.ms);
        out += std::string(kind_name(row.kind)) + "," + csv_quoted(names_[row.name]) +
               print(",%zu,%.6f,%.6f,%.6f,%.6f\n", row.ms.size(), middle, total, row.ms.front(), row.ms.back());
    }
    return out;
}

std::string write_whole(const std::string& path, const std::string& text) {
    const std::string beside = path + ".part" + std::to_string(getpid());
    const auto failed = [&] { return "\"" + path + "\" could not be written (" + std::strerror(errno) + "); set output_file to where there is room"; };
    std::FILE* file = std::fopen(beside.c_str(), "wb");
    if (!file) return failed();
    const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
    const bool whole = std::fclose(file) == 0 && written && std::rename(beside.c_str(), path.c_str()) == 0;
    const std::string problem = whole ? "" : failed();
    if (!whole) std::remove(beside.c_str());
    return problem;
}

}  // namespace myriad::profiler
