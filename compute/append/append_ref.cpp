#include "compute/append/append_ref.hpp"

#include <algorithm>

namespace myriad::compute {

SieveResult sieve_ref(uint items, int steps) {
    SieveResult result;
    std::vector<uvec2> active, next;
    for (uint i = 0; i < items; ++i) active.push_back({i * 2654435761u >> 8, 0});
    for (int step = 0; step < steps; ++step) {
        result.processed += active.size();
        next.clear();
        for (const uvec2& item : active) {
            if (sieve_keeps(item)) result.kept.push_back(item);
            for (uint i = 0; i < sieve_copies(item); ++i) next.push_back(sieve_child(item, i));
        }
        result.next_needed = std::max<uint64_t>(result.next_needed, next.size());
        active = next;
    }
    result.processed += active.size();  // the device counts the list that is left, too
    return result;
}

}  // namespace myriad::compute
