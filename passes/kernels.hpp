// The kernels embedded in this room.
#pragma once
#include "engine/kernels.hpp"
namespace myriad::engine {
extern const KernelTable passes_kernels;
}
