// Exclusive prefix sum; see README.md.
#pragma once

#include "compute/scan/scan_io.h"
#include "engine/recorder.hpp"

namespace myriad::compute {

class Scan {
public:
    // For up to `max_length` items, at most 2^30 - 1.
    Scan(engine::Device& device, uint64_t max_length);

    // In place over values[0 .. n), n = min(length[length_index], max_length); writes the total to values[n].
    // `values` holds at least max_length + 1 elements.
    void record(engine::Recorder& recorder, const engine::Array<uint>& values, const engine::Array<uint>& length, uint64_t length_index = 0);

    uint64_t max_length() const { return max_length_; }

private:
    engine::Program setup_, reduce_, scan_;
    uint64_t max_length_;
    uint32_t levels_;
    engine::Array<uint> sums_[scan_max_levels];  // sums_[0] is unused: level 0 is the caller's
    engine::Array<uint> counts_;                 // items of each level
    engine::Array<DispatchArgs> args_;
};

}  // namespace myriad::compute
