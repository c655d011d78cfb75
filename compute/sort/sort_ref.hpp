// The plain CPU twin of the sort.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>
namespace myriad::compute {
struct SortItem {
    uint64_t key;
    uint32_t payload;
    bool operator==(const SortItem&) const = default;
};
// Stably, by the low `bits` bits of the keys of the first n items.
std::vector<SortItem> sort_ref(std::vector<SortItem> items, std::size_t n, uint32_t bits);
}
