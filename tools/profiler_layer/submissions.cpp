// Queues and fences: what is submitted, and how the program learns that it is over.
#include "tools/profiler_layer/intercepts.hpp"

namespace myriad::profiler {
namespace {

VKAPI_ATTR void VKAPI_CALL GetDeviceQueue(VkDevice handle, uint32_t family, uint32_t index, VkQueue* queue) {
    Device& device = device_of(handle);
    device.next.GetDeviceQueue(handle, family, index, queue);
    if (*queue) device.add_queue(*queue, family, index);
}

VKAPI_ATTR void VKAPI_CALL GetDeviceQueue2(VkDevice handle, const VkDeviceQueueInfo2* info, VkQueue* queue) {
    Device& device = device_of(handle);
    device.next.GetDeviceQueue2(handle, info, queue);
    if (*queue) device.add_queue(*queue, info->queueFamilyIndex, info->queueIndex);
}

template <class Submit>
VkResult submit(VkQueue queue, const std::vector<CommandBuffer*>& buffers, VkFence fence, const char* call, Submit next) {
    Device& device = device_of(queue);
    device.before_submit(buffers);
    const double begin = now_ns();
    const VkResult result = next(device.next);
    if (result == VK_SUCCESS) device.after_submit(queue, buffers, fence, begin, call);
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL QueueSubmit(VkQueue queue, uint32_t count, const VkSubmitInfo* submits, VkFence fence) {
    std::vector<CommandBuffer*> buffers;
    for (uint32_t i = 0; i < count; ++i)
        for (uint32_t k = 0; k < submits[i].commandBufferCount; ++k) buffers.push_back(&commands_of(submits[i].pCommandBuffers[k]));
    return submit(queue, buffers, fence, "vkQueueSubmit", [&](const DeviceTable& next) { return next.QueueSubmit(queue, count, submits, fence); });
}

VKAPI_ATTR VkResult VKAPI_CALL QueueSubmit2(VkQueue queue, uint32_t count, const VkSubmitInfo2* submits, VkFence fence) {
    std::vector<CommandBuffer*> buffers;
    for (uint32_t i = 0; i < count; ++i)
        for (uint32_t k = 0; k < submits[i].commandBufferInfoCount; ++k) buffers.push_back(&commands_of(submits[i].pCommandBufferInfos[k].commandBuffer));
    return submit(queue, buffers, fence, "vkQueueSubmit2", [&](const DeviceTable& next) { return next.QueueSubmit2(queue, count, submits, fence); });
}

VKAPI_ATTR VkResult VKAPI_CALL QueuePresentKHR(VkQueue queue, const VkPresentInfoKHR* info) {
    Device& device = device_of(queue);
    const double begin = now_ns();
    const VkResult result = device.next.QueuePresentKHR(queue, info);
    device.presented(begin, "vkQueuePresentKHR");
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL QueueWaitIdle(VkQueue queue) {
    Device& device = device_of(queue);
    const VkResult result = device.next.QueueWaitIdle(queue);
    if (result == VK_SUCCESS) device.queue_is_idle(queue);
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL DeviceWaitIdle(VkDevice handle) {
    Device& device = device_of(handle);
    const VkResult result = device.next.DeviceWaitIdle(handle);
    if (result == VK_SUCCESS) device.all_idle();
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL WaitForFences(VkDevice handle, uint32_t count, const VkFence* fences, VkBool32 all, uint64_t timeout) {
    Device& device = device_of(handle);
    const VkResult result = device.next.WaitForFences(handle, count, fences, all, timeout);
    for (uint32_t i = 0; i < count && result == VK_SUCCESS; ++i)
        if (all || count == 1 || device.next.GetFenceStatus(handle, fences[i]) == VK_SUCCESS) device.fence_is_over(fences[i]);
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL GetFenceStatus(VkDevice handle, VkFence fence) {
    Device& device = device_of(handle);
    const VkResult result = device.next.GetFenceStatus(handle, fence);
    if (result == VK_SUCCESS) device.fence_is_over(fence);
    return result;
}

// Neither may be done to a fence that work still waits to signal.
VKAPI_ATTR VkResult VKAPI_CALL ResetFences(VkDevice handle, uint32_t count, const VkFence* fences) {
    Device& device = device_of(handle);
    for (uint32_t i = 0; i < count; ++i) device.fence_is_over(fences[i]);
    return device.next.ResetFences(handle, count, fences);
}

VKAPI_ATTR void VKAPI_CALL DestroyFence(VkDevice handle, VkFence fence, const VkAllocationCallbacks* allocator) {
    Device& device = device_of(handle);
    device.fence_is_over(fence);
    device.next.DestroyFence(handle, fence, allocator);
}

}  // namespace

std::span<const Intercept> submission_intercepts() {
    static const Intercept all[] = {
        MYRIAD_INTERCEPT(GetDeviceQueue), MYRIAD_INTERCEPT(GetDeviceQueue2), MYRIAD_INTERCEPT(QueueSubmit), MYRIAD_INTERCEPT_KHR(QueueSubmit2),
        MYRIAD_INTERCEPT(QueuePresentKHR), MYRIAD_INTERCEPT(QueueWaitIdle), MYRIAD_INTERCEPT(DeviceWaitIdle), MYRIAD_INTERCEPT(WaitForFences),
        MYRIAD_INTERCEPT(GetFenceStatus), MYRIAD_INTERCEPT(ResetFences), MYRIAD_INTERCEPT(DestroyFence),
    };
    return all;
}

}  // namespace myriad::profiler
