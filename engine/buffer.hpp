// Device memory: a named buffer, counted by kind, and a typed array on top of it.
#pragma once

#include <cassert>
#include <span>
#include <string>
#include <utility>

#include "engine/device.hpp"
#include "engine/shared.h"

namespace myriad::engine {

enum class Location {
    device,  // where the device reads fastest; filled and read by copies
    host,    // mapped and coherent: staging, read-back, status words
};

class Recorder;

class Buffer {
public:
    Buffer() = default;
    // `kind` is what memory is accounted under. Throws OutOfMemory. A buffer of 0 bytes is valid and holds 16.
    Buffer(Device& device, std::string kind, std::string name, uint64_t bytes, Location location = Location::device);
    ~Buffer() { destroy(); }
    Buffer(Buffer&& other) noexcept { swap(other); }
    Buffer& operator=(Buffer&& other) noexcept { Buffer(std::move(other)).swap(*this); return *this; }

    explicit operator bool() const { return buffer_ != VK_NULL_HANDLE; }
    VkBuffer handle() const { return buffer_; }
    uint64_t bytes() const { return bytes_; }
    const std::string& name() const { return name_; }
    void* mapped() const { return mapped_; }  // null for Location::device

private:
    friend class Recorder;  // the only one that hands out addresses, because whoever asks must say what for
    void swap(Buffer& other) noexcept;
    void destroy();

    Device* device_ = nullptr;
    VkBuffer buffer_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    uint64_t address_ = 0, bytes_ = 0, reserved_ = 0;
    void* mapped_ = nullptr;
    std::string kind_, name_;
};

// `count` elements of T. T is trivially copyable and laid out as in the shared header that declares it.
template <class T>
class Array : public Buffer {
public:
    Array() = default;
    Array(Device& device, std::string kind, std::string name, uint64_t count, Location location = Location::device)
        : Buffer(device, std::move(kind), std::move(name), count * sizeof(T), location), count_(count) {}

    uint64_t count() const { return count_; }
    std::span<T> span() const {
        assert(mapped());
        return {static_cast<T*>(mapped()), count_};
    }

private:
    uint64_t count_ = 0;
};

}  // namespace myriad::engine
