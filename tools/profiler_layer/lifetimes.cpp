// Command buffers from their allocation to their end, and memory.
#include "tools/profiler_layer/intercepts.hpp"

namespace myriad::profiler {
namespace {

VKAPI_ATTR VkResult VKAPI_CALL CreateCommandPool(VkDevice handle, const VkCommandPoolCreateInfo* info, const VkAllocationCallbacks* allocator,
                                                 VkCommandPool* pool) {
    Device& device = device_of(handle);
    const VkResult result = device.next.CreateCommandPool(handle, info, allocator, pool);
    if (result == VK_SUCCESS) device.add_pool(*pool, info->queueFamilyIndex);
    return result;
}

VKAPI_ATTR void VKAPI_CALL DestroyCommandPool(VkDevice handle, VkCommandPool pool, const VkAllocationCallbacks* allocator) {
    Device& device = device_of(handle);
    for (CommandBuffer* buffer : commands_in(pool, device)) {
        device.forget(*buffer);
        remove_commands(buffer->handle);
    }
    device.next.DestroyCommandPool(handle, pool, allocator);
}

VKAPI_ATTR VkResult VKAPI_CALL ResetCommandPool(VkDevice handle, VkCommandPool pool, VkCommandPoolResetFlags flags) {
    Device& device = device_of(handle);
    for (CommandBuffer* buffer : commands_in(pool, device)) device.forget(*buffer);
    return device.next.ResetCommandPool(handle, pool, flags);
}

VKAPI_ATTR VkResult VKAPI_CALL AllocateCommandBuffers(VkDevice handle, const VkCommandBufferAllocateInfo* info, VkCommandBuffer* buffers) {
    Device& device = device_of(handle);
    const VkResult result = device.next.AllocateCommandBuffers(handle, info, buffers);
    for (uint32_t i = 0; i < info->commandBufferCount && result == VK_SUCCESS; ++i) {
        CommandBuffer buffer;
        buffer.handle = buffers[i], buffer.device = &device, buffer.pool = info->commandPool;
        buffer.secondary = info->level == VK_COMMAND_BUFFER_LEVEL_SECONDARY;
        device.set_name(reinterpret_cast<uint64_t>(buffers[i]), "");  // a handle may come again
        add_commands(std::move(buffer));
    }
    return result;
}

VKAPI_ATTR void VKAPI_CALL FreeCommandBuffers(VkDevice handle, VkCommandPool pool, uint32_t count, const VkCommandBuffer* buffers) {
    Device& device = device_of(handle);
    for (uint32_t i = 0; i < count; ++i) {
        if (!buffers[i]) continue;
        device.forget(commands_of(buffers[i]));
        remove_commands(buffers[i]);
    }
    device.next.FreeCommandBuffers(handle, pool, count, buffers);
}

VKAPI_ATTR VkResult VKAPI_CALL BeginCommandBuffer(VkCommandBuffer commands, const VkCommandBufferBeginInfo* info) {
    CommandBuffer& buffer = commands_of(commands);
    buffer.device->begin(buffer, info->flags);
    buffer.pipelines = {};
    const VkResult result = buffer.device->next.BeginCommandBuffer(commands, info);
    if (result != VK_SUCCESS || !buffer.recording) return result;
    const std::string name = buffer.device->name_of(reinterpret_cast<uint64_t>(commands));
    buffer.recording->open(commands, Kind::commands, !name.empty() ? name : buffer.secondary ? "secondary command buffer" : "command buffer");
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL EndCommandBuffer(VkCommandBuffer commands) {
    CommandBuffer& buffer = commands_of(commands);
    if (buffer.recording) buffer.recording->close_all(commands);
    return buffer.device->next.EndCommandBuffer(commands);
}

VKAPI_ATTR VkResult VKAPI_CALL ResetCommandBuffer(VkCommandBuffer commands, VkCommandBufferResetFlags flags) {
    CommandBuffer& buffer = commands_of(commands);
    buffer.device->forget(buffer);
    return buffer.device->next.ResetCommandBuffer(commands, flags);
}

VKAPI_ATTR VkResult VKAPI_CALL AllocateMemory(VkDevice handle, const VkMemoryAllocateInfo* info, const VkAllocationCallbacks* allocator,
                                              VkDeviceMemory* memory) {
    Device& device = device_of(handle);
    const VkResult result = device.next.AllocateMemory(handle, info, allocator, memory);
    if (result == VK_SUCCESS) device.add_memory(*memory, info->allocationSize);
    return result;
}

VKAPI_ATTR void VKAPI_CALL FreeMemory(VkDevice handle, VkDeviceMemory memory, const VkAllocationCallbacks* allocator) {
    Device& device = device_of(handle);
    device.remove_memory(memory);
    device.next.FreeMemory(handle, memory, allocator);
}

}  // namespace

std::span<const Intercept> lifetime_intercepts() {
    static const Intercept all[] = {
        MYRIAD_INTERCEPT(CreateCommandPool), MYRIAD_INTERCEPT(DestroyCommandPool), MYRIAD_INTERCEPT(ResetCommandPool),
        MYRIAD_INTERCEPT(AllocateCommandBuffers), MYRIAD_INTERCEPT(FreeCommandBuffers), MYRIAD_INTERCEPT(BeginCommandBuffer),
        MYRIAD_INTERCEPT(EndCommandBuffer), MYRIAD_INTERCEPT(ResetCommandBuffer), MYRIAD_INTERCEPT(AllocateMemory),
        MYRIAD_INTERCEPT(FreeMemory),
    };
    return all;
}

}  // namespace myriad::profiler
