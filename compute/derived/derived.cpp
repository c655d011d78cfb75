#include "compute/derived/derived.hpp"

#include <embree3/rtcore.h>

#include <bit>
#include <memory>

namespace myriad::compute {
namespace {

template <class T>
engine::Bytes bytes(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    return std::as_bytes(values);
}
template <class T>
engine::Bytes bytes(const std::vector<T>& values) { return bytes(std::span<const T>(values)); }
template <class T>
engine::Bytes bytes(const T& value) { return bytes(std::span<const T>(&value, 1)); }

// Embree builds the trees, and another version may be installed tomorrow.
uint64_t builder_version() {
    const std::unique_ptr<RTCDeviceTy, void (*)(RTCDevice)> device(rtcNewDevice("threads=1"), rtcReleaseDevice);
    return uint64_t(rtcGetDeviceProperty(device.get(), RTC_DEVICE_PROPERTY_VERSION));
}

struct BvhScalars {
    uint32_t depth, dropped, asks;
};
struct LeavesScalars {
    double area;
    float radius;
    uint32_t reserved;
};

// nullopt when these are no tree's parts: then the entry is not one of ours.
std::optional<BvhParts> bvh_parts(const engine::CacheEntry& entry) {
    if (entry.parts() != 4 || entry.array<BvhScalars>(3).size() != 1) return std::nullopt;
    BvhParts parts;
    parts.nodes = entry.array<BvhNode>(0);
    parts.triangles = entry.array<BvhTriangle>(1);
    parts.instances = entry.array<Instance>(2);
    parts.depth = entry.array<BvhScalars>(3)[0].depth;
    parts.dropped = entry.array<BvhScalars>(3)[0].dropped;
    parts.asks = entry.array<BvhScalars>(3)[0].asks != 0;
    if (parts.nodes.empty()) return std::nullopt;
    return parts;
}

}  // namespace

Derived::Derived(WorldTriangles world, engine::Cache* cache)
    : world_(std::move(world)), cache_(engine::program_id().empty() ? nullptr : cache) {
    if (!cache_) return;
    const uint64_t version = builder_version();
    const uint32_t first_moving = world_.moves() ? world_.first_moving : ~0u;
    const auto opacity = world_.opacity.content();
    const engine::Bytes parts[] = {engine::program_id(), bytes(version), bytes(world_.positions), bytes(world_.triangles), bytes(world_.instances),
                                   bytes(first_moving), opacity[0], opacity[1], opacity[2], opacity[3], opacity[4]};
    content_ = engine::digest(parts);
}

std::string Derived::name(const char* kind, std::initializer_list<uint64_t> numbers) const {
    const engine::Bytes parts[] = {bytes(std::span<const char>(kind, std::char_traits<char>::length(kind))), bytes(content_),
                                   bytes(std::span<const uint64_t>(numbers.begin(), numbers.size()))};
    return std::string(kind) + "-" + engine::hex(engine::digest(parts));
}

Bvh Derived::bvh(engine::Device& device, BvhQuality quality, OpacityReader opacity) {
    if (!cache_) return {device, world_, quality, std::move(opacity)};
    const std::string entry_name = name("rays", {uint64_t(quality)});
    if (const auto entry = cache_->find(entry_name))
        if (const auto parts = bvh_parts(*entry)) return {device, world_, *parts, std::move(opacity)};
    const BvhData data = build_bvh(world_, quality);
    const BvhScalars scalars{data.depth, data.dropped, data.asks};
    const engine::Bytes parts[] = {bytes(data.nodes), bytes(data.triangles), bytes(data.instances), bytes(scalars)};
    cache_->store(entry_name, parts);
    return {device, world_, data, std::move(opacity)};
}

Bsh Derived::bsh(engine::Device& device, uint32_t log2_samples, uint32_t seed, uint arity) {
    check_bsh_size(log2_samples, arity);  // before the samples are made
    if (!cache_) return {device, world_, log2_samples, seed, arity};
    const std::string entry_name = name("leaves", {log2_samples, seed});
    if (const auto entry = cache_->find(entry_name); entry && entry->parts() == 2) {
        const auto samples = entry->array<SurfaceSample>(0);
        const auto scalars = entry->array<LeavesScalars>(1);
        if (scalars.size() == 1 && (samples.empty() || samples.size() == uint64_t(1) << log2_samples))
            return {device, world_, samples, scalars[0].area, scalars[0].radius, arity};
    }
    const BshLeaves leaves = bsh_leaves(world_, log2_samples, seed);
    const LeavesScalars scalars{leaves.area, leaves.radius, 0};
    const engine::Bytes parts[] = {bytes(leaves.samples), bytes(scalars)};
    cache_->store(entry_name, parts);
    return {device, world_, leaves, arity};
}

SurfaceSampling Derived::samples(uint32_t log2_samples, uint32_t seed) {
    if (!cache_) return sample_surface(world_, log2_samples, seed);
    const std::string entry_name = name("samples", {log2_samples, seed});
    if (const auto entry = cache_->find(entry_name); entry && entry->parts() == 2) {
        const auto samples = entry->array<SurfaceSample>(0);
        const auto scalars = entry->array<LeavesScalars>(1);
        if (scalars.size() == 1 && (samples.empty() || samples.size() == uint64_t(1) << log2_samples))
            return {{samples.begin(), samples.end()}, scalars[0].area, scalars[0].radius};
    }
    SurfaceSampling sampling = sample_surface(world_, log2_samples, seed);
    const LeavesScalars scalars{sampling.area, sampling.radius, 0};
    const engine::Bytes parts[] = {bytes(sampling.samples), bytes(scalars)};
    cache_->store(entry_name, parts);
    return sampling;
}

}  // namespace myriad::compute
