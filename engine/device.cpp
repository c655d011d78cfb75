#include "engine/device.hpp"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <iostream>

namespace myriad::engine {

struct Device::Callbacks {
    std::atomic<uint32_t> messages{0};
    PFN_vkSetDebugUtilsObjectNameEXT set_name = nullptr;
    PFN_vkCmdBeginDebugUtilsLabelEXT begin_label = nullptr;
    PFN_vkCmdEndDebugUtilsLabelEXT end_label = nullptr;
    PFN_vkGetCalibratedTimestampsEXT clocks = nullptr;
};

namespace {

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";

bool environment_flag(const char* name) {
    const char* value = std::getenv(name);
    return value && *value && std::strcmp(value, "0") != 0;
}

bool has_layer(const char* name) {
    uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    return std::any_of(layers.begin(), layers.end(), [&](auto& l) { return !std::strcmp(l.layerName, name); });
}

bool has_instance_extension(const char* name, const char* layer = nullptr) {
    uint32_t count = 0;
    vkEnumerateInstanceExtensionProperties(layer, &count, nullptr);
    std::vector<VkExtensionProperties> all(count);
    vkEnumerateInstanceExtensionProperties(layer, &count, all.data());
    return std::any_of(all.begin(), all.end(), [&](auto& e) { return !std::strcmp(e.extensionName, name); });
}

bool has_device_extension(VkPhysicalDevice physical, const char* name) {
    uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> all(count);
    vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, all.data());
    return std::any_of(all.begin(), all.end(), [&](auto& e) { return !std::strcmp(e.extensionName, name); });
}

// The host's clock is CLOCK_MONOTONIC, which is std::chrono's steady one here.
bool has_common_clock(VkInstance instance, VkPhysicalDevice physical) {
    if (!has_device_extension(physical, VK_EXT_CALIBRATED_TIMESTAMPS_EXTENSION_NAME)) return false;
    const auto ask = reinterpret_cast<PFN_vkGetPhysicalDeviceCalibrateableTimeDomainsEXT>(
        vkGetInstanceProcAddr(instance, "vkGetPhysicalDeviceCalibrateableTimeDomainsEXT"));
    if (!ask) return false;
    uint32_t count = 0;
    ask(physical, &count, nullptr);
    std::vector<VkTimeDomainEXT> domains(count);
    ask(physical, &count, domains.data());
    const auto has = [&](VkTimeDomainEXT domain) { return std::count(domains.begin(), domains.end(), domain) > 0; };
    return has(VK_TIME_DOMAIN_DEVICE_EXT) && has(VK_TIME_DOMAIN_CLOCK_MONOTONIC_EXT);
}

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    ++*static_cast<std::atomic<uint32_t>*>(user);
    std::cerr << "validation: " << data->pMessage << "\n";
    return VK_FALSE;
}

VkInstance create_instance(bool validation, bool debug_utils, const std::vector<std::string>& surfaces = {}) {
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.pApplicationName = "myriad";
    application.apiVersion = VK_API_VERSION_1_3;
    std::vector<const char*> layers, extensions;
    const VkValidationFeatureEnableEXT enables[] = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = enables;
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pApplicationInfo = &application;
    if (validation) {
        layers.push_back(validation_layer);
        extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
        info.pNext = &features;
    }
    if (debug_utils) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    for (const std::string& name : surfaces) extensions.push_back(name.c_str());
    info.enabledLayerCount = uint32_t(layers.size());
    info.ppEnabledLayerNames = layers.data();
    info.enabledExtensionCount = uint32_t(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    VkInstance instance = VK_NULL_HANDLE;
    return vkCreateInstance(&info, nullptr, &instance) == VK_SUCCESS ? instance : VK_NULL_HANDLE;
}

std::vector<VkPhysicalDevice> physical_devices(VkInstance instance) {
    uint32_t count = 0;
    if (vkEnumeratePhysicalDevices(instance, &count, nullptr) != VK_SUCCESS) return {};
    std::vector<VkPhysicalDevice> devices(count);
    vkEnumeratePhysicalDevices(instance, &count, devices.data());
    return devices;
}

int compute_queue_family(VkPhysicalDevice physical) {
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    for (uint32_t i = 0; i < count; ++i)
        if (families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) return int(i);
    return -1;
}

const char* type_name(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return "discrete";
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return "integrated";
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return "virtual";
        case VK_PHYSICAL_DEVICE_TYPE_CPU: return "cpu";
        default: return "other";
    }
}

