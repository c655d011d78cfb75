#include "compute/sort/sort.hpp"

#include <algorithm>
#include <cstdlib>

#include "compute/sort/sort_ref.hpp"
#include "engine/testing.hpp"

namespace myriad::compute {

static void PrintTo(const SortItem& item, std::ostream* out) { *out << std::hex << item.key << std::dec << " (" << item.payload << ")"; }

namespace {

using engine::same;

// Small tiles, so that few items are several; digits that divide neither 32 nor 63.
const SortShape lone{.lone_lanes = true, .digit_bits = 5, .tile = 64}, subgroups{.lone_lanes = false, .digit_bits = 5, .tile = 64};

class SortTest : public engine::DeviceTest {
protected:
    static std::vector<SortItem> with_places(const std::vector<uint64_t>& keys) {
        std::vector<SortItem> items;
        for (const uint64_t key : keys) items.push_back({key, uint32_t(items.size())});
        return items;
    }
    std::vector<uint64_t> random_keys(size_t n, uint64_t mask = ~uint64_t(0)) {
        std::vector<uint64_t> keys(n);
        for (uint64_t& key : keys) key = (uint64_t(random()) << 32 | random()) & mask;
        return keys;
    }

    // The first n of the items, sorted; the arrays have room for `max_length`.
    template <class Key>
    std::vector<SortItem> run(engine::Device& on, const std::vector<SortItem>& items, uint64_t max_length, uint32_t bits, std::optional<SortShape> shape,
                              std::optional<uint> length = {}) {
        std::vector<Key> keys(max_length);
        std::vector<uint> payload(max_length, 0xdeadbeef);
        for (size_t i = 0; i < items.size(); ++i) {
            if constexpr (sizeof(Key) == 4) keys[i] = uint(items[i].key);
            else keys[i] = {uint(items[i].key), uint(items[i].key >> 32)};
            payload[i] = items[i].payload;
        }
        auto key_array = engine::upload(on, "test", "keys", keys);
        auto payload_array = engine::upload(on, "test", "payload", payload);
        auto length_array = engine::upload(on, "test", "length", std::vector<uint>{77, length.value_or(uint(items.size()))});
        Sort sort(on, max_length, 8 * sizeof(Key), shape);
        engine::Recorder recorder(on);
        const auto sorted = sort.record(recorder, key_array, payload_array, length_array, 1, bits);
        recorder.submit_and_wait();
        keys = engine::download(on, sorted.keys, items.size());
        payload = engine::download(on, sorted.payload, items.size());
        std::vector<SortItem> out;
        for (size_t i = 0; i < items.size(); ++i) {
            if constexpr (sizeof(Key) == 4) out.push_back({keys[i], payload[i]});
            else out.push_back({uint64_t(keys[i].y) << 32 | keys[i].x, payload[i]});
        }
        return out;
    }

