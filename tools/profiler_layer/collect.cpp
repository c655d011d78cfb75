// From timestamps to the trace: what a submission took, and what a frame.
#include <algorithm>
#include <utility>

#include "tools/profiler_layer/registry.hpp"

namespace myriad::profiler {

void Device::collect_if(const std::function<bool(const Submission&)>& over) {
    const std::lock_guard lock(mutex_);
    bool any = false;
    for (auto at = under_way_.begin(); at != under_way_.end();) {
        if (!over(*at)) {
            ++at;
            continue;
        }
        collect(*at);
        at = under_way_.erase(at);
        any = true;
    }
    if (!any) return;
    bool finished = frame_ > profiler_.settings.last_frame && under_way_.empty();
    {
        const std::lock_guard trace_lock(profiler_.mutex);
        tell_frames();
    }
    if (finished) profiler_.write();
}

void Device::collect(const Submission& submission) {
    collect_times(submission, *submission.recording, true);
    std::vector<const Recording*> told;
    for (const auto& secondary : submission.recording->secondaries) {
        const bool again = std::ranges::count(told, secondary.get()) > 0;
        told.push_back(secondary.get());
        if (!again) {
            collect_times(submission, *secondary, false);
            continue;
        }
        const std::lock_guard lock(profiler_.mutex);
        profiler_.trace.note("secondary command buffers executed twice in one submission: the earlier times are lost");
    }
    --frames_[{submission.queue, submission.frame}].under_way;
}

void Device::collect_times(const Submission& submission, const Recording& recording, bool primary) {
    const Queue& queue = queues_[submission.queue];
    const uint32_t bits = families_[queue.family].timestamp_bits;
    const std::map<uint32_t, uint64_t> ticks = recording.read();
    const std::lock_guard lock(profiler_.mutex);
    profiler_.changed = true;
    if (recording.untimed) profiler_.trace.note("stretches in a render pass for which queries ran out: not timed", recording.untimed);
    for (const Stretch& stretch : recording.stretches()) {
        const auto begin = ticks.find(stretch.begin), end = ticks.find(stretch.end);
        if (begin == ticks.end() || end == ticks.end()) continue;
        const double begin_ns = clock_.host_ns(begin->second, bits, submission.submitted_ns);
        const double end_ns = clock_.host_ns(end->second, bits, submission.submitted_ns);
        profiler_.trace.span(queue.track, stretch.kind, stretch.name, begin_ns, end_ns - begin_ns, submission.frame);
        if (stretch.kind != Kind::commands || !primary) continue;
        profiler_.trace.arrow(submission.host_track, submission.submitted_ns, queue.track, begin_ns);
        Frame& frame = frames_[{submission.queue, submission.frame}];
        frame.begin_ns = frame.end_ns > frame.begin_ns ? std::min(frame.begin_ns, begin_ns) : begin_ns;
        frame.end_ns = std::max(frame.end_ns, end_ns);
    }
}

// Once, with the first frame that submits it.
void Device::tell_recording(Recording& recording, uint64_t frame) {
    if (std::exchange(recording.host_told, true)) return;
    for (const Stretch& stretch : recording.stretches())
        if (stretch.kind != Kind::command)
            profiler_.trace.span(recording.thread, Kind::recording, stretch.name, stretch.host_begin_ns, stretch.host_ns, frame);
    for (const auto& secondary : recording.secondaries) tell_recording(*secondary, frame);
}

void Device::tell_frames() {
    std::erase_if(frames_, [&](const auto& entry) {
        const auto& [queue, number] = entry.first;
        const Frame& frame = entry.second;
        if (frame.under_way || number >= frame_) return false;
        if (frame.end_ns > frame.begin_ns)
            profiler_.trace.span(queues_[queue].frame_track, Kind::frame, "frame", frame.begin_ns, frame.end_ns - frame.begin_ns, number);
        return true;
    });
}

void Device::next_frame(double now) {
    if (profiler_.settings.covers(frame_)) {
        const Settings& settings = profiler_.settings;
        profiler_.trace.span(profiler_.trace.track("CPU: frames", 0), Kind::host_frame, "frame", frame_begin_ns_, now - frame_begin_ns_, frame_);
        if (settings.count_submits) profiler_.trace.counter("submits a frame", now, double(frame_submits_));
        if (settings.count_commands) profiler_.trace.counter("commands a frame", now, double(frame_commands_));
        if (settings.count_memory) profiler_.trace.counter("device memory (bytes)", now, double(memory_bytes_));
    }
    ++frame_;
    frame_submits_ = frame_commands_ = 0;
    frame_begin_ns_ = now;
}

}  // namespace myriad::profiler
