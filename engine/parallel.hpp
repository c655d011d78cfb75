// Host work on all cores. Results must not depend on how work is divided: each piece writes to places of its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

namespace myriad::engine {

// How many threads host work may use: MYRIAD_THREADS, or one a core.
uint32_t host_threads();

// Calls work(begin, end) for the pieces [0, piece), [piece, 2 piece) … of [0, count), each once, on at most `threads` threads
// (0: host_threads()), the caller's among them. The pieces do not depend on the number of threads, so what is summed up a
// piece at a time does not, either. When some throw, the exception of the first of them is thrown here, after all have ended.
void parallel_pieces(size_t count, size_t piece, const std::function<void(size_t begin, size_t end)>& work, uint32_t threads = 0);

}  // namespace myriad::engine
