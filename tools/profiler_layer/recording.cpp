#include "tools/profiler_layer/recording.hpp"

#include <algorithm>
#include <chrono>
#include <ranges>

#include "tools/profiler_layer/device.hpp"

namespace myriad::profiler {

double now_ns() { return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

Recording::Recording(Device& device, bool timed, bool simultaneous) : device_(device), timed_(timed), simultaneous_(simultaneous) {}

Recording::~Recording() {
    for (const VkQueryPool chunk : chunks_) device_.chunks().give_back(chunk);
}

void Recording::add_chunk(VkCommandBuffer commands) {
    used_ = uint32_t(chunks_.size()) * QueryChunks::size;
    const VkQueryPool chunk = device_.chunks().take();
    if (!chunk) return;
    device_.next.CmdResetQueryPool(commands, chunk, 0, QueryChunks::size);
    chunks_.push_back(chunk);
}

uint32_t Recording::stamp(VkCommandBuffer commands) {
    if (!timed_ || (inside_ && !stamps_inside_)) return Stretch::no_stamp;
    if (used_ == chunks_.size() * QueryChunks::size && !inside_) add_chunk(commands);
    if (used_ == chunks_.size() * QueryChunks::size) {
        ++untimed;
        return Stretch::no_stamp;
    }
    device_.next.CmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, chunks_.back(), used_ % QueryChunks::size);
    return used_++;
}

void Recording::open(VkCommandBuffer commands, Kind kind, std::string name) {
    open_.push_back(stretches_.size());
    stretches_.push_back({kind, std::move(name), Stretch::no_stamp, Stretch::no_stamp, now_ns(), 0});
    stretches_.back().begin = stamp(commands);
}

void Recording::close(VkCommandBuffer commands, Kind kind) {
    const auto found = std::ranges::find_if(std::views::reverse(open_), [&](size_t i) { return stretches_[i].kind == kind; });
    if (found == open_.rend()) return;
    Stretch& stretch = stretches_[*found];
    if (stretch.begin != Stretch::no_stamp) stretch.end = stamp(commands);
    stretch.host_ns = now_ns() - stretch.host_begin_ns;
    open_.erase(std::next(found).base());
}

void Recording::close_all(VkCommandBuffer commands) {
    while (!open_.empty()) close(commands, stretches_[open_.back()].kind);
}

void Recording::enter_render_pass(VkCommandBuffer commands, bool stamps) {
    constexpr uint32_t some = QueryChunks::size / 2;
    if (timed_ && stamps && chunks_.size() * QueryChunks::size - used_ < some) add_chunk(commands);
    inside_ = true, stamps_inside_ = stamps;
}

std::map<uint32_t, uint64_t> Recording::read() const {
    struct Result {
        uint64_t ticks, available;
    };
    std::map<uint32_t, uint64_t> ticks;
    for (uint32_t chunk = 0; chunk < chunks_.size(); ++chunk) {
        const uint32_t first = chunk * QueryChunks::size, count = std::min(QueryChunks::size, used_ - first);
        std::vector<Result> results(count);
        if (count == 0) continue;
        device_.next.GetQueryPoolResults(device_.handle, chunks_[chunk], 0, count, count * sizeof(Result), results.data(), sizeof(Result),
                                         VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WITH_AVAILABILITY_BIT);
        for (uint32_t i = 0; i < count; ++i)
            if (results[i].available) ticks.emplace(first + i, results[i].ticks);
    }
    return ticks;
}

}  // namespace myriad::profiler
