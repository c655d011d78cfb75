// VK_LAYER_MYRIAD_profiler as the loader sees it: one exported function, instances and devices on their way through, and the look-up of
// entry points. Everything that the layer does not stand in for goes to the next one down directly.
#include <algorithm>
#include <cstring>

#include "tools/profiler_layer/intercepts.hpp"

namespace myriad::profiler {
namespace {

constexpr const char* layer_name = "VK_LAYER_MYRIAD_profiler";

// The loader's struct in the chain that says what comes next.
template <class Info>
Info* loader_link(const void* chain, VkStructureType type) {
    for (auto* at = static_cast<const Info*>(chain); at; at = static_cast<const Info*>(at->pNext))
        if (at->sType == type && at->function == VK_LAYER_LINK_INFO) return const_cast<Info*>(at);
    return nullptr;
}

VKAPI_ATTR VkResult VKAPI_CALL CreateInstance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator, VkInstance* handle) {
    profiler();  // problems with settings are told before any work
    auto* link = loader_link<VkLayerInstanceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
    if (!link) return VK_ERROR_INITIALIZATION_FAILED;
    const PFN_vkGetInstanceProcAddr next = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;  // for the layer below
    const auto create = reinterpret_cast<PFN_vkCreateInstance>(next(VK_NULL_HANDLE, "vkCreateInstance"));
    const VkResult result = create(info, allocator, handle);
    if (result != VK_SUCCESS) return result;
    auto instance = std::make_unique<Instance>();
    instance->handle = *handle;
    instance->next.load(*handle, next);
    add_instance(std::move(instance));
    return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL DestroyInstance(VkInstance handle, const VkAllocationCallbacks* allocator) {
    if (!handle) return;
    const PFN_vkDestroyInstance next = instance_of(handle).next.DestroyInstance;
    remove_instance(handle);
    next(handle, allocator);
}

// Host and device clocks can be read together: by an extension that the layer adds where the program does not.
bool can_calibrate(const InstanceTable& instance, VkPhysicalDevice physical) {
    uint32_t count = 0;
    instance.EnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    instance.EnumerateDeviceExtensionProperties(physical, nullptr, &count, extensions.data());
    const bool there = std::ranges::any_of(extensions, [](const VkExtensionProperties& e) {
        return !std::strcmp(e.extensionName, VK_EXT_CALIBRATED_TIMESTAMPS_EXTENSION_NAME);
    });
    if (!there || !instance.GetPhysicalDeviceCalibrateableTimeDomainsEXT) return false;
    instance.GetPhysicalDeviceCalibrateableTimeDomainsEXT(physical, &count, nullptr);
    std::vector<VkTimeDomainEXT> domains(count);
    instance.GetPhysicalDeviceCalibrateableTimeDomainsEXT(physical, &count, domains.data());
    return std::ranges::count(domains, VK_TIME_DOMAIN_DEVICE_EXT) && std::ranges::count(domains, VK_TIME_DOMAIN_CLOCK_MONOTONIC_EXT);
}

VKAPI_ATTR VkResult VKAPI_CALL CreateDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo* info, const VkAllocationCallbacks* allocator,
                                            VkDevice* handle) {
    auto* link = loader_link<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    if (!link) return VK_ERROR_INITIALIZATION_FAILED;
    Instance& instance = instance_of(physical);
    const PFN_vkGetInstanceProcAddr next_instance = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    const PFN_vkGetDeviceProcAddr next = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;

    std::vector<const char*> extensions(info->ppEnabledExtensionNames, info->ppEnabledExtensionNames + info->enabledExtensionCount);
    const auto enabled = [&](const char* name) { return std::ranges::any_of(extensions, [&](const char* e) { return !std::strcmp(e, name); }); };
    const bool presents = enabled(VK_KHR_SWAPCHAIN_EXTENSION_NAME), calibrated = can_calibrate(instance.next, physical);
    if (calibrated && !enabled(VK_EXT_CALIBRATED_TIMESTAMPS_EXTENSION_NAME)) extensions.push_back(VK_EXT_CALIBRATED_TIMESTAMPS_EXTENSION_NAME);
    VkDeviceCreateInfo more = *info;
    more.enabledExtensionCount = uint32_t(extensions.size());
    more.ppEnabledExtensionNames = extensions.data();
    const auto create = reinterpret_cast<PFN_vkCreateDevice>(next_instance(instance.handle, "vkCreateDevice"));
    const VkResult result = create(physical, &more, allocator, handle);
    if (result == VK_SUCCESS) add_device(std::make_unique<Device>(profiler(), *handle, instance.next, physical, next, presents, calibrated));
    return result;
}

VKAPI_ATTR void VKAPI_CALL DestroyDevice(VkDevice handle, const VkAllocationCallbacks* allocator) {
    if (!handle) return;
    Device& device = device_of(handle);
    const PFN_vkDestroyDevice next = device.next.DestroyDevice;
    device.destroy();
    remove_device(handle);
    next(handle, allocator);
    profiler().write();
}

// The layer has no device extensions of its own.
VKAPI_ATTR VkResult VKAPI_CALL EnumerateDeviceExtensionProperties(VkPhysicalDevice physical, const char* layer, uint32_t* count,
                                                                  VkExtensionProperties* properties) {
    if (!layer || std::strcmp(layer, layer_name))
        return instance_of(physical).next.EnumerateDeviceExtensionProperties(physical, layer, count, properties);
    *count = 0;
    return VK_SUCCESS;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL GetDeviceProcAddr(VkDevice handle, const char* name);
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL GetInstanceProcAddr(VkInstance handle, const char* name);

PFN_vkVoidFunction find(std::span<const Intercept> list, const char* name) {
    const auto found = std::ranges::find_if(list, [&](const Intercept& i) { return !std::strcmp(i.name, name); });
    return found == list.end() ? nullptr : found->function;
}

PFN_vkVoidFunction find_instance_function(const char* name) {
    static const Intercept all[] = {MYRIAD_INTERCEPT(CreateInstance), MYRIAD_INTERCEPT(DestroyInstance), MYRIAD_INTERCEPT(CreateDevice),
                                    MYRIAD_INTERCEPT(EnumerateDeviceExtensionProperties), MYRIAD_INTERCEPT(GetInstanceProcAddr)};
    return find(all, name);
}

PFN_vkVoidFunction find_device_function(const char* name) {
    static const Intercept own[] = {MYRIAD_INTERCEPT(DestroyDevice), MYRIAD_INTERCEPT(GetDeviceProcAddr)};
    for (const std::span<const Intercept> list : {std::span<const Intercept>(own), work_intercepts(), region_intercepts(), lifetime_intercepts(),
                                                  submission_intercepts()})
        if (const PFN_vkVoidFunction function = find(list, name)) return function;
    return nullptr;
}

// Labels and names are the layer's business also where nothing below knows them; of the rest nobody gets what the device lacks.
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL GetDeviceProcAddr(VkDevice handle, const char* name) {
    const PFN_vkVoidFunction own = find_device_function(name), next = device_of(handle).next.get(handle, name);
    return own && (next || std::strstr(name, "DebugUtils")) ? own : next;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL GetInstanceProcAddr(VkInstance handle, const char* name) {
    if (const PFN_vkVoidFunction own = find_instance_function(name)) return own;
    if (!handle) return nullptr;
    const PFN_vkVoidFunction own = find_device_function(name), next = instance_of(handle).next.get(handle, name);
    return own && (next || std::strstr(name, "DebugUtils")) ? own : next;
}

}  // namespace
}  // namespace myriad::profiler

extern "C" VK_LAYER_EXPORT VKAPI_ATTR VkResult VKAPI_CALL vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* interface) {
    constexpr uint32_t known = 2;
    if (interface->loaderLayerInterfaceVersion < known) return VK_ERROR_INITIALIZATION_FAILED;
    interface->loaderLayerInterfaceVersion = known;
    interface->pfnGetInstanceProcAddr = myriad::profiler::GetInstanceProcAddr;
    interface->pfnGetDeviceProcAddr = myriad::profiler::GetDeviceProcAddr;
    interface->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}
