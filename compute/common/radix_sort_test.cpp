#include "compute/common/radix_sort.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace myriad::compute {
namespace {

struct Item {
    uint64_t key;
    uint32_t was;
    bool operator==(const Item&) const = default;
};

// Against the library's stable sort. Few different keys make many equals; 200,000 items are several pieces.
TEST(radix_sort, equals_a_stable_sort_whatever_the_threads) {
    std::mt19937_64 random(1);
    for (const size_t count : {0, 1, 2, 1000, 65536, 65537, 200000})
        for (const uint64_t mask : {~uint64_t(0), uint64_t(0xff00ff), uint64_t(3) << 62, uint64_t(0)})
            for (const auto& [low, high] : {std::pair(0, 64), {32, 64}, {30, 63}, {5, 6}}) {
                std::vector<Item> items(count);
                for (uint32_t i = 0; i < count; ++i) items[i] = {random() & mask, i};
                std::vector<Item> expected = items;
                const auto bits = [low = low, high = high](const Item& i) { return high - low == 64 ? i.key : i.key >> low & ((uint64_t(1) << (high - low)) - 1); };
                std::ranges::stable_sort(expected, {}, bits);
                for (const uint32_t threads : {1, 2, 5}) {
                    std::vector<Item> sorted = items;
                    radix_sort(sorted, [](const Item& i) { return i.key; }, low, high, threads);
                    ASSERT_TRUE(sorted == expected) << count << " items, bits " << low << " to " << high << ", " << threads << " threads";
                }
            }
}

}  // namespace
}  // namespace myriad::compute
