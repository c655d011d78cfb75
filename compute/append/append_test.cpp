#include "compute/append/append.hpp"

#include <algorithm>
#include <cstdlib>

#include "compute/append/append_ref.hpp"
#include "compute/kernels.hpp"
#include "engine/testing.hpp"

namespace myriad::compute {
namespace {

using engine::same;

constexpr int steps = 5;

struct Outcome {
    std::vector<uvec2> kept;
    AppendReport report;
};

class AppendTest : public engine::DeviceTest {
protected:
    Outcome run(engine::Device& on, AppendMode mode, uint items, uint64_t next_capacity, uint64_t kept_capacity) {
        const auto count = engine::upload(on, "test", "count", std::vector<uint>{items});
        AppendKernel sieve(on, engine::compute_kernels, "append/sieve");
        AppendLists lists(on, mode, next_capacity, kept_capacity);
        engine::Recorder recorder(on);
        lists.begin(recorder, sieve, count, 0, items);
        for (int step = 0; step < steps; ++step)
            lists.step(recorder, sieve, 1, [&](const AppendRef& ref) { return SievePush{.lists = ref, .first_step = step == 0}; });
        lists.end(recorder);
        recorder.submit_and_wait();
        Outcome outcome{.kept = {}, .report = lists.report()};
        outcome.kept = engine::download(on, lists.kept(), std::min<uint64_t>(outcome.report.kept, kept_capacity));
        return outcome;
    }
    // Grows the lists as a host must: until nothing overflows.
    Outcome run_growing(AppendMode mode, uint items, uint64_t next, uint64_t kept, int& redone) {
        for (redone = 0;; ++redone) {
            Outcome outcome = run(device, mode, items, next, kept);
            if (outcome.report.ok()) return outcome;
            EXPECT_LT(redone, 20) << "growing does not end";
            if (redone >= 20) return outcome;
            next = std::max(next, outcome.report.next_needed);
            kept = std::max(kept, outcome.report.kept_needed);
        }
    }
};

std::vector<uvec2> sorted(std::vector<uvec2> items) {
    std::sort(items.begin(), items.end(), [](auto a, auto b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
    return items;
}

constexpr uint sizes[] = {0, 1, 7, 8, 9, 63, 64, 65, 1023, 1024, 1025, 100000};

TEST_F(AppendTest, scan_mode_equals_the_twin_in_order) {
    for (uint items : sizes) {
        const SieveResult expected = sieve_ref(items, steps);
        const Outcome found = run(device, AppendMode::scan, items, 1 << 21, 1 << 21);
        EXPECT_TRUE(same(expected.kept, found.kept)) << items << " items";
        EXPECT_EQ(expected.processed, found.report.processed) << items << " items";
        EXPECT_EQ(expected.next_needed, found.report.next_needed) << items << " items";
    }
}

TEST_F(AppendTest, atomic_mode_equals_the_twin_as_a_set) {
    for (uint items : sizes) {
        const SieveResult expected = sieve_ref(items, steps);
        const Outcome found = run(device, AppendMode::atomic, items, 1 << 21, 1 << 21);
        EXPECT_TRUE(same(sorted(expected.kept), sorted(found.kept))) << items << " items";
        EXPECT_EQ(expected.processed, found.report.processed) << items << " items";
    }
}

TEST_F(AppendTest, scan_mode_gives_the_same_bits_every_time) {
    const auto first = run(device, AppendMode::scan, 50000, 1 << 20, 1 << 20).kept;
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(same(first, run(device, AppendMode::scan, 50000, 1 << 20, 1 << 20).kept));
}

TEST_F(AppendTest, growing_from_capacity_1_ends_with_the_same_lists) {
    const SieveResult expected = sieve_ref(1000, steps);
    for (AppendMode mode : {AppendMode::scan, AppendMode::atomic}) {
        int redone = 0;
        const Outcome found = run_growing(mode, 1000, 1000, 1, redone);
        EXPECT_TRUE(same(sorted(expected.kept), sorted(found.kept)));
        EXPECT_GT(redone, 0) << "the test did not overflow anything";
    }
}

TEST_F(AppendTest, overflow_is_reported_and_writes_nothing_out_of_bounds) {
    for (AppendMode mode : {AppendMode::scan, AppendMode::atomic}) {
        const Outcome next = run(device, mode, 1000, 1000, 1 << 20);
        EXPECT_TRUE(next.report.next_overflowed);
        EXPECT_GT(next.report.next_needed, 1000u);
        const Outcome kept = run(device, mode, 1000, 1 << 20, 10);
        EXPECT_TRUE(kept.report.kept_overflowed);
        EXPECT_FALSE(kept.report.next_overflowed);
        EXPECT_EQ(kept.report.kept_needed, sieve_ref(1000, steps).kept.size()) << "the exact need is known at once";
    }
}

TEST_F(AppendTest, exactly_full_is_not_an_overflow) {
    const SieveResult expected = sieve_ref(1000, steps);
    for (AppendMode mode : {AppendMode::scan, AppendMode::atomic}) {
        EXPECT_TRUE(run(device, mode, 1000, expected.next_needed, expected.kept.size()).report.ok());
        EXPECT_FALSE(run(device, mode, 1000, expected.next_needed, expected.kept.size() - 1).report.ok());
        EXPECT_FALSE(run(device, mode, 1000, expected.next_needed - 1, expected.kept.size()).report.ok());
    }
}

TEST_F(AppendTest, begin_clamps_to_the_rest_and_the_limit) {
    const auto count = on_device(std::vector<uint>{100});
    AppendKernel sieve(device, engine::compute_kernels, "append/sieve");
    AppendLists lists(device, AppendMode::scan, 1000, 1000);
    auto active = [&](uint first, uint limit) {
        engine::Recorder recorder(device);
        lists.begin(recorder, sieve, count, first, limit);
        lists.end(recorder);
        recorder.submit_and_wait();
        return lists.report().processed;
    };
    EXPECT_EQ(active(0, 1000), 100u);
    EXPECT_EQ(active(90, 1000), 10u);
    EXPECT_EQ(active(90, 7), 7u);
    EXPECT_EQ(active(100, 7), 0u);
    EXPECT_EQ(active(500, 7), 0u);
}

TEST_F(AppendTest, plain_groups_equal_subgroups) {
    setenv("MYRIAD_PLAIN_GROUPS", "1", 1);
    engine::Device plain({.select = "", .validation = true, .memory_limit = 0});
    unsetenv("MYRIAD_PLAIN_GROUPS");
    const SieveResult expected = sieve_ref(1000, steps);
    EXPECT_TRUE(same(expected.kept, run(plain, AppendMode::scan, 1000, 1 << 16, 1 << 16).kept));
    EXPECT_TRUE(same(sorted(expected.kept), sorted(run(plain, AppendMode::atomic, 1000, 1 << 16, 1 << 16).kept)));
    EXPECT_EQ(plain.validation_messages(), 0u);
}

}  // namespace
}  // namespace myriad::compute
