// One device of the program, and what was submitted to it.
//
// The layer never waits for a device. A submission's times are read when the program itself has proof that it is over: it waited for
// a fence or for a queue, it records or submits the command buffer again, or it destroys something that must be idle.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "tools/profiler_layer/recording.hpp"
#include "tools/profiler_layer/settings.hpp"

namespace myriad::profiler {

struct Profiler;

// Query pools of one size, used again and again.
class QueryChunks {
public:
    static constexpr uint32_t size = 128;
    explicit QueryChunks(const Device& device) : device_(device) {}
    VkQueryPool take();  // null where the device is out of memory
    void give_back(VkQueryPool chunk);
    void destroy();

private:
    const Device& device_;
    std::mutex mutex_;
    std::vector<VkQueryPool> all_, idle_;
};

// From a device's ticks to the host's clock.
class Clock {
public:
    void start(const Device& device, double period_ns, bool calibrated);
    // Ticks of something that was submitted at `submitted_ns`; both clocks are read anew once a second.
    double host_ns(uint64_t ticks, uint32_t valid_bits, double submitted_ns);
    bool calibrated() const { return calibrated_; }

private:
    void read_both();
    const Device* device_ = nullptr;
    double period_ns_ = 1;
    bool calibrated_ = false, placed_ = false;
    uint64_t ticks_ = 0;    // at one moment …
    double at_ns_ = 0;      // … of the host
};

struct QueueFamily {
    uint32_t timestamp_bits = 0;
    bool resets = false;  // queries can be reset in its command buffers
};

struct Queue {
    VkQueue handle = VK_NULL_HANDLE;
    uint32_t family = 0;
    uint32_t track = 0, frame_track = 0;
    uint64_t submitted = 0;  // the last submission's number
};

class Device {
public:
    Device(Profiler& profiler, VkDevice handle, const InstanceTable& instance, VkPhysicalDevice physical, PFN_vkGetDeviceProcAddr next,
           bool presents, bool calibrated);

    // Every entry point that ends or begins one of these tells so.
    void add_queue(VkQueue handle, uint32_t family, uint32_t index);
    void begin(CommandBuffer& buffer, VkCommandBufferUsageFlags flags);
    void forget(CommandBuffer& buffer);  // begun again, reset or freed: whatever was submitted of it is over
    void before_submit(const std::vector<CommandBuffer*>& buffers);
    void after_submit(VkQueue queue, const std::vector<CommandBuffer*>& buffers, VkFence fence, double begin_ns, const char* call);
    void presented(double begin_ns, const char* call);
    void fence_is_over(VkFence fence);
    void queue_is_idle(VkQueue queue);
    void all_idle();
    void destroy();                      // what the layer made of this device

    void set_name(uint64_t object, const std::string& name);
    std::string name_of(uint64_t object) const;  // empty: it has none
    void add_pool(VkCommandPool pool, uint32_t family);
    void add_memory(VkDeviceMemory memory, uint64_t bytes);
    void remove_memory(VkDeviceMemory memory);
    void add_multiview(VkRenderPass pass);
    bool multiview(VkRenderPass pass) const;
    void remove_render_pass(VkRenderPass pass);

    QueryChunks& chunks() { return chunks_; }
    Profiler& profiler() const { return profiler_; }

    DeviceTable next;
    const VkDevice handle;

private:
    struct Submission {
        std::shared_ptr<Recording> recording;
        VkQueue queue;
        uint64_t number, frame;
        double submitted_ns;
        uint32_t host_track;
    };
    struct Frame {                       // on one queue
        uint32_t under_way = 0;
        double begin_ns = 0, end_ns = 0;  // equal: nothing yet
    };
    void collect_if(const std::function<bool(const Submission&)>& over);
    void collect(const Submission& submission);
    void collect_times(const Submission& submission, const Recording& recording, bool primary);
    // With both mutexes held:
    void tell_recording(Recording& recording, uint64_t frame);
    void tell_frames();  // those that have ended, here and on the device
    void next_frame(double now);
    bool boundary(Boundary which) const { return boundary_ == which; }

    Profiler& profiler_;
    const Boundary boundary_;
    std::string title_;
    std::vector<QueueFamily> families_;
    QueryChunks chunks_{*this};

    mutable std::mutex mutex_;           // of all below
    Clock clock_;
    std::unordered_map<VkQueue, Queue> queues_;
    std::deque<Submission> under_way_;
    std::unordered_map<VkFence, std::pair<VkQueue, uint64_t>> fences_;
    std::unordered_map<VkCommandPool, uint32_t> pools_;  // the family
    std::map<std::pair<VkQueue, uint64_t>, Frame> frames_;
    uint64_t frame_ = 0;
    bool label_seen_ = false;
    double frame_begin_ns_;
    uint64_t frame_submits_ = 0, frame_commands_ = 0, memory_bytes_ = 0;
    std::unordered_map<VkDeviceMemory, uint64_t> memory_;
    std::unordered_map<uint64_t, std::string> names_;
    std::set<VkRenderPass> multiview_;
};

}  // namespace myriad::profiler
