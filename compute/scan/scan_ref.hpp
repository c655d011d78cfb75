// The plain CPU twin of the scan.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>
namespace myriad::compute {
// values[0 .. n) and one spare element -> exclusive prefix sums and the total, modulo 2^32.
std::vector<uint32_t> scan_ref(std::vector<uint32_t> values, size_t n);
}
