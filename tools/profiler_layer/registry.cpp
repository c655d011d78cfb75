#include "tools/profiler_layer/registry.hpp"

#include <cstdio>
#include <utility>
#include <shared_mutex>

namespace myriad::profiler {
namespace {

std::shared_mutex registry_mutex;
std::unordered_map<const void*, std::unique_ptr<Instance>> instances;
std::unordered_map<const void*, std::unique_ptr<Device>> devices;
std::unordered_map<VkCommandBuffer, std::unique_ptr<CommandBuffer>> command_buffers;

const void* key(const void* dispatchable) { return *static_cast<const void* const*>(dispatchable); }

}  // namespace

Profiler::Profiler() {
    const LoadedSettings loaded = load_settings();
    settings = loaded.settings;
    for (const std::string& problem : loaded.problems) say(problem);
}

Profiler::~Profiler() { write(); }

void Profiler::say(const std::string& sentence) const { std::fprintf(stderr, "VK_LAYER_MYRIAD_profiler: %s\n", sentence.c_str()); }

void Profiler::write() {
    const std::lock_guard lock(mutex);
    if (!std::exchange(changed, false)) return;
    for (const auto& [path, text] : {std::pair(settings.output, trace.json()), std::pair(settings.summary(), trace.csv())})
        if (const std::string problem = write_whole(path, text); !problem.empty()) say(problem);
}

uint32_t Profiler::thread() {
    thread_local uint32_t number = 0;
    if (!number) number = ++threads;
    return trace.track("CPU: thread " + std::to_string(number), int(number));
}

// Made when the first instance is, and ended with the process.
Profiler& profiler() {
    static Profiler one;
    return one;
}

void add_instance(std::unique_ptr<Instance> instance) {
    const std::unique_lock lock(registry_mutex);
    const void* at = key(instance->handle);
    instances[at] = std::move(instance);
}

Instance& instance_of(const void* dispatchable) {
    const std::shared_lock lock(registry_mutex);
    return *instances.at(key(dispatchable));
}

void remove_instance(VkInstance instance) {
    const std::unique_lock lock(registry_mutex);
    instances.erase(key(instance));
}

Device& add_device(std::unique_ptr<Device> device) {
    const std::unique_lock lock(registry_mutex);
    const void* at = key(device->handle);
    return *(devices[at] = std::move(device));
}

Device& device_of(const void* dispatchable) {
    const std::shared_lock lock(registry_mutex);
    return *devices.at(key(dispatchable));
}

// With its command buffers, which end with it.
void remove_device(VkDevice device) {
    const std::unique_lock lock(registry_mutex);
    const auto ended = devices.find(key(device));
    std::erase_if(command_buffers, [&](const auto& entry) { return entry.second->device == ended->second.get(); });
    devices.erase(ended);
}

void add_commands(CommandBuffer buffer) {
    const std::unique_lock lock(registry_mutex);
    const VkCommandBuffer handle = buffer.handle;
    command_buffers[handle] = std::make_unique<CommandBuffer>(std::move(buffer));
}

CommandBuffer& commands_of(VkCommandBuffer handle) {
    const std::shared_lock lock(registry_mutex);
    return *command_buffers.at(handle);
}

void remove_commands(VkCommandBuffer handle) {
    const std::unique_lock lock(registry_mutex);
    command_buffers.erase(handle);
}

std::vector<CommandBuffer*> commands_in(VkCommandPool pool, const Device& device) {
    const std::shared_lock lock(registry_mutex);
    std::vector<CommandBuffer*> found;
    for (const auto& [handle, buffer] : command_buffers)
        if (buffer->pool == pool && buffer->device == &device) found.push_back(buffer.get());
    return found;
}

}  // namespace myriad::profiler
