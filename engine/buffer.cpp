#include "engine/buffer.hpp"

#include <algorithm>

namespace myriad::engine {

Buffer::Buffer(Device& device, std::string kind, std::string name, uint64_t bytes, Location location)
    : device_(&device), bytes_(bytes), kind_(std::move(kind)), name_(std::move(name)) {
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = std::max<uint64_t>(bytes, 16);
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT |
                 VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    device.reserve(kind_, name_, info.size);
    reserved_ = info.size;
    try {
        check(vkCreateBuffer(device.handle(), &info, nullptr, &buffer_), "creating a buffer");
        VkMemoryRequirements requirements;
        vkGetBufferMemoryRequirements(device.handle(), buffer_, &requirements);
        VkMemoryAllocateFlagsInfo flags{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
        flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
        VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
        allocate.pNext = &flags;
        allocate.allocationSize = requirements.size;
        allocate.memoryTypeIndex = device.memory_type(
            requirements.memoryTypeBits, location == Location::host
                                             ? VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT
                                             : VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
        check(vkAllocateMemory(device.handle(), &allocate, nullptr, &memory_), ("allocating \"" + name_ + "\"").c_str());
        check(vkBindBufferMemory(device.handle(), buffer_, memory_, 0), "binding a buffer");
        if (location == Location::host)
            check(vkMapMemory(device.handle(), memory_, 0, VK_WHOLE_SIZE, 0, &mapped_), "mapping a buffer");
    } catch (...) {
        destroy();
        throw;
    }
    VkBufferDeviceAddressInfo address{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO};
    address.buffer = buffer_;
    address_ = vkGetBufferDeviceAddress(device.handle(), &address);
    device.set_name(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<uint64_t>(buffer_), name_);
    device.set_name(VK_OBJECT_TYPE_DEVICE_MEMORY, reinterpret_cast<uint64_t>(memory_), name_);
}

void Buffer::swap(Buffer& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(buffer_, other.buffer_);
    std::swap(memory_, other.memory_);
    std::swap(address_, other.address_);
    std::swap(bytes_, other.bytes_);
    std::swap(reserved_, other.reserved_);
    std::swap(mapped_, other.mapped_);
    std::swap(kind_, other.kind_);
    std::swap(name_, other.name_);
}

void Buffer::destroy() {
    if (!device_) return;
    vkDestroyBuffer(device_->handle(), buffer_, nullptr);
    vkFreeMemory(device_->handle(), memory_, nullptr);
    device_->release(kind_, reserved_);
    device_ = nullptr;
    buffer_ = VK_NULL_HANDLE;
    memory_ = VK_NULL_HANDLE;
}

}  // namespace myriad::engine
