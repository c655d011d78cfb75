// A stable radix sort of 32- or 64-bit keys with a 32-bit payload; see README.md.
#pragma once

#include <optional>
#include <vector>

#include "compute/scan/scan.hpp"
#include "compute/sort/sort_io.h"

namespace myriad::compute {

// How the kernels work. What fits the device, unless tests or measurements ask for something else.
struct SortShape {
    bool lone_lanes;           // a tile is one invocation's, not a subgroup's
    uint digit_bits;           // at most
    uint tile;                 // items

    bool operator==(const SortShape&) const = default;
    // Lone lanes share nothing: small workgroups keep all cores of a CPU busy with short lists. A line of counters has as many columns.
    uint32_t workgroup_size() const { return lone_lanes ? 16 : 64; }
    uint32_t group_size(const engine::Device& device) const { return lone_lanes ? 1 : device.group_size(); }

    static SortShape of(const engine::Device& device);
    // Those to choose from, for measurements.
    static std::vector<SortShape> all(const engine::Device& device);
};

class Sort {
public:
    static constexpr uint64_t max_capacity = (uint64_t(1) << 28);

    // For up to `max_length` keys of 32 or 64 bits.
    Sort(engine::Device& device, uint64_t max_length, uint32_t key_bits, std::optional<SortShape> shape = {});

    // Where the sorted items are: in the caller's arrays or in the sort's own, which change with the next record().
    template <class Key>
    struct Sorted {
        const engine::Array<Key>& keys;
        const engine::Array<uint>& payload;
    };

    // Sorts the first min(length[length_index], max_length) items by the low `bits` bits of their keys; the others' order is kept. Both the caller's
    // arrays and the sort's own are written, and hold at least max_length elements.
    Sorted<uint> record(engine::Recorder& recorder, const engine::Array<uint>& keys, const engine::Array<uint>& payload,
                        const engine::Array<uint>& length, uint64_t length_index = 0, uint32_t bits = 32);
    // 64 bits: x is the low word.
    Sorted<uvec2> record(engine::Recorder& recorder, const engine::Array<uvec2>& keys, const engine::Array<uint>& payload,
                         const engine::Array<uint>& length, uint64_t length_index = 0, uint32_t bits = 64);

    static uint32_t passes(uint32_t bits, const SortShape& shape);
    // Device bytes of its own.
    uint64_t bytes() const { return keys_.bytes() + wide_keys_.bytes() + payload_.bytes() + counters_.bytes(); }

private:
    template <class Key>
    Sorted<Key> passes_over(engine::Recorder& recorder, const engine::Array<Key>& keys, const engine::Array<Key>& spare_keys,
                            const engine::Array<uint>& payload, const engine::Array<uint>& length, uint64_t length_index, uint32_t bits);

    SortShape shape_;
    uint64_t max_length_;
    uint32_t key_bits_;
    engine::Program setup_, count_, scatter_;
    Scan scan_;
    engine::Array<uint> keys_, payload_, counters_, counts_;  // the other place of keys and payload; counters of a pass
    engine::Array<uvec2> wide_keys_;
    engine::Array<DispatchArgs> args_;
};

}  // namespace myriad::compute
