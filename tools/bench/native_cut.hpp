// The rival on the host: the same cuts by plain C++ with threads, to measure the device's kernels against.
//
// The same algorithms over the same tree in the same arithmetic, written the way that suits a CPU: the children of a block are
// decided in loops over so many floats, of which the compiler turns eight into one AVX register each (this file alone is compiled
// for x86-64-v3); each thread appends to vectors of its own. The cut is the device's, node-view for node-view.
#pragma once

#include <cstdint>
#include <vector>

#include "compute/bsh/bsh_io.h"
#include "compute/views/view_io.h"

namespace myriad::tools {

// The tree's arrays on the host; see compute/bsh/bsh_io.h.
struct NativeTree : BshShape {
    std::vector<vec4> frames;
    std::vector<uvec2> spheres;
    std::vector<uint> cones;
};

// False where this processor cannot run what this file was compiled for.
bool native_available();

// Cuts by several threads; views are dealt out evenly. Lists keep their memory from run to run, as the device's do.
class NativeCuts {
public:
    explicit NativeCuts(unsigned threads) : lists_(threads) {}

    // Level by level, with an active list and a list of groups a thread.
    void lists(const NativeTree& tree, const std::vector<View>& views, float epsilon, uint map_size);
    // One depth-first walk a view.
    void depth_first(const NativeTree& tree, const std::vector<View>& views, float epsilon, uint map_size);

    unsigned threads() const { return unsigned(lists_.size()); }
    // Of the last run: groups (compute/manylods/cut_io.h) of one thread, node-views tested, and the bytes of all lists.
    const std::vector<uvec2>& groups(unsigned thread) const { return lists_[thread].kept; }
    uint64_t node_views() const;
    uint64_t bytes() const;

private:
    struct alignas(64) Lists {
        std::vector<uvec2> items, next, kept;
        std::vector<uint> stack;
        uint64_t node_views = 0;
    };
    template <uint arity> void lists_of(const NativeTree& tree, const std::vector<View>& views, float epsilon, uint map_size);
    template <uint arity> void depth_first_of(const NativeTree& tree, const std::vector<View>& views, float epsilon, uint map_size);
    template <class Work> void parallel(size_t views, Work work);
    void keep(Lists& out, uint block, uint view, uint found);

    std::vector<Lists> lists_;
};

}  // namespace myriad::tools
