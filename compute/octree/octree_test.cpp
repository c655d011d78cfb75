#include "compute/octree/octree.hpp"

#include <algorithm>
#include <cstdlib>
#include <memory>

#include "compute/kernels.hpp"
#include "compute/octree/octree_ref.hpp"
#include "engine/testing.hpp"

namespace myriad::compute {
namespace {

using engine::same;

uint64_t wide(uvec2 key) { return uint64_t(key.y) << 32 | key.x; }

// Small tiles, so that few items are several.
const SortShape lone{.lone_lanes = true, .digit_bits = 6, .tile = 64}, subgroups{.lone_lanes = false, .digit_bits = 6, .tile = 64};

class OctreeTest : public engine::DeviceTest {
protected:
    std::vector<uint64_t> random_keys(size_t n, uint depth, uint64_t mask = ~uint64_t(0)) {
        std::vector<uint64_t> keys(n);
        for (uint64_t& key : keys) key = (uint64_t(random()) << 32 | random()) & mask & ((uint64_t(1) << 3 * depth) - 1);
        return keys;
    }
    // Near each other, as surfaces and views are: steps of few bits.
    std::vector<uint64_t> clustered_keys(size_t n, uint depth) {
        auto keys = random_keys(n, depth);
        for (size_t i = 1; i < n; ++i)
            if (const uint low = random() % (3 * depth + 1); random() % 8) keys[i] = keys[i - 1] ^ (keys[i] & ((uint64_t(1) << low) - 1));
        return keys;
    }

