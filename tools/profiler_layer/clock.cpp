#include "tools/profiler_layer/device.hpp"

namespace myriad::profiler {
namespace {

constexpr double second_ns = 1e9;

int64_t signed_difference(uint64_t later, uint64_t earlier, uint32_t valid_bits) {
    const uint32_t unused = 64 - valid_bits;
    return static_cast<int64_t>((later - earlier) << unused) >> unused;
}

}  // namespace

void Clock::start(const Device& device, double period_ns, bool calibrated) {
    device_ = &device, period_ns_ = period_ns, calibrated_ = calibrated;
    if (calibrated_) read_both();
}

// The steady clock is CLOCK_MONOTONIC in the C++ libraries of Linux.
void Clock::read_both() {
    VkCalibratedTimestampInfoEXT infos[2] = {{VK_STRUCTURE_TYPE_CALIBRATED_TIMESTAMP_INFO_EXT}, {VK_STRUCTURE_TYPE_CALIBRATED_TIMESTAMP_INFO_EXT}};
    infos[0].timeDomain = VK_TIME_DOMAIN_DEVICE_EXT;
    infos[1].timeDomain = VK_TIME_DOMAIN_CLOCK_MONOTONIC_EXT;
    uint64_t values[2], deviation;
    if (device_->next.GetCalibratedTimestampsEXT(device_->handle, 2, infos, values, &deviation) != VK_SUCCESS) return;
    ticks_ = values[0], at_ns_ = double(values[1]), placed_ = true;
}

double Clock::host_ns(uint64_t ticks, uint32_t valid_bits, double submitted_ns) {
    if (calibrated_ && now_ns() - at_ns_ > second_ns) read_both();
    const auto placed = [&] { return at_ns_ + double(signed_difference(ticks, ticks_, valid_bits)) * period_ns_; };
    // Without a common clock, nothing that a device did may lie before its submission.
    if (!placed_ || (!calibrated_ && placed() < submitted_ns)) ticks_ = ticks, at_ns_ = submitted_ns, placed_ = true;
    return placed();
}

}  // namespace myriad::profiler
