// What identifies bytes: SHA-256, from libcrypto.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace myriad::engine {

using Digest = std::array<uint8_t, 32>;
using Bytes = std::span<const std::byte>;

// Of some arrays, their lengths and their order. SHA-256 over the lengths and the SHA-256s of pieces of 1 MiB, so that all
// cores take part. Nobody finds other bytes of the same digest, whatever he puts into a scene.
Digest digest(std::span<const Bytes> parts, uint32_t threads = 0);

std::string hex(const Digest& digest);

// The program that runs, by its linker's build id: another for other sources, compilers or options. Empty where the linker
// wrote none.
Bytes program_id();

}  // namespace myriad::engine