    std::unique_ptr<Octree> made(engine::Device& on, const std::vector<uint64_t>& keys, uint64_t max_items, uint64_t max_nodes, uint depth,
                                 std::optional<SortShape> shape, std::optional<uint> length = {}) {
        auto octree = std::make_unique<Octree>(on, max_items, max_nodes, depth, shape);
        std::vector<uvec2> words(max_items, uvec2(~0u));
        std::vector<uint> indices(max_items, 0xdeadbeef);
        for (uint i = 0; i < keys.size(); ++i) words[i] = {uint(keys[i]), uint(keys[i] >> 32)}, indices[i] = i;
        engine::upload_bytes(on, words.data(), octree->item_keys(), words.size() * sizeof(uvec2));
        engine::upload_bytes(on, indices.data(), octree->item_indices(), indices.size() * sizeof(uint));
        const auto count = engine::upload(on, "test", "item count", std::vector<uint>{9, length.value_or(uint(keys.size()))});
        engine::Recorder recorder(on);
        octree->record(recorder, count, 1);
        octree->end(recorder);
        recorder.submit_and_wait();
        return octree;
    }
    static OctreeTwin fetched(engine::Device& on, const Octree& octree) {
        const OctreeState state = octree.report().state;
        OctreeTwin tree{.depth = octree.depth()};
        for (uint level = 0; level <= octree.depth(); ++level) {
            tree.level_first.push_back(state.first[level]);
            EXPECT_EQ(state.count[level], state.first[level + 1] - state.first[level]) << "level " << level;
        }
        const uint nodes = state.first[octree.depth() + 1];
        for (uint level = octree.depth() + 1; level <= octree_max_levels; ++level) EXPECT_EQ(state.first[level], nodes);
        for (uint level = octree.depth() + 1; level < octree_max_levels; ++level) EXPECT_EQ(state.count[level], 0u);
        tree.level_first.push_back(nodes);
        tree.first = engine::download(on, octree.first(), nodes + 1);
        tree.items = engine::download(on, octree.sorted_items(), state.items);
        for (const uvec2 key : engine::download(on, octree.keys(), nodes)) tree.keys.push_back(wide(key));
        return tree;
    }
    static void compare(const OctreeTwin& expected, const OctreeTwin& tree, const std::vector<uint64_t>& keys, const std::string& where) {
        EXPECT_EQ(octree_check(tree, keys), "") << where;
        EXPECT_TRUE(same(expected.level_first, tree.level_first)) << where;
        EXPECT_TRUE(same(expected.keys, tree.keys)) << where;
        EXPECT_TRUE(same(expected.first, tree.first)) << where;
        EXPECT_TRUE(same(expected.items, tree.items)) << where;
    }
    void check(const std::vector<uint64_t>& keys, uint depth, const std::string& what, bool all_shapes = true) {
        const OctreeTwin expected = octree_ref(keys, depth);
        std::vector<std::optional<SortShape>> shapes{std::nullopt};
        if (all_shapes) shapes.push_back(lone);
        if (all_shapes && !device.plain_groups()) shapes.push_back(subgroups);
        for (const auto& shape : shapes) {
            const std::string where = what + ", " + std::to_string(keys.size()) + " items, depth " + std::to_string(depth) +
                                      (!shape ? ", shape of the device" : shape->lone_lanes ? ", lone lanes" : ", subgroups");
            const auto octree = made(device, keys, keys.size(), expected.nodes(), depth, shape);  // just enough
            ASSERT_TRUE(octree->report().ok()) << where;
            EXPECT_EQ(octree->report().needed(), expected.nodes()) << where;
            compare(expected, fetched(device, *octree), keys, where);
        }
    }
};

TEST_F(OctreeTest, twin_builds_a_hand_made_tree) {
    const std::vector<uint64_t> keys{077, 012, 010, 012};  // octal: an octant a digit
    const OctreeTwin tree = octree_ref(keys, 2);
    EXPECT_TRUE(same(std::vector<uint>{0, 1, 3, 6}, tree.level_first));
    EXPECT_TRUE(same(std::vector<uint64_t>{0, 1, 7, 010, 012, 077}, tree.keys));
    EXPECT_TRUE(same(std::vector<uint>{1, 3, 5, 6, 7, 9, 10}, tree.first));
    EXPECT_TRUE(same(std::vector<uint>{2, 1, 3, 0}, tree.items));
    EXPECT_EQ(octree_check(tree, keys), "");
}

TEST_F(OctreeTest, check_sees_what_is_wrong) {
    const auto keys = clustered_keys(300, 5);
    const OctreeTwin good = octree_ref(keys, 5);
    ASSERT_EQ(octree_check(good, keys), "");
    const auto broken = [&](auto change) {
        OctreeTwin tree = good;
        change(tree);
        return octree_check(tree, keys);
    };
    EXPECT_NE(broken([](auto& t) { t.first[3] += 1; }), "");
    EXPECT_NE(broken([](auto& t) { t.keys[t.level_first[4]] ^= 8; }), "");
    EXPECT_NE(broken([](auto& t) { std::swap(t.items.front(), t.items.back()); }), "");
    EXPECT_NE(broken([](auto& t) { t.items[5] = t.items[6]; }), "");
    EXPECT_NE(broken([](auto& t) { t.first.back() -= 1; }), "");
    EXPECT_NE(broken([](auto& t) { t.level_first[2] += 1; }), "");
}

TEST_F(OctreeTest, keys_interleave_and_come_back) {
    for (int i = 0; i < 2000; ++i) {
        const uvec3 cell(random() & 0x1fffff, random() & 0x1fffff, random() & 0x1fffff);
        uint64_t expected = 0;
        for (uint bit = 0; bit < 21; ++bit)
            for (uint axis = 0; axis < 3; ++axis) expected |= uint64_t(cell[int(axis)] >> bit & 1) << (3 * bit + axis);
        const uvec2 key = octree_key(cell);
        ASSERT_EQ(wide(key), expected);
        ASSERT_EQ(octree_cell_of(key), cell);
        for (uint levels = 0; levels <= 21; ++levels) ASSERT_EQ(wide(octree_ancestor(key, levels)), expected >> 3 * levels);
    }
}

TEST_F(OctreeTest, keys_part_where_ancestors_do) {
    for (int i = 0; i < 3000; ++i) {
        const uint depth = 1 + random() % 21;
        const auto keys = clustered_keys(2, depth);
        uint level = 0;
        while (level <= depth && keys[0] >> 3 * (depth - level) == keys[1] >> 3 * (depth - level)) ++level;
        ASSERT_EQ(octree_parting({uint(keys[0]), uint(keys[0] >> 32)}, {uint(keys[1]), uint(keys[1] >> 32)}, depth), level);
    }
}

TEST_F(OctreeTest, borders_and_faces) {
    const OctreeCube cube = octree_cube({-1, 2, 3}, {1, 3, 4}, 3);  // 8 cells of a quarter
    EXPECT_EQ(octree_cell({-1, 2, 3}, cube, 3), uvec3(0, 0, 0));
    EXPECT_EQ(octree_cell({-0.75f, 2.25f, 3.2499f}, cube, 3), uvec3(1, 1, 0));  // borders belong to the cell above
    EXPECT_EQ(octree_cell({1, 4, 5}, cube, 3), uvec3(7, 7, 7));
    EXPECT_EQ(octree_cell({-1e30f, 1e30f, 3}, cube, 3), uvec3(0, 7, 0));
    const OctreeCube deep = octree_cube({0, 0, 0}, {1, 1, 1}, 21);
    EXPECT_EQ(octree_cell({1, 0x1.fffffep-1f, 0.5f}, deep, 21), uvec3(0x1fffff, 0x1fffff, 0x100000));
    for (const float side : {0.0f, 1e-45f, 1e-40f}) {  // no extent, or too little for a float
        const OctreeCube none = octree_cube({5, 5, 5}, {5 + side, 5, 5}, 21);
        EXPECT_EQ(octree_cell({5, 5, 5}, none, 21), uvec3(0));
    }
    EXPECT_EQ(octree_cube({0, 0, 0}, {1e-45f, 0, 0}, 21).cells_per_length, 0.0f);
}

TEST_F(OctreeTest, keys_of_points_are_the_twins) {
    std::vector<vec4> points(5000);
    for (size_t i = 0; i < points.size(); ++i)
        for (int axis = 0; axis < 3; ++axis) points[i][axis] = float(random()) * 0x1p-31f - 0.7f;  // some outside
    points[0] = {-0.5f, -0.5f, -0.5f, 0}, points[1] = {0.75f, 0.75f, 0.75f, 0}, points[2] = {0, 0.125f, 1e20f, 0};
    const auto on = on_device(points);
    const auto count = on_device(std::vector<uint>{5000});
    for (const uint depth : {0u, 1u, 10u, 11u, 21u}) {
        const OctreeCube cube = octree_cube({-0.5f, -0.5f, -0.5f}, {0.75f, 0.5f, 0.5f}, depth);
        Octree octree(device, 4999, 1, depth);  // one point too many
        engine::Recorder recorder(device);
        octree.record_keys(recorder, on, count, 0, cube);
        recorder.submit_and_wait();
        std::vector<uvec2> expected;
        std::vector<uint> indices;
        for (uint i = 0; i < 4999; ++i) expected.push_back(octree_key(octree_cell(points[i], cube, depth))), indices.push_back(i);
        EXPECT_TRUE(same(expected, engine::download(device, octree.item_keys()))) << "depth " << depth;
        EXPECT_TRUE(same(indices, engine::download(device, octree.item_indices()))) << "depth " << depth;
    }
}

TEST_F(OctreeTest, equals_the_twin_at_boundary_sizes) {
    for (size_t n : {0, 1, 2, 7, 8, 9, 63, 64, 65, 127, 128, 129, 1023, 1024, 1025}) check(clustered_keys(n, 7), 7, "clustered");
    for (size_t n : {2063, 2064, 2065, 16 * 2064 - 1, 16 * 2064, 16 * 2064 + 1}) check(clustered_keys(n, 10), 10, "clustered", false);
}

TEST_F(OctreeTest, any_depth) {
    for (uint depth : {0u, 1u, 2u, 10u, 11u, 20u, 21u}) {
        check(clustered_keys(1500, depth), depth, "clustered");
        check(random_keys(1500, depth), depth, "random");
    }
}

TEST_F(OctreeTest, hard_inputs) {
    const uint64_t last = (uint64_t(1) << 63) - 1;
    check({last}, 21, "one item");  // chains of single children stay
    check(std::vector<uint64_t>(3000, last), 21, "all in the last cell");
    check(std::vector<uint64_t>(3000, 0), 21, "all in the first cell");
    check({0, last}, 21, "opposite corners");
    check({last >> 1, (last >> 1) + 1}, 21, "neighbours across the root's border");
    std::vector<uint64_t> full(4096);
    for (size_t i = 0; i < full.size(); ++i) full[i] = 4095 - i;
    check(full, 4, "every cell, backwards");
}

TEST_F(OctreeTest, a_million) {
    check(std::vector<uint64_t>(1000000, 0x123456789abcdef), 21, "all the same", false);
    check(clustered_keys(1 << 20, 11), 11, "clustered", false);
}

TEST_F(OctreeTest, over_capacity_nothing_is_there_and_what_it_takes_is_said) {
    const auto keys = clustered_keys(3000, 9);
    const OctreeTwin expected = octree_ref(keys, 9);
    for (const auto& shape : {std::optional<SortShape>(), std::optional(lone)})
        for (const uint64_t capacity : {uint64_t(0), uint64_t(1), uint64_t(100), uint64_t(expected.nodes() - 1)}) {
            const auto octree = made(device, keys, 3000, capacity, 9, shape);
            const OctreeReport report = octree->report();
            EXPECT_FALSE(report.ok());
            EXPECT_EQ(report.needed(), expected.nodes());
            EXPECT_EQ(report.state.items, 0u);
            for (uint level = 0; level < octree_max_levels; ++level) EXPECT_EQ(report.state.count[level] + report.state.first[level], 0u);
            EXPECT_EQ(engine::download(device, octree->first(), 1)[0], 0u);
            const auto larger = made(device, keys, 3000, report.needed(), 9, shape);
            ASSERT_TRUE(larger->report().ok());
            compare(expected, fetched(device, *larger), keys, "again");
        }
}

TEST_F(OctreeTest, the_length_is_the_devices) {
    auto keys = clustered_keys(3000, 9);
    const auto fewer = made(device, keys, 10000, 30000, 9, {});
    compare(octree_ref(keys, 9), fetched(device, *fewer), keys, "room for more");
    const auto clamped = made(device, keys, 3000, 30000, 9, lone, 1000000);
    compare(octree_ref(keys, 9), fetched(device, *clamped), keys, "clamped");
    const auto part = made(device, keys, 3000, 30000, 9, lone, 1000);
    keys.resize(1000);
    compare(octree_ref(keys, 9), fetched(device, *part), keys, "the first thousand");
}

TEST_F(OctreeTest, plain_groups_equal_subgroups) {
    setenv("MYRIAD_PLAIN_GROUPS", "1", 1);
    engine::Device plain({.select = "", .validation = true, .memory_limit = 0});
    unsetenv("MYRIAD_PLAIN_GROUPS");
    ASSERT_EQ(plain.group_size(), 1u);
    for (size_t n : {0, 1, 1025, 20000}) {
        const auto keys = clustered_keys(n, 11);
        const auto octree = made(plain, keys, n, 12 * n + 1, 11, {});
        compare(octree_ref(keys, 11), fetched(plain, *octree), keys, "plain");
    }
    EXPECT_EQ(plain.validation_messages(), 0u);
}

TEST_F(OctreeTest, merges_from_the_leaves_up) {
    for (const size_t n : {0, 1, 5000}) {
        const auto keys = clustered_keys(n, 8);
        const OctreeTwin tree = octree_ref(keys, 8);
        const auto octree = made(device, keys, n, tree.nodes(), 8, {});
        const engine::Program program(device, engine::compute_kernels, "octree/tally");
        const engine::Array<uint> tally(device, "test", "tally", tree.nodes());
        engine::Recorder recorder(device);
        octree->bottom_up(recorder, program, [&](uint level) {
            const OctreeRef ref = octree->read(recorder);
            return OctreeTallyPush{.first = ref.first, .tally = recorder.write(tally), .state = ref.state, .level = level, .leaves = level == 8};
        });
        recorder.submit_and_wait();
        std::vector<uint> expected(tree.nodes());
        for (size_t node = tree.nodes(); node-- > 0;)
            for (uint child = tree.first[node]; child < tree.first[node + 1]; ++child) expected[node] += child < tree.nodes() ? expected[child] : 1;
        EXPECT_TRUE(same(expected, engine::download(device, tally)));
        if (n) { EXPECT_EQ(expected[0], n); }
    }
}

}  // namespace
}  // namespace myriad::compute
