// The plain CPU twin: the sieve over plain vectors, in the order that the scan mode promises.
#pragma once
#include "compute/append/sieve_io.h"
#include <vector>
namespace myriad::compute {
struct SieveResult {
    std::vector<uvec2> kept;
    uint64_t next_needed = 0, processed = 0;
};
SieveResult sieve_ref(uint items, int steps);
}
