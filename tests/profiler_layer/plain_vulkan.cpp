// A program that knows nothing of Myriad: what command buffers can go through, a mode each, for the profiling layer to watch.
//
//   myriad_plain_vulkan MODE        exit status: the number of validation messages
#include <vulkan/vulkan.h>

#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace {

void check(VkResult result, int line) {
    if (result == VK_SUCCESS) return;
    std::fprintf(stderr, "plain_vulkan.cpp:%d: VkResult %d\n", line, int(result));
    std::exit(100);
}
#define CHECK(call) check(call, __LINE__)

int messages = 0;

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void*) {
    ++messages;
    std::fprintf(stderr, "validation: %s\n", data->pMessage);
    return VK_FALSE;
}

VkInstance make_instance() {
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.apiVersion = VK_API_VERSION_1_3;
    VkDebugUtilsMessengerCreateInfoEXT messenger{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    messenger.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    messenger.pfnUserCallback = on_message;
    const char* extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pApplicationInfo = &application;
    info.enabledExtensionCount = 1;
    info.ppEnabledExtensionNames = extensions;
    VkInstance instance;
    CHECK(vkCreateInstance(&info, nullptr, &instance));
    VkDebugUtilsMessengerEXT handle;
    CHECK(reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT"))(
        instance, &messenger, nullptr, &handle));
    return instance;  // and all that is left goes with the process
}

