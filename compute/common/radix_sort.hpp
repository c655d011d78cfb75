// Sorting by integer keys, on the host, on all cores.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/parallel.hpp"

namespace myriad::compute {

// Sorts by the bits [low, high) of key(item), stably; so there is one result, whatever the number of threads. Least
// significant digit first, 11 bits a pass: as many buckets as a core's first cache holds counters for.
template <class Item, class Key>
void radix_sort(std::vector<Item>& items, Key key, int low, int high, uint32_t threads = 0) {
    constexpr int digit_bits = 11;
    constexpr size_t buckets = size_t(1) << digit_bits, least_piece = 1 << 16;
    const size_t count = items.size();
    if (count < 2) return;
    if (threads == 0) threads = engine::host_threads();
    const size_t piece = std::max(least_piece, (count + threads - 1) / threads), pieces = (count + piece - 1) / piece;
    std::vector<Item> spare(count);
    std::vector<std::array<size_t, buckets>> at(pieces);  // how many of a piece are in a bucket, then where its next one goes
    for (int shift = low; shift < high; shift += digit_bits) {
        const uint64_t mask = (uint64_t(1) << std::min(digit_bits, high - shift)) - 1;
        const auto digit = [&](const Item& item) { return size_t(key(item) >> shift & mask); };
        engine::parallel_pieces(count, piece, [&](size_t begin, size_t end) {
            auto& counts = at[begin / piece];
            counts.fill(0);
            for (size_t i = begin; i < end; ++i) ++counts[digit(items[i])];
        }, threads);
        size_t sum = 0;
        bool sorted = false;  // all in one bucket: nothing moves
        for (size_t bucket = 0; bucket < buckets; ++bucket) {
            const size_t first = sum;
            for (auto& counts : at) {
                const size_t here = counts[bucket];
                counts[bucket] = sum;
                sum += here;
            }
            sorted = sorted || sum - first == count;
        }
        if (sorted) continue;
        engine::parallel_pieces(count, piece, [&](size_t begin, size_t end) {
            auto& next = at[begin / piece];
            for (size_t i = begin; i < end; ++i) spare[next[digit(items[i])]++] = items[i];
        }, threads);
        items.swap(spare);
    }
}

}  // namespace myriad::compute
