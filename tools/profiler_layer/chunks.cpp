#include "tools/profiler_layer/device.hpp"

namespace myriad::profiler {

VkQueryPool QueryChunks::take() {
    const std::lock_guard lock(mutex_);
    if (!idle_.empty()) {
        const VkQueryPool chunk = idle_.back();
        idle_.pop_back();
        return chunk;
    }
    VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = size;
    VkQueryPool chunk = VK_NULL_HANDLE;
    if (device_.next.CreateQueryPool(device_.handle, &info, nullptr, &chunk) != VK_SUCCESS) return VK_NULL_HANDLE;
    all_.push_back(chunk);
    return chunk;
}

void QueryChunks::give_back(VkQueryPool chunk) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(chunk);
}

void QueryChunks::destroy() {
    const std::lock_guard lock(mutex_);
    for (const VkQueryPool chunk : all_) device_.next.DestroyQueryPool(device_.handle, chunk, nullptr);
    all_.clear(), idle_.clear();
}

}  // namespace myriad::profiler