class Device {
public:
    explicit Device(VkInstance instance) {
        uint32_t one = 1;
        VkPhysicalDevice physical;
        vkEnumeratePhysicalDevices(instance, &one, &physical);
        const float priority = 1;
        VkDeviceQueueCreateInfo queues{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
        queues.queueCount = 1;
        queues.pQueuePriorities = &priority;
        VkPhysicalDeviceVulkan13Features f13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
        f13.dynamicRendering = VK_TRUE;
        VkPhysicalDeviceVulkan11Features f11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES, &f13};
        f11.multiview = VK_TRUE;
        VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &f11};
        info.queueCreateInfoCount = 1;
        info.pQueueCreateInfos = &queues;
        CHECK(vkCreateDevice(physical, &info, nullptr, &handle));
        vkGetDeviceQueue(handle, 0, 0, &queue);
        const auto load = [&](const char* name) { return vkGetInstanceProcAddr(instance, name); };
        begin_label = reinterpret_cast<PFN_vkCmdBeginDebugUtilsLabelEXT>(load("vkCmdBeginDebugUtilsLabelEXT"));
        end_label = reinterpret_cast<PFN_vkCmdEndDebugUtilsLabelEXT>(load("vkCmdEndDebugUtilsLabelEXT"));
        set_name = reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(load("vkSetDebugUtilsObjectNameEXT"));
    }

    VkCommandPool pool() {
        VkCommandPoolCreateInfo info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
        info.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
        pools.push_back(VK_NULL_HANDLE);
        CHECK(vkCreateCommandPool(handle, &info, nullptr, &pools.back()));
        return pools.back();
    }

    VkCommandBuffer commands(VkCommandPool pool, VkCommandBufferLevel level = VK_COMMAND_BUFFER_LEVEL_PRIMARY) {
        VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool, level, 1};
        VkCommandBuffer made;
        CHECK(vkAllocateCommandBuffers(handle, &info, &made));
        return made;
    }

    void begin(VkCommandBuffer commands, VkCommandBufferUsageFlags flags = 0, const VkCommandBufferInheritanceInfo* inherited = nullptr) {
        VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr, flags, inherited};
        CHECK(vkBeginCommandBuffer(commands, &info));
    }

    template <class Inside>
    void labelled(VkCommandBuffer commands, const char* name, Inside inside) {
        VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT, nullptr, name, {}};
        begin_label(commands, &label);
        inside();
        end_label(commands);
    }

    // Something that is worth a label.
    void work(VkCommandBuffer commands, const char* label) {
        labelled(commands, label, [&] { vkCmdDispatch(commands, 1, 1, 1); });
    }

    void bind_compute(VkCommandBuffer commands) {
        if (!compute) compute = make_compute();
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, compute);
    }

    void submit(VkCommandBuffer commands, VkFence fence = VK_NULL_HANDLE) {
        VkSubmitInfo info{VK_STRUCTURE_TYPE_SUBMIT_INFO};
        info.commandBufferCount = 1;
        info.pCommandBuffers = &commands;
        const std::lock_guard lock(mutex);
        CHECK(vkQueueSubmit(queue, 1, &info, fence));
    }

    void submit_and_wait(VkCommandBuffer commands) {
        VkFenceCreateInfo info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
        VkFence fence;
        CHECK(vkCreateFence(handle, &info, nullptr, &fence));
        submit(commands, fence);
        CHECK(vkWaitForFences(handle, 1, &fence, VK_TRUE, UINT64_MAX));
        vkDestroyFence(handle, fence, nullptr);
    }

    // A program of nothing, for any stage: words by hand, so that no compiler is needed.
    VkPipelineShaderStageCreateInfo nothing(VkShaderStageFlagBits stage) {
        const bool kernel = stage == VK_SHADER_STAGE_COMPUTE_BIT;
        std::vector<uint32_t> words = {0x07230203, 0x00010000, 0, 5, 0, 2 << 16 | 17, 1, 3 << 16 | 14, 0, 1,
                                       5 << 16 | 15, kernel ? 5u : 0u, 1, 0x6e69616d, 0};  // capability, memory model, entry point "main"
        if (kernel) words.insert(words.end(), {6 << 16 | 16, 1, 17, 1, 1, 1});            // a workgroup of one
        words.insert(words.end(), {2 << 16 | 19, 2, 3 << 16 | 33, 3, 2, 5 << 16 | 54, 2, 1, 0, 3, 2 << 16 | 248, 4, 1 << 16 | 253, 1 << 16 | 56});
        VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, nullptr, 0, words.size() * 4, words.data()};
        modules.push_back(VK_NULL_HANDLE);
        CHECK(vkCreateShaderModule(handle, &info, nullptr, &modules.back()));
        return {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, nullptr, 0, stage, modules.back(), "main", nullptr};
    }

    VkPipelineLayout layout() {
        if (made_layout) return made_layout;
        VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
        CHECK(vkCreatePipelineLayout(handle, &info, nullptr, &made_layout));
        return made_layout;
    }

    VkPipeline named(VkPipeline pipeline, const char* name) {
        VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT, nullptr, VK_OBJECT_TYPE_PIPELINE,
                                           reinterpret_cast<uint64_t>(pipeline), name};
        CHECK(set_name(handle, &info));
        pipelines.push_back(pipeline);
        return pipeline;
    }

    VkPipeline make_compute() {
        VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
        info.stage = nothing(VK_SHADER_STAGE_COMPUTE_BIT);
        info.layout = layout();
        VkPipeline pipeline;
        CHECK(vkCreateComputePipelines(handle, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline));
        return named(pipeline, "idle");
    }

    VkPipeline make_graphics() {
        const VkPipelineShaderStageCreateInfo stage = nothing(VK_SHADER_STAGE_VERTEX_BIT);
        VkPipelineVertexInputStateCreateInfo vertices{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
        VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
        assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
        VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
        raster.rasterizerDiscardEnable = VK_TRUE;
        raster.lineWidth = 1;
        VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
        VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &rendering};
        info.stageCount = 1, info.pStages = &stage, info.pVertexInputState = &vertices, info.pInputAssemblyState = &assembly;
        info.pRasterizationState = &raster, info.layout = layout();
        VkPipeline pipeline;
        CHECK(vkCreateGraphicsPipelines(handle, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline));
        return named(pipeline, "triangle");
    }

    template <class Inside>
    void rendering(VkCommandBuffer commands, uint32_t view_mask, Inside inside) {
        VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
        info.renderArea.extent = {1, 1}, info.layerCount = 1, info.viewMask = view_mask;
        vkCmdBeginRendering(commands, &info);
        inside();
        vkCmdEndRendering(commands);
    }

    void destroy() {
        vkDeviceWaitIdle(handle);
        for (VkCommandPool pool : pools) vkDestroyCommandPool(handle, pool, nullptr);
        for (VkPipeline pipeline : pipelines) vkDestroyPipeline(handle, pipeline, nullptr);
        for (VkShaderModule module : modules) vkDestroyShaderModule(handle, module, nullptr);
        vkDestroyPipelineLayout(handle, made_layout, nullptr);
        vkDestroyDevice(handle, nullptr);
    }

    VkDevice handle = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;

private:
    PFN_vkCmdBeginDebugUtilsLabelEXT begin_label;
    PFN_vkCmdEndDebugUtilsLabelEXT end_label;
    PFN_vkSetDebugUtilsObjectNameEXT set_name;
    std::mutex mutex;
    VkPipeline compute = VK_NULL_HANDLE;
    VkPipelineLayout made_layout = VK_NULL_HANDLE;
    std::vector<VkCommandPool> pools;
    std::vector<VkPipeline> pipelines;
    std::vector<VkShaderModule> modules;
};

// One command buffer with `count` regions of a name, submitted `times` times.
void repeat(Device& device, const char* label, int count, int times, VkCommandBufferUsageFlags flags, bool wait) {
    const VkCommandBuffer commands = device.commands(device.pool());
    device.begin(commands, flags);
    device.bind_compute(commands);
    for (int i = 0; i < count; ++i) device.work(commands, label);
    CHECK(vkEndCommandBuffer(commands));
    for (int i = 0; i < times; ++i) wait ? device.submit_and_wait(commands) : device.submit(commands);
}