    // Both widths and the device's shape, lone lanes and subgroups.
    void check(const std::vector<uint64_t>& keys, uint32_t bits, const std::string& what, bool small = true) {
        std::vector<std::optional<SortShape>> shapes{std::nullopt};
        if (small) shapes.push_back(lone);
        if (small && !device.plain_groups()) shapes.push_back(subgroups);
        for (const auto& shape : shapes) {
            const std::string where = what + ", " + std::to_string(keys.size()) + " keys, " + std::to_string(bits) + " bits, " +
                                      (!shape ? "shape of the device" : shape->lone_lanes ? "lone lanes" : "subgroups");
            const auto items = with_places(keys);
            EXPECT_TRUE(same(sort_ref(items, items.size(), bits), run<uvec2>(device, items, items.size(), bits, shape))) << where;
            auto narrow = items;
            for (SortItem& item : narrow) item.key &= 0xffffffff;
            const uint32_t narrow_bits = std::min(bits, 32u);
            EXPECT_TRUE(same(sort_ref(narrow, narrow.size(), narrow_bits), run<uint>(device, narrow, narrow.size(), narrow_bits, shape))) << where;
        }
    }
};

TEST_F(SortTest, twin_sorts_a_hand_made_list) {
    EXPECT_TRUE(same(std::vector<SortItem>{{0x10, 1}, {0x21, 2}, {0x01, 3}, {0x12, 0}, {0, 9}},
                     sort_ref({{0x12, 0}, {0x10, 1}, {0x21, 2}, {0x01, 3}, {0, 9}}, 4, 4)));
}

TEST_F(SortTest, passes_keep_to_words) {
    const SortShape bytes{.lone_lanes = true, .digit_bits = 8, .tile = 64};
    const std::pair<uint32_t, uint32_t> expected[] = {{0, 0}, {1, 1}, {8, 1}, {9, 2}, {32, 4}, {33, 5}, {63, 8}, {64, 8}};
    for (const auto& [bits, passes] : expected) EXPECT_EQ(Sort::passes(bits, bytes), passes) << bits << " bits";
    EXPECT_EQ(Sort::passes(35, lone), 8u);  // 32 bits by 5, and 3
}

TEST_F(SortTest, equals_the_twin_at_boundary_sizes) {
    for (size_t n : {0, 1, 2, 7, 8, 9, 63, 64, 65, 127, 128, 129, 1000, 4095, 4096, 4097}) check(random_keys(n), 64, "random");
    for (size_t n : {1023, 1024, 1025, 2063, 2064, 2065, 20000, 16 * 2064 - 1, 16 * 2064, 16 * 2064 + 1, 131073}) check(random_keys(n), 64, "random", false);
}

TEST_F(SortTest, a_million) { check(random_keys(1 << 20), 63, "random", false); }

TEST_F(SortTest, equal_keys_keep_their_order) {
    check(std::vector<uint64_t>(5000, 0x123456789abcdef0), 64, "all equal");
    check(random_keys(5000, 3), 64, "four values");
    check(random_keys(5000, 0x8000000000000001), 64, "lowest and highest bit");
}

TEST_F(SortTest, sorted_and_reversed) {
    auto keys = random_keys(5000);
    std::sort(keys.begin(), keys.end());
    check(keys, 64, "sorted");
    std::reverse(keys.begin(), keys.end());
    check(keys, 64, "reversed");
}

TEST_F(SortTest, any_number_of_bits) {
    const auto keys = random_keys(1500);
    for (uint32_t bits : {0, 1, 4, 5, 6, 7, 8, 9, 11, 24, 31, 32, 33, 37, 40, 63}) check(keys, bits, "random");
    check(random_keys(1500, 0xffffffff00000000), 64, "high word only");
    check(random_keys(1500, 0x7fff000000000000), 63, "highest bits only");
}

TEST_F(SortTest, the_length_is_the_devices) {
    const auto items = with_places(random_keys(3000));
    for (const auto& shape : {std::optional<SortShape>(), std::optional(lone)}) {
        const auto sorted = run<uvec2>(device, items, 10000, 64, shape);  // fewer than there is room for
        EXPECT_TRUE(same(sort_ref(items, items.size(), 64), sorted));
        const auto clamped = run<uvec2>(device, items, 3000, 64, shape, 1000000);  // more than that
        EXPECT_TRUE(same(sort_ref(items, items.size(), 64), clamped));
    }
}

// Two passes end in the caller's arrays: what lies behind the length is as it was.
TEST_F(SortTest, leaves_alone_what_is_behind) {
    const auto items = with_places(random_keys(500));
    auto expected = items;
    for (SortItem& item : expected) item.key &= 0xffffffff;
    const auto sorted = run<uint>(device, expected, 500, 10, lone, 200);
    EXPECT_TRUE(same(sort_ref(expected, 200, 10), sorted));
}

TEST_F(SortTest, used_twice_in_a_frame) {
    const auto keys = random_keys(3000);
    std::vector<uint> narrow(keys.begin(), keys.end()), places(3000);
    for (uint i = 0; i < 3000; ++i) places[i] = i;
    const auto length = on_device(std::vector<uint>{3000});
    const auto a = on_device(narrow), b = on_device(narrow), pa = on_device(places), pb = on_device(places);
    Sort sort(device, 3000, 32, lone);
    engine::Recorder recorder(device);
    sort.record(recorder, a, pa, length, 0, 30);  // six passes
    sort.record(recorder, b, pb, length, 0, 10);
    recorder.submit_and_wait();
    const auto items = with_places({narrow.begin(), narrow.end()});
    const auto check_payload = [&](const auto& array, uint32_t bits) {
        std::vector<uint> expected;
        for (const SortItem& item : sort_ref(items, 3000, bits)) expected.push_back(item.payload);
        EXPECT_TRUE(same(expected, engine::download(device, array)));
    };
    check_payload(pa, 30), check_payload(pb, 10);
}

TEST_F(SortTest, plain_groups_equal_subgroups) {
    setenv("MYRIAD_PLAIN_GROUPS", "1", 1);
    engine::Device plain({.select = "", .validation = true, .memory_limit = 0});
    unsetenv("MYRIAD_PLAIN_GROUPS");
    ASSERT_EQ(plain.group_size(), 1u);
    for (size_t n : {0, 1, 1025, 70000}) {
        const auto items = with_places(random_keys(n));
        EXPECT_TRUE(same(sort_ref(items, n, 64), run<uvec2>(plain, items, n, 64, {}))) << "n = " << n;
    }
    EXPECT_EQ(plain.validation_messages(), 0u);
}

TEST_F(SortTest, comparator_sees_one_wrong_item) {
    const auto items = sort_ref(with_places(random_keys(100, 3)), 100, 64);
    auto wrong = items;
    std::swap(wrong[50].payload, wrong[51].payload);  // equal keys, or nearly: only the payload tells
    EXPECT_FALSE(same(items, wrong));
    wrong = items;
    wrong[99].key ^= uint64_t(1) << 63;
    EXPECT_FALSE(same(items, wrong));
}

}  // namespace
}  // namespace myriad::compute
