// What the layer knows of the process: its settings, its trace, and whose a handle is.
#pragma once

#include <mutex>

#include "tools/profiler_layer/device.hpp"

namespace myriad::profiler {

// One a process. Devices add to the trace as they learn of times; the file is written when a device ends, when the last frame asked
// for is over, and when the process ends otherwise.
struct Profiler {
    Profiler();
    ~Profiler();
    void write();        // if there is anything new; the mutex is not held by the caller
    uint32_t thread();   // the track of the calling thread; the mutex is held
    void say(const std::string& sentence) const;

    Settings settings;
    std::mutex mutex;    // of what follows
    Trace trace;
    bool changed = false;
    uint32_t threads = 0, devices = 0;
};
Profiler& profiler();

struct Instance {
    VkInstance handle = VK_NULL_HANDLE;
    InstanceTable next;
};

// By the loader's key, which all dispatchable handles of one instance or device begin with.
void add_instance(std::unique_ptr<Instance> instance);
Instance& instance_of(const void* dispatchable);
void remove_instance(VkInstance instance);
Device& add_device(std::unique_ptr<Device> device);
Device& device_of(const void* dispatchable);
void remove_device(VkDevice device);

void add_commands(CommandBuffer buffer);
CommandBuffer& commands_of(VkCommandBuffer handle);
void remove_commands(VkCommandBuffer handle);
std::vector<CommandBuffer*> commands_in(VkCommandPool pool, const Device& device);

}  // namespace myriad::profiler
