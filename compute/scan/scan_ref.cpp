#include "compute/scan/scan_ref.hpp"

namespace myriad::compute {

std::vector<uint32_t> scan_ref(std::vector<uint32_t> values, size_t n) {
    uint32_t running = 0;
    for (size_t i = 0; i < n; ++i) {
        const uint32_t value = values[i];
        values[i] = running;
        running += value;
    }
    values[n] = running;
    return values;
}

}  // namespace myriad::compute
