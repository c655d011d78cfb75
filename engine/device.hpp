// One Vulkan 1.3 device with one compute queue: picked by capability, every limit queried, nothing assumed.
#pragma once

#include <chrono>
#include <cstdint>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <vulkan/vulkan.h>

#include "engine/error.hpp"

namespace myriad::engine {

// What `myriad info` prints: one entry a physical device.
struct DeviceInfo {
    std::string name, driver, driver_version, type;  // type: discrete, integrated, virtual, cpu, other
    uint32_t api_major = 0, api_minor = 0, api_patch = 0;
    uint64_t heap_bytes = 0;               // the largest device-local heap
    std::vector<std::string> used;         // features that Myriad uses here
    std::vector<std::string> missing;      // required features that are absent: the device cannot be used
    std::vector<std::string> degraded;     // optional features that are absent, and what happens instead
    std::map<std::string, uint64_t> limits;
    bool common_clock = false;             // device and host times can be told on one
    bool usable() const { return missing.empty(); }
};

struct DeviceOptions {
    std::string select;              // part of a name, or an index in decimal; empty: the fastest kind that is usable
    bool validation = false;         // Khronos layer with synchronization validation; MYRIAD_VALIDATION=1 does the same
    uint64_t memory_limit = 0;       // bytes for buffers, 0: what the largest device-local heap has
    std::vector<std::string> surfaces{};  // instance extensions that windows need (Window::extensions()); empty: none, nothing is ever shown
};

// Bytes by kind of buffer ("lists", "atlas", "scene" …): now, and the most at any one time.
struct MemoryUse {
    uint64_t now = 0, peak = 0;
};

// A compute pipeline and what reflection says of its kernel; see program.hpp.
struct Pipeline {
    std::string name;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkPipeline pipeline = VK_NULL_HANDLE;
    uint32_t workgroup_size = 0, push_constant_bytes = 0;
};

// What a recorder records into, waits for and measures with.
struct CommandSet {
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
    VkQueryPool queries = VK_NULL_HANDLE;  // none where the queue has no timestamps
};

class Device {
public:
    // Throws DeviceError in one sentence when there is no loader, no device, or none that is sufficient.
    explicit Device(const DeviceOptions& options = {});
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    // All physical devices, usable or not. Empty where there is no Vulkan loader or driver.
    static std::vector<DeviceInfo> enumerate();

    const DeviceInfo& info() const { return info_; }
    VkInstance instance() const { return instance_; }
    VkPhysicalDevice physical() const { return physical_; }
    VkDevice handle() const { return device_; }
    VkQueue queue() const { return queue_; }
    uint32_t queue_family() const { return queue_family_; }

    bool plain_groups() const { return plain_groups_; }       // see engine/group.glsl
    uint32_t group_size() const { return plain_groups_ ? 1 : subgroup_size_; }
    double timestamp_period_ns() const { return timestamp_period_ns_; }  // 0: the queue has no timestamps
    // The most loop iterations one invocation may make in all its loops: Mesa before 23 ends loops silently after 65,535.
    uint32_t loop_limit() const { return loop_limit_; }

    // The device's clock beside the host's, by VK_EXT_calibrated_timestamps: one moment on both. None where the device has not got it.
    struct Moment {
        uint64_t ticks = 0;
        std::chrono::steady_clock::time_point host;
    };
    std::optional<Moment> now() const;

    // Memory accounting, called by Buffer. `reserve` throws OutOfMemory naming the buffer, the limit and the cure.
    void reserve(const std::string& kind, const std::string& name, uint64_t bytes);
    void release(const std::string& kind, uint64_t bytes);
    uint64_t memory_limit() const { return memory_limit_; }
    uint64_t memory_free() const { return memory_limit_ > memory_now_ ? memory_limit_ - memory_now_ : 0; }
    const std::map<std::string, MemoryUse>& memory() const { return memory_; }
    void reset_memory_peaks();

    uint32_t memory_type(uint32_t allowed, VkMemoryPropertyFlags wanted) const;  // throws DeviceError
    void set_name(VkObjectType type, uint64_t object, const std::string& name) const;
    void begin_label(VkCommandBuffer commands, const char* name) const;
    void end_label(VkCommandBuffer commands) const;

    // How many messages the validation layer has sent; each is also printed to stderr.
    uint32_t validation_messages() const;
    bool validation_active() const { return validation_active_; }

    // The pipelines asked for so far, by name and constants, made or in the making; they live as long as the device.
    std::map<std::string, std::shared_future<Pipeline>>& pipelines() { return pipelines_; }

    // Recorders come and go, one a download; what they record into stays. Khronos' layer 1.3.239 (Debian 12) also needs that: it forgets a command
    // buffer's labels on a thread of its own, unlocked, and a new one with the same handle is recorded beside that (Vulkan-ValidationLayers
    // #5172, mended in #5312): a heap corrupted once in a few thousand recorders.
    std::vector<CommandSet>& idle_commands() { return idle_commands_; }

private:
    struct Callbacks;
    std::unique_ptr<Callbacks> callbacks_;
    VkInstance instance_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    VkPhysicalDeviceMemoryProperties memory_properties_{};
    DeviceInfo info_;
    uint32_t queue_family_ = 0, subgroup_size_ = 1, loop_limit_ = ~0u;
    bool plain_groups_ = false, validation_active_ = false;
    double timestamp_period_ns_ = 0;
    uint64_t memory_limit_ = 0, memory_now_ = 0;
    std::map<std::string, MemoryUse> memory_;
    std::vector<CommandSet> idle_commands_;
    std::map<std::string, std::shared_future<Pipeline>> pipelines_;
};

// Throws DeviceError "WHAT failed (VK_…)", or OutOfMemory, when a Vulkan call did not succeed.
void check(VkResult result, const char* what);

}  // namespace myriad::engine
