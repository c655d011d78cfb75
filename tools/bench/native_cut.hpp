// The rival on the host: the same cuts by plain C++ with threads, to measure the device's kernels against.
//
// The same algorithms over the same tree in the same arithmetic, written the way that suits a CPU: the eight children of a
// block are decided in loops over eight floats, which the compiler turns into one AVX register each (this file alone is compiled
// for x86-64-v3); each thread appends to vectors of its own. The cut is the device's, node-view for node-view.
#pragma once

#include <cstdint>
#include <vector>

#include "compute/bsh/bsh_io.h"
#include "compute/views/view_io.h"

namespace myriad::tools {

// The tree's arrays on the host; see compute/bsh/bsh_io.h.
struct NativeTree {
    std::vector<vec4> frames;
    std::vector<uvec2> spheres;
    std::vector<uint> cones;
    uint leaves = 0, blocks = 0;
};

struct NativeCut {
    std::vector<uvec2> groups;     // compute/manylods/cut_io.h; order depends on the number of threads
    uint64_t node_views = 0;       // tested
    uint64_t peak_bytes = 0;       // of lists
};

// False where this processor cannot run what this file was compiled for.
bool native_available();

// Level by level, with an active list and a list of groups a thread.
NativeCut native_lists(const NativeTree& tree, const std::vector<View>& views, float epsilon, uint map_size, unsigned threads);

// One depth-first walk a view.
NativeCut native_depth_first(const NativeTree& tree, const std::vector<View>& views, float epsilon, uint map_size, unsigned threads);

}  // namespace myriad::tools