// All that is asked of a physical device, in one chain.
struct Query {
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    VkPhysicalDeviceVulkan11Properties v11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES};
    VkPhysicalDeviceVulkan12Properties v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES};
    VkPhysicalDeviceVulkan13Properties v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES};
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    VkPhysicalDeviceVulkan12Features f12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceVulkan13Features f13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};

    explicit Query(VkPhysicalDevice physical) {
        vkGetPhysicalDeviceProperties2(physical, &properties);
        if (properties.properties.apiVersion < VK_API_VERSION_1_3) return;  // the 1.3 structs are unknown to it
        properties.pNext = &v11; v11.pNext = &v12; v12.pNext = &v13;
        vkGetPhysicalDeviceProperties2(physical, &properties);
        features.pNext = &f12; f12.pNext = &f13;
        vkGetPhysicalDeviceFeatures2(physical, &features);
    }

    bool subgroup_arithmetic() const {
        const VkSubgroupFeatureFlags wanted =
            VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_ARITHMETIC_BIT | VK_SUBGROUP_FEATURE_BALLOT_BIT |
            VK_SUBGROUP_FEATURE_SHUFFLE_BIT | VK_SUBGROUP_FEATURE_VOTE_BIT;
        return (v11.subgroupSupportedOperations & wanted) == wanted &&
               (v11.subgroupSupportedStages & VK_SHADER_STAGE_COMPUTE_BIT);
    }
};

DeviceInfo describe(VkInstance instance, VkPhysicalDevice physical, const Query& q) {
    const auto& p = q.properties.properties;
    DeviceInfo info;
    info.name = p.deviceName;
    info.type = type_name(p.deviceType);
    info.api_major = VK_API_VERSION_MAJOR(p.apiVersion);
    info.api_minor = VK_API_VERSION_MINOR(p.apiVersion);
    info.api_patch = VK_API_VERSION_PATCH(p.apiVersion);
    if (p.apiVersion < VK_API_VERSION_1_3) {
        info.missing.push_back("Vulkan 1.3 (it has " + std::to_string(info.api_major) + "." + std::to_string(info.api_minor) + ")");
        return info;
    }
    info.driver = q.v12.driverName;
    info.driver_version = q.v12.driverInfo;
    auto require = [&](bool present, const char* name) { (present ? info.used : info.missing).push_back(name); };
    require(compute_queue_family(physical) >= 0, "compute queue");
    require(q.f12.bufferDeviceAddress, "bufferDeviceAddress");
    require(q.f12.scalarBlockLayout, "scalarBlockLayout");
    require(q.f13.synchronization2, "synchronization2");
    require(q.f13.maintenance4, "maintenance4");
    if (q.subgroup_arithmetic()) info.used.push_back("subgroup arithmetic");
    else info.degraded.push_back("no subgroup arithmetic: scans and appends run with one invocation a group, slower");
    const auto& l = p.limits;
    if (l.timestampComputeAndGraphics) info.used.push_back("timestamps");
    else info.degraded.push_back("no timestamps: passes report host time only");
    info.common_clock = l.timestampComputeAndGraphics && has_common_clock(instance, physical);
    if (info.common_clock) info.used.push_back("VK_EXT_calibrated_timestamps");
    else info.degraded.push_back("no VK_EXT_calibrated_timestamps: in time lines, where device times lie beside host times is a guess");
    if (has_instance_extension(VK_EXT_DEBUG_UTILS_EXTENSION_NAME)) info.used.push_back("VK_EXT_debug_utils");
    else info.degraded.push_back("no VK_EXT_debug_utils: objects and regions are not named in tools");

    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);
    for (uint32_t i = 0; i < memory.memoryHeapCount; ++i)
        if (memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
            info.heap_bytes = std::max<uint64_t>(info.heap_bytes, memory.memoryHeaps[i].size);
    info.limits = {
        {"maxPushConstantsSize", l.maxPushConstantsSize},
        {"maxComputeWorkGroupInvocations", l.maxComputeWorkGroupInvocations},
        {"maxComputeWorkGroupCountX", l.maxComputeWorkGroupCount[0]},
        {"maxComputeWorkGroupCountY", l.maxComputeWorkGroupCount[1]},
        {"maxComputeSharedMemorySize", l.maxComputeSharedMemorySize},
        {"maxStorageBufferRange", l.maxStorageBufferRange},
        {"maxMemoryAllocationCount", l.maxMemoryAllocationCount},
        {"maxMemoryAllocationSize", q.v11.maxMemoryAllocationSize},
        {"maxBufferSize", q.v13.maxBufferSize},
        {"subgroupSize", q.v11.subgroupSize},
    };
    return info;
}

