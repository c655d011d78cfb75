// The functions of the next layer down, or of the driver: one table an instance, one a device. A function that is not there is null.
#pragma once

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#include <string>

namespace myriad::profiler {

#define MYRIAD_INSTANCE_FUNCTIONS(X)                                                                                     \
    X(DestroyInstance) X(EnumerateDeviceExtensionProperties) X(GetPhysicalDeviceProperties)                              \
    X(GetPhysicalDeviceQueueFamilyProperties) X(GetPhysicalDeviceCalibrateableTimeDomainsEXT)

#define MYRIAD_DEVICE_FUNCTIONS(X)                                                                                       \
    X(DestroyDevice) X(DeviceWaitIdle) X(GetDeviceQueue) X(GetDeviceQueue2)                                              \
    X(QueueSubmit) X(QueueSubmit2) X(QueueWaitIdle) X(QueuePresentKHR)                                                   \
    X(WaitForFences) X(GetFenceStatus) X(ResetFences) X(DestroyFence)                                                    \
    X(CreateCommandPool) X(DestroyCommandPool) X(ResetCommandPool)                                                       \
    X(AllocateCommandBuffers) X(FreeCommandBuffers) X(BeginCommandBuffer) X(EndCommandBuffer) X(ResetCommandBuffer)      \
    X(CreateQueryPool) X(DestroyQueryPool) X(GetQueryPoolResults) X(CmdResetQueryPool) X(CmdWriteTimestamp)              \
    X(GetCalibratedTimestampsEXT) X(SetDebugUtilsObjectNameEXT)                                                          \
    X(CmdBeginDebugUtilsLabelEXT) X(CmdEndDebugUtilsLabelEXT)                                                            \
    X(CreateRenderPass) X(CreateRenderPass2) X(DestroyRenderPass)                                                        \
    X(CmdBeginRenderPass) X(CmdBeginRenderPass2) X(CmdNextSubpass) X(CmdNextSubpass2) X(CmdEndRenderPass)                \
    X(CmdEndRenderPass2) X(CmdBeginRendering) X(CmdEndRendering) X(CmdExecuteCommands) X(CmdBindPipeline)                \
    X(CmdDispatch) X(CmdDispatchIndirect) X(CmdDispatchBase) X(CmdTraceRaysKHR) X(CmdBuildAccelerationStructuresKHR)     \
    X(CmdDraw) X(CmdDrawIndexed) X(CmdDrawIndirect) X(CmdDrawIndexedIndirect) X(CmdDrawIndirectCount)                    \
    X(CmdDrawIndexedIndirectCount) X(CmdDrawMeshTasksEXT) X(CmdDrawMeshTasksIndirectEXT)                                 \
    X(CmdCopyBuffer) X(CmdCopyBuffer2) X(CmdFillBuffer) X(CmdUpdateBuffer) X(CmdCopyImage) X(CmdCopyImage2)              \
    X(CmdBlitImage) X(CmdBlitImage2) X(CmdCopyBufferToImage) X(CmdCopyBufferToImage2) X(CmdCopyImageToBuffer)            \
    X(CmdCopyImageToBuffer2) X(CmdResolveImage) X(CmdResolveImage2) X(CmdClearColorImage) X(CmdClearDepthStencilImage)   \
    X(AllocateMemory) X(FreeMemory)

struct InstanceTable {
    PFN_vkGetInstanceProcAddr get = nullptr;
#define X(name) PFN_vk##name name = nullptr;
    MYRIAD_INSTANCE_FUNCTIONS(X)
#undef X

    void load(VkInstance instance, PFN_vkGetInstanceProcAddr next) {
        get = next;
#define X(name) name = reinterpret_cast<PFN_vk##name>(next(instance, "vk" #name));
        MYRIAD_INSTANCE_FUNCTIONS(X)
#undef X
    }
};

struct DeviceTable {
    PFN_vkGetDeviceProcAddr get = nullptr;
#define X(name) PFN_vk##name name = nullptr;
    MYRIAD_DEVICE_FUNCTIONS(X)
#undef X

    // What became core is found under its older name on older devices.
    void load(VkDevice device, PFN_vkGetDeviceProcAddr next) {
        get = next;
        const auto find = [&](const std::string& name) {
            const PFN_vkVoidFunction core = next(device, name.c_str());
            return core ? core : next(device, (name + "KHR").c_str());
        };
#define X(name) name = reinterpret_cast<PFN_vk##name>(find("vk" #name));
        MYRIAD_DEVICE_FUNCTIONS(X)
#undef X
    }
};

}  // namespace myriad::profiler
