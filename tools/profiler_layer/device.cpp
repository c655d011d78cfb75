#include "tools/profiler_layer/device.hpp"

#include <algorithm>
#include <utility>

#include "tools/profiler_layer/registry.hpp"

namespace myriad::profiler {

Device::Device(Profiler& profiler, VkDevice handle, const InstanceTable& instance, VkPhysicalDevice physical, PFN_vkGetDeviceProcAddr get,
               bool presents, bool calibrated)
    : handle(handle), profiler_(profiler),
      boundary_(profiler.settings.boundary != Boundary::automatic ? profiler.settings.boundary : presents ? Boundary::present : Boundary::submit),
      frame_begin_ns_(now_ns()) {
    next.load(handle, get);
    VkPhysicalDeviceProperties properties;
    instance.GetPhysicalDeviceProperties(physical, &properties);
    uint32_t count = 0;
    instance.GetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    instance.GetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    for (const VkQueueFamilyProperties& family : families)
        families_.push_back({family.timestampValidBits, (family.queueFlags & (VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT)) != 0});
    clock_.start(*this, properties.limits.timestampPeriod, calibrated && next.GetCalibratedTimestampsEXT);

    const std::lock_guard lock(profiler.mutex);
    title_ = "GPU " + std::to_string(++profiler.devices) + ": " + properties.deviceName;
    if (!clock_.calibrated())
        profiler.trace.note("no VK_EXT_calibrated_timestamps: where device times lie beside host times is a guess, to a submission");
}

void Device::add_queue(VkQueue handle, uint32_t family, uint32_t index) {
    const std::lock_guard lock(mutex_);
    if (queues_.contains(handle)) return;
    const std::lock_guard trace_lock(profiler_.mutex);
    const std::string name = title_ + ", queue " + std::to_string(family) + "." + std::to_string(index);
    const int order = 1000 * int(profiler_.devices) + 2 * int(queues_.size());
    const uint32_t frames = profiler_.trace.track(name + ": frames", order);
    queues_[handle] = {handle, family, profiler_.trace.track(name, order + 1), frames, 0};
    if (!families_[family].timestamp_bits || !families_[family].resets)
        profiler_.trace.note("a queue family without timestamps, or that cannot reset them: its work is not timed");
}

void Device::begin(CommandBuffer& buffer, VkCommandBufferUsageFlags flags) {
    forget(buffer);
    const std::lock_guard lock(mutex_);
    if (frame_ > profiler_.settings.last_frame) return;
    // Within a render pass that another command buffer began, queries cannot be reset, and a secondary one's must be.
    const bool within = buffer.secondary && (flags & VK_COMMAND_BUFFER_USAGE_RENDER_PASS_CONTINUE_BIT);
    const QueueFamily family = families_[pools_[buffer.pool]];
    buffer.recording = std::make_shared<Recording>(*this, family.timestamp_bits && family.resets && !within,
                                                   (flags & VK_COMMAND_BUFFER_USAGE_SIMULTANEOUS_USE_BIT) != 0);
    const std::lock_guard trace_lock(profiler_.mutex);
    buffer.recording->thread = profiler_.thread();
}

void Device::forget(CommandBuffer& buffer) {
    if (!buffer.recording) return;
    collect_if([&](const Submission& s) {
        return s.recording == buffer.recording || std::ranges::count(s.recording->secondaries, buffer.recording) > 0;
    });
    buffer.recording.reset();
}

// Whoever submits again without having said that submissions overlap knows that the earlier one is over.
void Device::before_submit(const std::vector<CommandBuffer*>& buffers) {
    for (const CommandBuffer* buffer : buffers) {
        if (!buffer->recording) continue;
        std::vector<std::shared_ptr<Recording>> all = buffer->recording->secondaries;
        all.push_back(buffer->recording);
        for (const auto& recording : all) {
            const auto has_it = [&](const Submission& s) {
                return s.recording == recording || std::ranges::count(s.recording->secondaries, recording) > 0;
            };
            if (!recording->simultaneous()) {
                collect_if(has_it);
                continue;
            }
            const std::lock_guard lock(mutex_);
            for (const Submission& s : under_way_)
                if (has_it(s)) --frames_[{s.queue, s.frame}].under_way;
            if (const size_t lost = std::erase_if(under_way_, has_it)) {
                const std::lock_guard trace_lock(profiler_.mutex);
                profiler_.trace.note("submissions of a command buffer that was under way already: the earlier one's times are lost", lost);
            }
        }
    }
}

void Device::after_submit(VkQueue handle, const std::vector<CommandBuffer*>& buffers, VkFence fence, double begin_ns, const char* call) {
    const std::lock_guard lock(mutex_);
    Queue& queue = queues_[handle];
    const double now = now_ns();
    {
        const std::lock_guard trace_lock(profiler_.mutex);
        const uint32_t host_track = profiler_.thread();
        for (const CommandBuffer* buffer : buffers) {
            if (!buffer->recording) continue;
            if (boundary(Boundary::label) && buffer->recording->starts_frame && std::exchange(label_seen_, true)) next_frame(begin_ns);
            if (!profiler_.settings.covers(frame_)) continue;
            frame_commands_ += buffer->recording->commands;
            for (const auto& secondary : buffer->recording->secondaries) frame_commands_ += secondary->commands;
            tell_recording(*buffer->recording, frame_);
            under_way_.push_back({buffer->recording, handle, queue.submitted + 1, frame_, begin_ns, host_track});
            ++frames_[{handle, frame_}].under_way;
        }
        ++queue.submitted;
        if (profiler_.settings.covers(frame_)) {
            ++frame_submits_;
            profiler_.trace.span(host_track, Kind::submission, call, begin_ns, now - begin_ns, frame_);
            profiler_.changed = true;
        }
        if (boundary(Boundary::submit) && !buffers.empty()) next_frame(now);
    }
    if (fence) fences_[fence] = {handle, queue.submitted};
}

void Device::presented(double begin_ns, const char* call) {
    const std::lock_guard lock(mutex_);
    const std::lock_guard trace_lock(profiler_.mutex);
    const double now = now_ns();
    if (profiler_.settings.covers(frame_)) profiler_.trace.span(profiler_.thread(), Kind::submission, call, begin_ns, now - begin_ns, frame_);
    if (boundary(Boundary::present)) next_frame(now);
}

void Device::fence_is_over(VkFence fence) {
    std::pair<VkQueue, uint64_t> last;
    {
        const std::lock_guard lock(mutex_);
        const auto found = fences_.find(fence);
        if (found == fences_.end()) return;
        last = found->second;
        fences_.erase(found);
    }
    collect_if([&](const Submission& s) { return s.queue == last.first && s.number <= last.second; });
}

void Device::queue_is_idle(VkQueue queue) {
    collect_if([&](const Submission& s) { return s.queue == queue; });
}

void Device::all_idle() {
    collect_if([](const Submission&) { return true; });
}

void Device::destroy() {
    all_idle();
    {
        const std::lock_guard lock(mutex_);
        const std::lock_guard trace_lock(profiler_.mutex);
        if (frame_submits_) next_frame(now_ns());  // what came after the last boundary
        tell_frames();
    }
    chunks_.destroy();
}

void Device::set_name(uint64_t object, const std::string& name) {
    const std::lock_guard lock(mutex_);
    names_[object] = name;
}

std::string Device::name_of(uint64_t object) const {
    const std::lock_guard lock(mutex_);
    const auto found = names_.find(object);
    return found == names_.end() ? "" : found->second;
}

void Device::add_pool(VkCommandPool pool, uint32_t family) {
    const std::lock_guard lock(mutex_);
    pools_[pool] = family;
}

void Device::add_memory(VkDeviceMemory memory, uint64_t bytes) {
    const std::lock_guard lock(mutex_);
    memory_[memory] = bytes;
    memory_bytes_ += bytes;
}

void Device::remove_memory(VkDeviceMemory memory) {
    const std::lock_guard lock(mutex_);
    const auto found = memory_.find(memory);
    if (found == memory_.end()) return;
    memory_bytes_ -= found->second;
    memory_.erase(found);
}

void Device::add_multiview(VkRenderPass pass) {
    const std::lock_guard lock(mutex_);
    multiview_.insert(pass);
}

bool Device::multiview(VkRenderPass pass) const {
    const std::lock_guard lock(mutex_);
    return multiview_.contains(pass);
}

void Device::remove_render_pass(VkRenderPass pass) {
    const std::lock_guard lock(mutex_);
    multiview_.erase(pass);
}

}  // namespace myriad::profiler