// The faster a kind of device tends to be, the higher.
int rank(const DeviceInfo& info) {
    if (info.type == "discrete") return 4;
    if (info.type == "integrated") return 3;
    if (info.type == "virtual") return 2;
    return info.type == "cpu" ? 1 : 0;
}

size_t pick(const std::vector<DeviceInfo>& all, const std::string& select) {
    std::string names;
    for (size_t i = 0; i < all.size(); ++i) names += (i ? ", " : "") + std::to_string(i) + " \"" + all[i].name + "\"";
    if (!select.empty()) {
        const bool index = select.find_first_not_of("0123456789") == std::string::npos && select.size() < 9;
        for (size_t i = 0; i < all.size(); ++i) {
            if (index ? i != std::stoul(select) : all[i].name.find(select) == std::string::npos) continue;
            if (all[i].usable()) return i;
            throw DeviceError("device \"" + all[i].name + "\" lacks " + all[i].missing.front() +
                              "; update its driver, or pick another with --device (there are: " + names + ")");
        }
        throw DeviceError("no device matches --device " + select + "; there are: " + names);
    }
    int best = -1;
    for (size_t i = 0; i < all.size(); ++i)
        if (all[i].usable() && (best < 0 || rank(all[i]) > rank(all[size_t(best)]))) best = int(i);
    if (best >= 0) return size_t(best);
    throw DeviceError("no usable Vulkan device: \"" + all.front().name + "\" lacks " + all.front().missing.front() +
                      "; update its driver, or install Mesa's software Vulkan (package mesa-vulkan-drivers)");
}

constexpr const char* no_device =
    "no Vulkan device found; install a driver, for example Mesa's software Vulkan (package mesa-vulkan-drivers)";

}  // namespace

void check(VkResult result, const char* what) {
    if (result >= 0) return;
    const std::string code = std::to_string(int(result));
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY)
        throw OutOfMemory(std::string(what) + " ran out of memory; lower --memory-limit or --vpls");
    if (result == VK_ERROR_EXTENSION_NOT_PRESENT)
        throw DeviceError(std::string(what) + ": its driver shows no pictures in windows; use another device with --device");
    if (result == VK_ERROR_DEVICE_LOST)
        throw DeviceError(std::string(what) + ": the device was lost (a driver fault or a time-out); update the driver or use --device");
    throw DeviceError(std::string(what) + " failed (VkResult " + code + ")");
}

std::vector<DeviceInfo> Device::enumerate() {
    VkInstance instance = create_instance(false, false);
    if (!instance) return {};
    std::vector<DeviceInfo> all;
    for (VkPhysicalDevice physical : physical_devices(instance)) all.push_back(describe(instance, physical, Query(physical)));
    vkDestroyInstance(instance, nullptr);
    return all;
}

