#include "compute/scan/scan.hpp"

#include "compute/kernels.hpp"

namespace myriad::compute {

using engine::compute_kernels;

Scan::Scan(engine::Device& device, uint64_t max_length)
    : setup_(device, compute_kernels, "scan/setup"), reduce_(device, compute_kernels, "scan/reduce"),
      scan_(device, compute_kernels, "scan/scan"), max_length_(max_length),
      counts_(device, "scan", "scan level counts", scan_max_levels), args_(device, "scan", "scan grids", scan_max_levels) {
    assert(max_length < uint64_t(1) << 30);
    const ScanLevels levels = scan_levels(uint(max_length));
    levels_ = levels.count[1] <= 1 ? 1 : levels.count[2] <= 1 ? 2 : 3;
    for (uint32_t i = 1; i < levels_; ++i) sums_[i] = {device, "scan", "scan sums " + std::to_string(i), levels.count[i] + 1};
}

void Scan::record(engine::Recorder& recorder, const engine::Array<uint>& values, const engine::Array<uint>& length, uint64_t length_index) {
    assert(values.count() > max_length_);
    recorder.dispatch(setup_,
                      ScanSetupPush{.item_count = recorder.read(length, length_index),
                                    .args = recorder.write(args_),
                                    .counts = recorder.write(counts_),
                                    .max_length = uint(max_length_),
                                    .workgroup_size = reduce_.workgroup_size(),
                                    .group_size = recorder.device().group_size()},
                      1);
    auto items = [&](uint32_t level) { return level == 0 ? recorder.write(values) : recorder.write(sums_[level]); };
    for (uint32_t level = 0; level + 1 < levels_; ++level)
        recorder.dispatch_indirect(reduce_,
                                   ScanTilePush{.values = items(level), .sums = recorder.write(sums_[level + 1]),
                                                .count = recorder.read(counts_, level), .has_sums = 0},
                                   args_, level);
    for (uint32_t level = levels_; level-- > 0;) {
        const bool has_sums = level + 1 < levels_;
        recorder.dispatch_indirect(scan_,
                                   ScanTilePush{.values = items(level), .sums = has_sums ? recorder.read(sums_[level + 1]) : Uints{},
                                                .count = recorder.read(counts_, level), .has_sums = has_sums},
                                   args_, level);
    }
}

}  // namespace myriad::compute
