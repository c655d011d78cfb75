// Labelled regions, render passes, and the names that the program gives.
#include "tools/profiler_layer/intercepts.hpp"

namespace myriad::profiler {
namespace {

bool fine(const CommandBuffer& buffer) { return buffer.device->profiler().settings.granularity != Granularity::frame; }

// Drivers need not know labels: then nothing is below.
VKAPI_ATTR void VKAPI_CALL CmdBeginDebugUtilsLabelEXT(VkCommandBuffer commands, const VkDebugUtilsLabelEXT* label) {
    CommandBuffer& buffer = commands_of(commands);
    const Settings& settings = buffer.device->profiler().settings;
    if (buffer.device->next.CmdBeginDebugUtilsLabelEXT) buffer.device->next.CmdBeginDebugUtilsLabelEXT(commands, label);
    if (!buffer.recording) return;
    if (settings.boundary == Boundary::label && settings.frame_label == label->pLabelName) buffer.recording->starts_frame = true;
    if (fine(buffer)) buffer.recording->open(commands, Kind::region, label->pLabelName);
}

VKAPI_ATTR void VKAPI_CALL CmdEndDebugUtilsLabelEXT(VkCommandBuffer commands) {
    CommandBuffer& buffer = commands_of(commands);
    if (buffer.recording && fine(buffer)) buffer.recording->close(commands, Kind::region);
    if (buffer.device->next.CmdEndDebugUtilsLabelEXT) buffer.device->next.CmdEndDebugUtilsLabelEXT(commands);
}

VKAPI_ATTR VkResult VKAPI_CALL SetDebugUtilsObjectNameEXT(VkDevice handle, const VkDebugUtilsObjectNameInfoEXT* info) {
    Device& device = device_of(handle);
    if (info->objectType == VK_OBJECT_TYPE_PIPELINE || info->objectType == VK_OBJECT_TYPE_COMMAND_BUFFER)
        device.set_name(info->objectHandle, info->pObjectName ? info->pObjectName : "");
    return device.next.SetDebugUtilsObjectNameEXT ? device.next.SetDebugUtilsObjectNameEXT(handle, info) : VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL CmdBindPipeline(VkCommandBuffer commands, VkPipelineBindPoint point, VkPipeline pipeline) {
    CommandBuffer& buffer = commands_of(commands);
    const size_t index = point == VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR ? 2 : size_t(point);
    if (index < buffer.pipelines.size()) buffer.pipelines[index] = pipeline;
    buffer.device->next.CmdBindPipeline(commands, point, pipeline);
}

// With several views, a timestamp in a render pass takes several queries: those passes are timed as a whole.
VKAPI_ATTR VkResult VKAPI_CALL CreateRenderPass(VkDevice handle, const VkRenderPassCreateInfo* info, const VkAllocationCallbacks* allocator,
                                                VkRenderPass* pass) {
    Device& device = device_of(handle);
    const VkResult result = device.next.CreateRenderPass(handle, info, allocator, pass);
    for (auto* at = static_cast<const VkBaseInStructure*>(info->pNext); at && result == VK_SUCCESS; at = at->pNext)
        if (at->sType == VK_STRUCTURE_TYPE_RENDER_PASS_MULTIVIEW_CREATE_INFO) device.add_multiview(*pass);
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL CreateRenderPass2(VkDevice handle, const VkRenderPassCreateInfo2* info, const VkAllocationCallbacks* allocator,
                                                 VkRenderPass* pass) {
    Device& device = device_of(handle);
    const VkResult result = device.next.CreateRenderPass2(handle, info, allocator, pass);
    for (uint32_t i = 0; i < info->subpassCount && result == VK_SUCCESS; ++i)
        if (info->pSubpasses[i].viewMask) device.add_multiview(*pass);
    return result;
}

VKAPI_ATTR void VKAPI_CALL DestroyRenderPass(VkDevice handle, VkRenderPass pass, const VkAllocationCallbacks* allocator) {
    Device& device = device_of(handle);
    device.remove_render_pass(pass);
    device.next.DestroyRenderPass(handle, pass, allocator);
}

// `stamps`: commands other than vkCmdExecuteCommands may be recorded in it.
template <class Begin>
void begin_pass(VkCommandBuffer commands, const char* name, bool timed, bool stamps, Begin begin) {
    CommandBuffer& buffer = commands_of(commands);
    buffer.passes_timed = timed && fine(buffer);
    if (buffer.recording && buffer.passes_timed) buffer.recording->open(commands, Kind::render_pass, name);
    if (buffer.recording) buffer.recording->enter_render_pass(commands, stamps);
    begin(buffer.device->next);
}

template <class End>
void end_pass(VkCommandBuffer commands, End end) {
    CommandBuffer& buffer = commands_of(commands);
    end(buffer.device->next);
    if (!buffer.recording) return;
    buffer.recording->leave_render_pass();
    if (buffer.passes_timed) buffer.recording->close(commands, Kind::render_pass);
}

VKAPI_ATTR void VKAPI_CALL CmdBeginRenderPass(VkCommandBuffer commands, const VkRenderPassBeginInfo* info, VkSubpassContents contents) {
    const bool stamps = contents == VK_SUBPASS_CONTENTS_INLINE && !commands_of(commands).device->multiview(info->renderPass);
    begin_pass(commands, "render pass", true, stamps, [&](const DeviceTable& next) { next.CmdBeginRenderPass(commands, info, contents); });
}

VKAPI_ATTR void VKAPI_CALL CmdBeginRenderPass2(VkCommandBuffer commands, const VkRenderPassBeginInfo* info, const VkSubpassBeginInfo* begin) {
    const bool stamps = begin->contents == VK_SUBPASS_CONTENTS_INLINE && !commands_of(commands).device->multiview(info->renderPass);
    begin_pass(commands, "render pass", true, stamps, [&](const DeviceTable& next) { next.CmdBeginRenderPass2(commands, info, begin); });
}

// Nothing may be recorded between the parts of a pass that is suspended and resumed: such ones are not told apart.
VKAPI_ATTR void VKAPI_CALL CmdBeginRendering(VkCommandBuffer commands, const VkRenderingInfo* info) {
    const bool whole = !(info->flags & (VK_RENDERING_SUSPENDING_BIT | VK_RENDERING_RESUMING_BIT));
    const bool stamps = whole && !(info->flags & VK_RENDERING_CONTENTS_SECONDARY_COMMAND_BUFFERS_BIT) && !info->viewMask;
    begin_pass(commands, "render pass", whole, stamps, [&](const DeviceTable& next) { next.CmdBeginRendering(commands, info); });
}

// A later subpass is timed no further inside: it may be of several views, or of secondary command buffers.
VKAPI_ATTR void VKAPI_CALL CmdNextSubpass(VkCommandBuffer commands, VkSubpassContents contents) {
    CommandBuffer& buffer = commands_of(commands);
    if (buffer.recording) buffer.recording->change_subpass(false);
    buffer.device->next.CmdNextSubpass(commands, contents);
}

VKAPI_ATTR void VKAPI_CALL CmdNextSubpass2(VkCommandBuffer commands, const VkSubpassBeginInfo* begin, const VkSubpassEndInfo* end) {
    CommandBuffer& buffer = commands_of(commands);
    if (buffer.recording) buffer.recording->change_subpass(false);
    buffer.device->next.CmdNextSubpass2(commands, begin, end);
}

VKAPI_ATTR void VKAPI_CALL CmdEndRenderPass(VkCommandBuffer commands) {
    end_pass(commands, [&](const DeviceTable& next) { next.CmdEndRenderPass(commands); });
}

VKAPI_ATTR void VKAPI_CALL CmdEndRenderPass2(VkCommandBuffer commands, const VkSubpassEndInfo* end) {
    end_pass(commands, [&](const DeviceTable& next) { next.CmdEndRenderPass2(commands, end); });
}

VKAPI_ATTR void VKAPI_CALL CmdEndRendering(VkCommandBuffer commands) {
    end_pass(commands, [&](const DeviceTable& next) { next.CmdEndRendering(commands); });
}

// Secondary command buffers have stretches of their own; these are read with the submission that executes them.
VKAPI_ATTR void VKAPI_CALL CmdExecuteCommands(VkCommandBuffer commands, uint32_t count, const VkCommandBuffer* secondaries) {
    CommandBuffer& buffer = commands_of(commands);
    buffer.device->next.CmdExecuteCommands(commands, count, secondaries);
    for (uint32_t i = 0; i < count && buffer.recording; ++i)
        if (const auto& recording = commands_of(secondaries[i]).recording) buffer.recording->secondaries.push_back(recording);
}

}  // namespace

std::span<const Intercept> region_intercepts() {
    static const Intercept all[] = {
        MYRIAD_INTERCEPT(CmdBeginDebugUtilsLabelEXT), MYRIAD_INTERCEPT(CmdEndDebugUtilsLabelEXT), MYRIAD_INTERCEPT(SetDebugUtilsObjectNameEXT),
        MYRIAD_INTERCEPT(CmdBindPipeline), MYRIAD_INTERCEPT(CreateRenderPass), MYRIAD_INTERCEPT_KHR(CreateRenderPass2),
        MYRIAD_INTERCEPT(DestroyRenderPass), MYRIAD_INTERCEPT(CmdBeginRenderPass), MYRIAD_INTERCEPT_KHR(CmdBeginRenderPass2),
        MYRIAD_INTERCEPT(CmdNextSubpass), MYRIAD_INTERCEPT_KHR(CmdNextSubpass2), MYRIAD_INTERCEPT(CmdEndRenderPass),
        MYRIAD_INTERCEPT_KHR(CmdEndRenderPass2), MYRIAD_INTERCEPT_KHR(CmdBeginRendering), MYRIAD_INTERCEPT_KHR(CmdEndRendering),
        MYRIAD_INTERCEPT(CmdExecuteCommands),
    };
    return all;
}

}  // namespace myriad::profiler