Device::Device(const DeviceOptions& options) : callbacks_(std::make_unique<Callbacks>()) {
    const bool wanted = options.validation || environment_flag("MYRIAD_VALIDATION");
    validation_active_ = wanted && has_layer(validation_layer);
    if (wanted && !validation_active_)
        std::cerr << "warning: the Khronos validation layer is not installed (package vulkan-validationlayers); running without it\n";
    const bool debug_utils = has_instance_extension(VK_EXT_DEBUG_UTILS_EXTENSION_NAME) ||
                             (validation_active_ && has_instance_extension(VK_EXT_DEBUG_UTILS_EXTENSION_NAME, validation_layer));
    instance_ = create_instance(validation_active_, debug_utils, options.surfaces);
    if (!instance_) throw DeviceError(no_device);

    const auto physicals = physical_devices(instance_);
    std::vector<DeviceInfo> infos;
    for (VkPhysicalDevice physical : physicals) infos.push_back(describe(instance_, physical, Query(physical)));
    try {
        if (infos.empty()) throw DeviceError(no_device);
        const size_t chosen = pick(infos, options.select);
        physical_ = physicals[chosen];
        info_ = infos[chosen];
    } catch (...) {
        vkDestroyInstance(instance_, nullptr);
        throw;
    }

    if (debug_utils) {
        auto load = [&](const char* name) { return vkGetInstanceProcAddr(instance_, name); };
        callbacks_->set_name = reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(load("vkSetDebugUtilsObjectNameEXT"));
        callbacks_->begin_label = reinterpret_cast<PFN_vkCmdBeginDebugUtilsLabelEXT>(load("vkCmdBeginDebugUtilsLabelEXT"));
        callbacks_->end_label = reinterpret_cast<PFN_vkCmdEndDebugUtilsLabelEXT>(load("vkCmdEndDebugUtilsLabelEXT"));
        if (validation_active_) {
            VkDebugUtilsMessengerCreateInfoEXT messenger{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
            messenger.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
            messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT |
                                    VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT;
            messenger.pfnUserCallback = on_message;
            messenger.pUserData = &callbacks_->messages;
            auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(load("vkCreateDebugUtilsMessengerEXT"));
            check(create(instance_, &messenger, nullptr, &messenger_), "creating the validation messenger");
        }
    }

    const Query query(physical_);
    queue_family_ = uint32_t(compute_queue_family(physical_));
    subgroup_size_ = query.v11.subgroupSize;
    plain_groups_ = !query.subgroup_arithmetic() || environment_flag("MYRIAD_PLAIN_GROUPS");
    if (query.properties.properties.limits.timestampComputeAndGraphics)
        timestamp_period_ns_ = query.properties.properties.limits.timestampPeriod;
    if (query.v12.driverID == VK_DRIVER_ID_MESA_LLVMPIPE && std::atoi(info_.driver_version.c_str() + std::strlen("Mesa ")) < 23)
        loop_limit_ = 65535;
    memory_limit_ = options.memory_limit ? options.memory_limit : info_.heap_bytes;
    vkGetPhysicalDeviceMemoryProperties(physical_, &memory_properties_);

    const float priority = 1;
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueFamilyIndex = queue_family_;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkPhysicalDeviceVulkan13Features f13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    f13.synchronization2 = f13.maintenance4 = VK_TRUE;
    VkPhysicalDeviceVulkan12Features f12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    f12.bufferDeviceAddress = f12.scalarBlockLayout = VK_TRUE;
    f12.pNext = &f13;
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
    info.pNext = &f12;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    std::vector<const char*> extensions;
    if (info_.common_clock) extensions.push_back(VK_EXT_CALIBRATED_TIMESTAMPS_EXTENSION_NAME);
    if (!options.surfaces.empty()) extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    info.enabledExtensionCount = uint32_t(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    check(vkCreateDevice(physical_, &info, nullptr, &device_), "creating the device");
    vkGetDeviceQueue(device_, queue_family_, 0, &queue_);
    if (info_.common_clock)
        callbacks_->clocks = reinterpret_cast<PFN_vkGetCalibratedTimestampsEXT>(vkGetDeviceProcAddr(device_, "vkGetCalibratedTimestampsEXT"));
    set_name(VK_OBJECT_TYPE_QUEUE, reinterpret_cast<uint64_t>(queue_), "compute queue");
}

Device::~Device() {
    for (const CommandSet& set : idle_commands_) {
        vkDestroyQueryPool(device_, set.queries, nullptr);
        vkDestroyFence(device_, set.fence, nullptr);
        vkDestroyCommandPool(device_, set.pool, nullptr);
    }
    for (auto& [key, making] : pipelines_) try {
            if (making.wait_for(std::chrono::seconds(0)) == std::future_status::deferred) continue;  // nobody has asked for it
            const Pipeline& pipeline = making.get();
            vkDestroyPipeline(device_, pipeline.pipeline, nullptr);
            vkDestroyPipelineLayout(device_, pipeline.layout, nullptr);
        } catch (const std::exception&) {  // it was never made, and whoever used it has heard so
        }
    if (device_) vkDestroyDevice(device_, nullptr);
    if (messenger_) {
        auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
        destroy(instance_, messenger_, nullptr);
    }
    if (instance_) vkDestroyInstance(instance_, nullptr);
}

std::optional<Device::Moment> Device::now() const {
    if (!callbacks_->clocks) return std::nullopt;
    VkCalibratedTimestampInfoEXT infos[2] = {{VK_STRUCTURE_TYPE_CALIBRATED_TIMESTAMP_INFO_EXT}, {VK_STRUCTURE_TYPE_CALIBRATED_TIMESTAMP_INFO_EXT}};
    infos[0].timeDomain = VK_TIME_DOMAIN_DEVICE_EXT;
    infos[1].timeDomain = VK_TIME_DOMAIN_CLOCK_MONOTONIC_EXT;
    uint64_t values[2], deviation;
    check(callbacks_->clocks(device_, 2, infos, values, &deviation), "reading the clocks");
    return Moment{values[0], std::chrono::steady_clock::time_point(std::chrono::nanoseconds(values[1]))};
}

void Device::reserve(const std::string& kind, const std::string& name, uint64_t bytes) {
    if (bytes > memory_limit_ || memory_now_ > memory_limit_ - bytes)
        throw OutOfMemory("\"" + name + "\" needs " + std::to_string(bytes >> 20) + " MiB, and " + std::to_string(memory_free() >> 20) +
                          " MiB of " + std::to_string(memory_limit_ >> 20) + " MiB are left; raise --memory-limit, or lower --vpls or --map-size");
    memory_now_ += bytes;
    MemoryUse& use = memory_[kind];
    use.now += bytes;
    use.peak = std::max(use.peak, use.now);
}

void Device::release(const std::string& kind, uint64_t bytes) {
    memory_now_ -= bytes;
    memory_[kind].now -= bytes;
}

void Device::reset_memory_peaks() {
    for (auto& [kind, use] : memory_) use.peak = use.now;
}

uint32_t Device::memory_type(uint32_t allowed, VkMemoryPropertyFlags wanted) const {
    for (uint32_t i = 0; i < memory_properties_.memoryTypeCount; ++i)
        if ((allowed & (1u << i)) && (memory_properties_.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
    throw DeviceError("device \"" + info_.name + "\" has no memory type for a buffer; use another with --device");
}

void Device::set_name(VkObjectType type, uint64_t object, const std::string& name) const {
    if (!callbacks_->set_name) return;
    VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
    info.objectType = type;
    info.objectHandle = object;
    info.pObjectName = name.c_str();
    callbacks_->set_name(device_, &info);
}

void Device::begin_label(VkCommandBuffer commands, const char* name) const {
    if (!callbacks_->begin_label) return;
    VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
    label.pLabelName = name;
    callbacks_->begin_label(commands, &label);
}

void Device::end_label(VkCommandBuffer commands) const {
    if (callbacks_->end_label) callbacks_->end_label(commands);
}

uint32_t Device::validation_messages() const { return callbacks_->messages; }

}  // namespace myriad::engine