void secondary(Device& device, int times) {
    const VkCommandPool pool = device.pool();
    const VkCommandBuffer inner = device.commands(pool, VK_COMMAND_BUFFER_LEVEL_SECONDARY), outer = device.commands(pool);
    const VkCommandBufferInheritanceInfo inherited{VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_INFO};
    device.begin(inner, VK_COMMAND_BUFFER_USAGE_SIMULTANEOUS_USE_BIT, &inherited);
    device.bind_compute(inner);
    device.work(inner, "inner");
    CHECK(vkEndCommandBuffer(inner));
    device.begin(outer);
    device.labelled(outer, "outer", [&] {
        for (int i = 0; i < times; ++i) vkCmdExecuteCommands(outer, 1, &inner);
    });
    CHECK(vkEndCommandBuffer(outer));
    device.submit_and_wait(outer);
}

void two_threads(Device& device) {
    const VkCommandPool pools[2] = {device.pool(), device.pool()};
    std::mutex making;  // of pipelines, in this program
    const auto work = [&](int which) {
        const VkCommandBuffer commands = device.commands(pools[which]);
        for (int i = 0; i < 20; ++i) {
            device.begin(commands);
            making.lock(), device.bind_compute(commands), making.unlock();
            device.work(commands, which ? "second thread" : "first thread");
            CHECK(vkEndCommandBuffer(commands));
            device.submit_and_wait(commands);
        }
    };
    std::thread other(work, 1);
    work(0);
    other.join();
}

void render_passes(Device& device) {
    const VkPipeline triangle = device.make_graphics();
    const VkCommandBuffer commands = device.commands(device.pool());
    device.begin(commands);
    device.bind_compute(commands);
    vkCmdDispatch(commands, 1, 1, 1);
    device.rendering(commands, 0, [&] {
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, triangle);
        device.labelled(commands, "inside", [&] { vkCmdDraw(commands, 3, 1, 0, 0); });
        for (int i = 0; i < 300; ++i) vkCmdDraw(commands, 3, 1, 0, 0);  // more than there are queries for
    });
    device.rendering(commands, 3, [&] { device.labelled(commands, "several views", [] {}); });
    CHECK(vkEndCommandBuffer(commands));
    device.submit_and_wait(commands);
}

// Allowed nowhere: two writes that nothing orders, a barrier for all there is, and a fence that outlives its device.
void wrong(Device& device) {
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = 1 << 20, info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    VkBuffer buffer;
    CHECK(vkCreateBuffer(device.handle, &info, nullptr, &buffer));
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device.handle, buffer, &needs);
    VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needs.size, uint32_t(__builtin_ctz(needs.memoryTypeBits))};
    VkDeviceMemory memory;
    CHECK(vkAllocateMemory(device.handle, &allocate, nullptr, &memory));
    CHECK(vkBindBufferMemory(device.handle, buffer, memory, 0));

    const VkCommandBuffer commands = device.commands(device.pool());
    device.begin(commands);
    vkCmdFillBuffer(commands, buffer, 0, VK_WHOLE_SIZE, 1);
    vkCmdFillBuffer(commands, buffer, 0, VK_WHOLE_SIZE, 2);
    VkMemoryBarrier barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, VK_ACCESS_MEMORY_WRITE_BIT, VK_ACCESS_MEMORY_READ_BIT};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1, &barrier, 0, nullptr, 0, nullptr);
    CHECK(vkEndCommandBuffer(commands));
    device.submit_and_wait(commands);
    vkDestroyBuffer(device.handle, buffer, nullptr);
    vkFreeMemory(device.handle, memory, nullptr);
    const VkFenceCreateInfo left{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    VkFence fence;
    CHECK(vkCreateFence(device.handle, &left, nullptr, &fence));
}

}  // namespace

int main(int, char** argv) {
    const std::string mode = argv[1];
    const VkInstance instance = make_instance();
    Device device(instance);
    const auto simultaneous = VK_COMMAND_BUFFER_USAGE_SIMULTANEOUS_USE_BIT;
    if (mode == "again") repeat(device, "again", 1, 3, 0, true);
    else if (mode == "many") repeat(device, "many", 500, 1, 0, true);
    else if (mode == "overlapping") repeat(device, "overlapping", 1, 3, simultaneous, false);
    else if (mode == "exits") return repeat(device, "exits", 1, 2, 0, true), messages;
    else if (mode == "secondary") secondary(device, 1);
    else if (mode == "secondary-twice") secondary(device, 2);
    else if (mode == "threads") two_threads(device);
    else if (mode == "render-passes") render_passes(device);
    else if (mode == "wrong") wrong(device);
    else if (mode == "devices") {
        Device second(instance);
        repeat(device, "one", 1, 1, 0, true), repeat(second, "other", 1, 1, 0, true);
        second.destroy();
    } else return 101;
    device.destroy();
    return messages;
}
