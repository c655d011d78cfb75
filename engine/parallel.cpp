#include "engine/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace myriad::engine {

uint32_t host_threads() {
    static const uint32_t threads = [] {
        const char* wanted = std::getenv("MYRIAD_THREADS");
        const long number = wanted ? std::strtol(wanted, nullptr, 10) : 0;
        return number > 0 ? uint32_t(std::min(number, 256L)) : std::max(1u, std::thread::hardware_concurrency());
    }();
    return threads;
}

void parallel_pieces(size_t count, size_t piece, const std::function<void(size_t, size_t)>& work, uint32_t threads) {
    assert(piece > 0);
    const size_t pieces = (count + piece - 1) / piece;
    std::atomic<size_t> next = 0;
    std::mutex mutex;
    std::exception_ptr error;
    size_t failed = pieces;  // the first piece that threw
    const auto take = [&] {
        for (size_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < pieces;) try {
                work(i * piece, std::min(count, (i + 1) * piece));
            } catch (...) {
                const std::lock_guard lock(mutex);
                if (i < failed) failed = i, error = std::current_exception();
            }
    };
    std::vector<std::thread> others;
    const size_t useful = std::min<size_t>(threads ? threads : host_threads(), pieces);
    for (size_t i = 1; i < useful; ++i) try {
            others.emplace_back(take);
        } catch (const std::exception&) {
            break;  // no more threads to be had, or no memory for one: fewer do the same
        }
    take();
    for (std::thread& other : others) other.join();
    if (error) std::rethrow_exception(error);
}

}  // namespace myriad::engine
