#include "compute/sort/sort_ref.hpp"

#include <algorithm>

namespace myriad::compute {

std::vector<SortItem> sort_ref(std::vector<SortItem> items, std::size_t n, uint32_t bits) {
    const uint64_t mask = bits >= 64 ? ~uint64_t(0) : (uint64_t(1) << bits) - 1;
    std::stable_sort(items.begin(), items.begin() + std::ptrdiff_t(n), [=](const SortItem& a, const SortItem& b) { return (a.key & mask) < (b.key & mask); });
    return items;
}

}  // namespace myriad::compute
