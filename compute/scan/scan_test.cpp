#include "compute/scan/scan.hpp"

#include <cstdlib>

#include "compute/scan/scan_ref.hpp"
#include "engine/testing.hpp"

namespace myriad::compute {
namespace {

using engine::same;

class ScanTest : public engine::DeviceTest {
protected:
    // Scans `values` (without the spare element) at a capacity of `max_length`; elements behind the total keep a mark.
    std::vector<uint> run(engine::Device& on, std::vector<uint> values, uint64_t max_length) {
        const uint n = uint(values.size());
        values.resize(max_length + 1, 0xdeadbeef);
        auto array = engine::upload(on, "test", "scan values", values);
        auto length = engine::upload(on, "test", "scan length", std::vector<uint>{n});
        Scan scan(on, max_length);
        engine::Recorder recorder(on);
        scan.record(recorder, array, length);
        recorder.submit_and_wait();
        return engine::download(on, array);
    }
    std::vector<uint> expected(std::vector<uint> values, uint64_t max_length) {
        const size_t n = values.size();
        values.resize(max_length + 1, 0xdeadbeef);
        return scan_ref(values, n);
    }
    std::vector<uint> random_values(size_t n, uint below) {
        std::vector<uint> values(n);
        for (uint& v : values) v = random() % below;
        return values;
    }
};

TEST_F(ScanTest, twin_scans_a_hand_made_list) {
    EXPECT_TRUE(same(std::vector<uint>{0, 3, 3, 8, 9}, scan_ref({3, 0, 5, 1, 77}, 4)));
}

TEST_F(ScanTest, equals_the_twin_at_boundary_sizes) {
    for (size_t n : {0, 1, 2, 7, 8, 9, 27, 63, 64, 65, 1023, 1024, 1025, 2049, 65535, 65536, 65537}) {
        const auto values = random_values(n, 1000);
        EXPECT_TRUE(same(expected(values, n + 5), run(device, values, n + 5))) << "n = " << n;
    }
}

TEST_F(ScanTest, equals_the_twin_over_three_levels) {
    for (size_t n : {1024u * 1024 - 1, 1024u * 1024, 1024u * 1024 + 1, 13912615u}) {
        const auto values = random_values(n, 300);
        EXPECT_TRUE(same(expected(values, n), run(device, values, n))) << "n = " << n;
    }
}

TEST_F(ScanTest, short_list_in_a_large_capacity) {
    for (size_t n : {0, 1, 1025}) {
        const auto values = random_values(n, 1000);
        EXPECT_TRUE(same(expected(values, 3000000), run(device, values, 3000000))) << "n = " << n;
    }
}

TEST_F(ScanTest, sums_wrap) {
    const auto values = random_values(5000, ~0u);
    EXPECT_TRUE(same(expected(values, 5000), run(device, values, 5000)));
}

TEST_F(ScanTest, length_beyond_capacity_is_clamped) {
    auto array = on_device(std::vector<uint>(101, 1));
    auto length = on_device(std::vector<uint>{1000000});
    Scan scan(device, 100);
    engine::Recorder recorder(device);
    scan.record(recorder, array, length);
    recorder.submit_and_wait();
    EXPECT_EQ(engine::download(device, array).back(), 100u);
}

// 2^27 + 3 items: half a gigabyte, more than one dimension of workgroups and more than any storage-buffer descriptor.
TEST_F(ScanTest, beyond_2_to_the_27) {
    const size_t n = (size_t(1) << 27) + 3;
    std::vector<uint> values(n);
    for (size_t i = 0; i < n; ++i) values[i] = uint(i * 2654435761u >> 29);
    EXPECT_TRUE(same(expected(values, n), run(device, values, n)));
}

TEST_F(ScanTest, plain_groups_equal_subgroups) {
    setenv("MYRIAD_PLAIN_GROUPS", "1", 1);
    engine::Device plain({.select = "", .validation = true, .memory_limit = 0});
    unsetenv("MYRIAD_PLAIN_GROUPS");
    ASSERT_EQ(plain.group_size(), 1u);
    for (size_t n : {0, 1, 1025, 70000}) {
        const auto values = random_values(n, 1000);
        EXPECT_TRUE(same(expected(values, n), run(plain, values, n))) << "n = " << n;
    }
    EXPECT_EQ(plain.validation_messages(), 0u);
}

TEST_F(ScanTest, comparator_sees_one_wrong_element) {
    auto values = expected({1, 2, 3}, 3);
    auto wrong = values;
    wrong[1] += 1;
    EXPECT_FALSE(same(values, wrong));
    EXPECT_FALSE(same(values, std::vector<uint>{0, 1}));
}

}  // namespace
}  // namespace myriad::compute
