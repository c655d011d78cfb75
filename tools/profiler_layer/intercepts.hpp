// The functions that the layer stands in for, by name. A file each for its group; layer.cpp looks names up in all of them.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "tools/profiler_layer/registry.hpp"

namespace myriad::profiler {

struct Intercept {
    const char* name;
    PFN_vkVoidFunction function;
};

// What newer devices have as core, older ones have as …KHR: both names are one function.
#define MYRIAD_INTERCEPT(name) {"vk" #name, reinterpret_cast<PFN_vkVoidFunction>(&name)}
#define MYRIAD_INTERCEPT_KHR(name) MYRIAD_INTERCEPT(name), {"vk" #name "KHR", reinterpret_cast<PFN_vkVoidFunction>(&name)}

std::span<const Intercept> work_intercepts();        // dispatches, draws, copies: work.cpp
std::span<const Intercept> region_intercepts();      // labels, render passes, names: regions.cpp
std::span<const Intercept> lifetime_intercepts();    // command buffers and memory: lifetimes.cpp
std::span<const Intercept> submission_intercepts();  // queues and fences: submissions.cpp

}  // namespace myriad::profiler
