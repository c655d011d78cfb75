// The kernels that a room embeds: SPIR-V words by name, "FOLDER/STEM". The tables are written by engine/rooms.cmake.
#pragma once

#include <cstdint>
#include <vector>

namespace myriad::engine {

struct EmbeddedKernel {
    const char* name;
    const uint32_t *begin, *end;
};
using KernelTable = std::vector<EmbeddedKernel>;

}  // namespace myriad::engine
