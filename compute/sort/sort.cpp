#include "compute/sort/sort.hpp"

#include <algorithm>
#include <utility>

#include "compute/kernels.hpp"

namespace myriad::compute {

using engine::compute_kernels;

namespace {

uint64_t counters_for(uint64_t length, const SortShape& shape) { return uint64_t(sort_columns(sort_tiles(uint(length), shape.tile))) << shape.digit_bits; }

engine::Constants constants(const engine::Device& device, uint32_t key_bits, const SortShape& shape) {
    const uint32_t groups = shape.lone_lanes ? 0 : (shape.workgroup_size() + device.group_size() - 1) / device.group_size();
    return {{0, shape.workgroup_size()}, {1, shape.lone_lanes}, {2, key_bits / 32}, {3, shape.tile}, {4, std::max(1u, groups << shape.digit_bits)}};
}

}  // namespace

SortShape SortShape::of(const engine::Device& device) {
    if (device.plain_groups() || device.info().type == "cpu") return {.lone_lanes = true, .digit_bits = 8, .tile = 2064};
    return {.lone_lanes = false, .digit_bits = 8, .tile = 1024};
}

std::vector<SortShape> SortShape::all(const engine::Device& device) {
    std::vector<SortShape> shapes;
    for (uint32_t digit_bits : {4, 6, 8, 11})
        for (uint32_t tile : {1040, 2064, 4112}) shapes.push_back({.lone_lanes = true, .digit_bits = digit_bits, .tile = tile});
    if (!device.plain_groups())
        for (uint32_t digit_bits : {4, 8}) shapes.push_back({.lone_lanes = false, .digit_bits = digit_bits, .tile = 1024});
    return shapes;
}

Sort::Sort(engine::Device& device, uint64_t max_length, uint32_t key_bits, std::optional<SortShape> shape)
    : shape_(shape.value_or(SortShape::of(device))), max_length_(max_length), key_bits_(key_bits), setup_(device, compute_kernels, "sort/setup"),
      count_(device, compute_kernels, "sort/count", constants(device, key_bits, shape_)),
      scatter_(device, compute_kernels, "sort/scatter", constants(device, key_bits, shape_)), scan_(device, counters_for(max_length, shape_)),
      payload_(device, "sort", "sort payload", max_length), counters_(device, "sort", "sort counters", counters_for(max_length, shape_) + 1),
      counts_(device, "sort", "sort counts", sort_counts), args_(device, "sort", "sort grid", 1) {
    assert(key_bits == 32 || key_bits == 64);
    assert(max_length <= max_capacity && shape_.digit_bits >= 1 && shape_.digit_bits <= sort_max_digit_bits);
    assert(shape_.tile + (1u << shape_.digit_bits) < 65535 && "a driver's budget of loop rounds");
    assert(shape_.lone_lanes || !device.plain_groups());
    if (key_bits == 32) keys_ = {device, "sort", "sort keys", max_length};
    else wide_keys_ = {device, "sort", "sort keys", max_length};
}

// No digit is in two words, so that counting reads one.
uint32_t Sort::passes(uint32_t bits, const SortShape& shape) {
    const auto of_word = [&](uint32_t b) { return (b + shape.digit_bits - 1) / shape.digit_bits; };
    return bits <= 32 ? of_word(bits) : of_word(32) + of_word(bits - 32);
}

template <class Key>
Sort::Sorted<Key> Sort::passes_over(engine::Recorder& recorder, const engine::Array<Key>& keys, const engine::Array<Key>& spare_keys,
                                    const engine::Array<uint>& payload, const engine::Array<uint>& length, uint64_t length_index, uint32_t bits) {
    assert(key_bits_ == 8 * sizeof(Key) && bits <= key_bits_);
    assert(keys.count() >= max_length_ && payload.count() >= max_length_);
    recorder.dispatch(setup_,
                      SortSetupPush{.item_count = recorder.read(length, length_index),
                                    .args = recorder.write(args_),
                                    .counts = recorder.write(counts_),
                                    .max_length = uint(max_length_),
                                    .tile = shape_.tile,
                                    .workgroup_size = shape_.workgroup_size(),
                                    .group_size = shape_.group_size(recorder.device())},
                      1);
    const engine::Array<Key>*from = &keys, *to = &spare_keys;
    const engine::Array<uint>*payload_from = &payload, *payload_to = &payload_;
    for (uint32_t word = 0; 32 * word < bits; ++word) {
        const uint32_t word_bits = std::min(32u, bits - 32 * word);
        uint32_t shift = 0;
        for (uint32_t left = passes(word_bits, shape_); left > 0; --left) {
            const uint32_t digit = (word_bits - shift + left - 1) / left;  // evenly
            const auto push = [&](bool scatters) {
                return SortPassPush{.keys_in = {recorder.read(*from).address},
                                    .payload_in = scatters ? recorder.read(*payload_from) : Uints{},
                                    .keys_out = {scatters ? recorder.write(*to).address : 0},
                                    .payload_out = scatters ? recorder.write(*payload_to) : Uints{},
                                    .counters = recorder.write(counters_),
                                    .count = recorder.read(counts_, sort_count_items),
                                    .word = word,
                                    .shift = shift,
                                    .bits = digit};
            };
            recorder.dispatch_indirect(count_, push(false), args_);
            scan_.record(recorder, counters_, counts_, digit);
            recorder.dispatch_indirect(scatter_, push(true), args_);
            std::swap(from, to), std::swap(payload_from, payload_to);
            shift += digit;
        }
    }
    return {*from, *payload_from};
}

Sort::Sorted<uint> Sort::record(engine::Recorder& recorder, const engine::Array<uint>& keys, const engine::Array<uint>& payload,
                                const engine::Array<uint>& length, uint64_t length_index, uint32_t bits) {
    return passes_over(recorder, keys, keys_, payload, length, length_index, bits);
}
Sort::Sorted<uvec2> Sort::record(engine::Recorder& recorder, const engine::Array<uvec2>& keys, const engine::Array<uint>& payload,
                                 const engine::Array<uint>& length, uint64_t length_index, uint32_t bits) {
    return passes_over(recorder, keys, wide_keys_, payload, length, length_index, bits);
}

}  // namespace myriad::compute
