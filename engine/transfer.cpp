#include "engine/transfer.hpp"

namespace myriad::engine {
namespace {

constexpr uint64_t staging_bytes = 64 << 20;

// Calls step(offset, length) for pieces that fit a staging buffer.
template <class Step>
void in_pieces(uint64_t bytes, Step step) {
    for (uint64_t offset = 0; offset < bytes; offset += staging_bytes) step(offset, std::min(staging_bytes, bytes - offset));
}

}  // namespace

void upload_bytes(Device& device, const void* from, const Buffer& to, uint64_t bytes) {
    if (bytes == 0) return;
    Buffer staging(device, "staging", "upload staging", std::min(bytes, staging_bytes), Location::host);
    Recorder recorder(device);
    in_pieces(bytes, [&](uint64_t offset, uint64_t length) {
        std::memcpy(staging.mapped(), static_cast<const char*>(from) + offset, length);
        recorder.copy(staging, to, length, 0, offset);
        recorder.submit_and_wait();
    });
}

void download_bytes(Device& device, const Buffer& from, void* to, uint64_t bytes, uint64_t first) {
    if (bytes == 0) return;
    Buffer staging(device, "staging", "download staging", std::min(bytes, staging_bytes), Location::host);
    Recorder recorder(device);
    in_pieces(bytes, [&](uint64_t offset, uint64_t length) {
        recorder.copy(from, staging, length, first + offset, 0);
        recorder.submit_and_wait();
        std::memcpy(static_cast<char*>(to) + offset, staging.mapped(), length);
    });
}

}  // namespace myriad::engine
