// Moves data between host and device outside frames: scene upload, read-back of results, tests.
#pragma once

#include <algorithm>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "engine/recorder.hpp"

namespace myriad::engine {

// Copies through a staging buffer of at most 64 MiB, so that a big scene does not need its size twice.
void upload_bytes(Device& device, const void* from, const Buffer& to, uint64_t bytes);
void download_bytes(Device& device, const Buffer& from, void* to, uint64_t bytes, uint64_t offset = 0);

// A device array that holds `values`.
template <class T>
Array<T> upload(Device& device, std::string kind, std::string name, std::span<const T> values) {
    Array<T> array(device, std::move(kind), std::move(name), values.size());
    upload_bytes(device, values.data(), array, values.size_bytes());
    return array;
}
template <class T>
Array<T> upload(Device& device, std::string kind, std::string name, const std::vector<T>& values) {
    return upload(device, std::move(kind), std::move(name), std::span<const T>(values));
}

// The first `count` elements from `first` on (by default all).
template <class T>
std::vector<T> download(Device& device, const Array<T>& array, uint64_t count = ~uint64_t(0), uint64_t first = 0) {
    std::vector<T> values(std::min(count, array.count() - first));
    download_bytes(device, array, values.data(), values.size() * sizeof(T), first * sizeof(T));
    return values;
}

}  // namespace myriad::engine
