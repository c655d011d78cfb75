#include "tools/trace.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace myriad::tools {
namespace {

using nlohmann::ordered_json;

// Recording has a track of its own: where the recorder's clock began is known only to a microsecond or so, and events of one
// track must nest exactly.
constexpr int process = 1, cpu_track = 1, recording_track = 2, gpu_track = 3;

ordered_json named(const char* what, int track, const std::string& name) {
    return {{"ph", "M"}, {"pid", process}, {"tid", track}, {"name", what}, {"args", {{"name", name}}}};
}

ordered_json event(int track, const std::string& name, double begin_ms, double ms) {
    const auto microseconds = [](double ms) { return std::round(ms * 1e6) / 1e3; };  // to the nanosecond
    return {{"ph", "X"}, {"pid", process}, {"tid", track}, {"name", name}, {"ts", microseconds(begin_ms)}, {"dur", microseconds(ms)}};
}

// Every number of a frame's counters, under the names that stats.json has for them; those of parts behind the part's name.
void add_counters(ordered_json& events, const ordered_json& counters, const std::string& prefix, double at_ms) {
    for (const auto& [name, value] : counters.items()) {
        if (value.is_object()) add_counters(events, value, prefix + name + ": ", at_ms);
        if (value.is_number())
            events.push_back({{"ph", "C"}, {"pid", process}, {"tid", 0}, {"name", prefix + name}, {"ts", at_ms * 1e3}, {"args", {{"value", value}}}});
    }
}

}  // namespace

double gpu_offset_ms(const RunRecord& run) {
    if (run.device.common_clock) return 0;
    double offset = -std::numeric_limits<double>::infinity();
    for (const FrameRun& frame : run.frames)
        for (const engine::PassTime& pass : frame.passes)
            if (pass.gpu_ms > 0) offset = std::max(offset, pass.cpu_begin_ms + pass.cpu_ms - pass.gpu_begin_ms);
    return offset;
}

std::string trace_json(const RunRecord& run) {
    ordered_json events = {named("process_name", cpu_track, "myriad render " + run.scene), named("thread_name", cpu_track, "CPU"),
                           named("thread_name", recording_track, "CPU: recording"), named("thread_name", gpu_track, "GPU: " + run.device.name)};
    for (const HostPhase& phase : run.phases) events.push_back(event(cpu_track, phase.name, phase.begin_ms, phase.ms));
    const double gpu_ms = run.recorder_ms + gpu_offset_ms(run);
    for (const FrameRun& frame : run.frames) {
        events.push_back(event(cpu_track, frame.host.name, frame.host.begin_ms, frame.host.ms));
        add_counters(events, counters_json(frame), "", frame.host.begin_ms + frame.host.ms);
        for (const engine::PassTime& pass : frame.passes) {
            events.push_back(event(recording_track, pass.name, run.recorder_ms + pass.cpu_begin_ms, pass.cpu_ms));
            if (pass.gpu_ms > 0) events.push_back(event(gpu_track, pass.name, gpu_ms + pass.gpu_begin_ms, pass.gpu_ms));
        }
    }
    const ordered_json json = {{"displayTimeUnit", "ms"}, {"traceEvents", events}};
    return json.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace myriad::tools
