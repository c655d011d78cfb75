// Trees of every arity, by all that walks them: made, refitted, cut from the roots and from the frame before, against the twins and
// their validators.
#include <algorithm>
#include <limits>

#include "compute/bsh/bsh_ref.hpp"
#include "compute/incremental/incremental_ref.hpp"
#include "compute/views/view_testing.hpp"
#include "engine/error.hpp"
#include "engine/testing.hpp"

namespace myriad::compute {
namespace {

using engine::same;
using glm::uvec4, glm::vec3;

class ArityTest : public engine::DeviceTest, public testing::WithParamInterface<uint> {
protected:
    const uint arity = GetParam();

    float uniform(float lo = -1, float hi = 1) { return std::uniform_real_distribution<float>(lo, hi)(random); }
    vec3 point(float scale = 1) { return scale * vec3(uniform(), uniform(), uniform()); }
    std::vector<View> views(size_t n) { return random_views(random, n, 1.2f, {0.7f, 1.57079633f, 2.5f, 3.14159265f}); }

    // Triangles of which those from `first_moving` on may move alone, their tree, and the tree read back.
    std::vector<vec3> positions;
    std::vector<uvec4> triangles;
    std::unique_ptr<Bsh> tree;
    BshArrays arrays;
    HostTree host;

    void soup(uint n, uint32_t log2_samples, uint first_moving = ~0u) {
        positions.clear(), triangles.clear();
        for (uint i = 0; i < n; ++i) {
            const vec3 middle = point();
            for (int k = 0; k < 3; ++k) positions.push_back(middle + point(0.1f));
            triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2, 0});
        }
        WorldTriangles world{positions, triangles};
        world.first_moving = first_moving;
        tree = std::make_unique<Bsh>(device, world, log2_samples, 1, arity);
        refit();
    }
    void refit(bool moving = false) {
        const auto on_p = on_device(positions);
        const auto on_t = on_device(triangles);
        engine::Recorder recorder(device);
        moving ? tree->refit_moving(recorder, on_p, on_t) : tree->refit(recorder, on_p, on_t);
        recorder.submit_and_wait();
        read();
    }
    void read() {
        arrays = bsh_download(device, *tree);
        host = HostTree(device, *tree);
    }
    std::string check_tree() {
        const auto samples = engine::download(device, tree->samples());
        const BshInput input{samples, positions, triangles, tree->sample_radius(), tree->sample_share()};
        const BshArrays twin = bsh_ref(input, arity);
        EXPECT_TRUE(same(twin.frames, arrays.frames));
        EXPECT_TRUE(same(twin.spheres, arrays.spheres));
        EXPECT_TRUE(same(twin.cones, arrays.cones));
        EXPECT_TRUE(same(twin.boxes, arrays.boxes));
        return bsh_check(arrays, input);
    }

    AppendReport basic(const std::vector<View>& all, AppendMode mode, uint64_t capacity, float epsilon, std::vector<NodeView>& cut) {
        const auto on = on_device(all);
        const auto count = on_device(std::vector<uint>{uint(all.size())});
        AppendLists lists(device, mode, std::max<uint64_t>(capacity, all.size()), capacity);
        engine::Recorder recorder(device);
        ManyLods(device, bsh_constants(arity)).record(recorder, lists, {*tree, on, count, 0, uint32_t(all.size()), epsilon, 32});
        recorder.submit_and_wait();
        cut = node_views(engine::download(device, lists.kept(), std::min<uint64_t>(lists.report().kept, capacity)), arity);
        return lists.report();
    }
    // Both append modes and the walk against the twin, which is a partition.
    void check_cut(const std::vector<View>& all, float epsilon) {
        const CutRef expected = cut_ref(host, all, epsilon, 32);
        ASSERT_EQ(partition_violation(host, expected.cut, uint(all.size())), "");
        std::vector<NodeView> cut;
        for (AppendMode mode : {AppendMode::scan, AppendMode::atomic}) {
            const AppendReport report = basic(all, mode, 1 << 18, epsilon, cut);
            ASSERT_TRUE(report.ok());
            ASSERT_TRUE(same(expected.cut, cut));
            EXPECT_EQ(report.processed, expected.tested);
        }
        const auto on = on_device(all);
        const auto count = on_device(std::vector<uint>{uint(all.size())});
        engine::Array<uvec2> kept(device, "test", "walk cut", 1 << 18);
        engine::Array<uint> state(device, "test", "walk state", sizeof(AppendState) / 4);
        engine::Recorder recorder(device);
        ManyLods(device, bsh_constants(arity)).record_walk(recorder, kept, state, {*tree, on, count, 0, uint32_t(all.size()), epsilon, 32});
        recorder.submit_and_wait();
        ASSERT_TRUE(same(expected.cut, node_views(engine::download(device, kept, engine::download(device, state)[AppendLists::kept_word]), arity)));
    }

    CarryReport carry(CarriedCut& carried, const std::vector<View>& all, uint32_t most, const CarrySettings& settings, std::vector<NodeView>& cut,
                      BoundsTravel* travel = nullptr) {
        std::vector<View> padded = all;
        padded.resize(most, view(vec3(7), vec3(1, 0, 0), 0));
        const auto on = on_device(padded);
        const auto count = on_device(std::vector<uint>{uint(all.size())});
        engine::Recorder recorder(device);
        if (travel) travel->record(recorder, *tree);
        carried.record(recorder, {*tree, on, count, 0, most, 1, 32}, settings, travel);
        recorder.submit_and_wait();
        const CarryReport report = carried.report();
        std::vector<uvec2> groups;
        for (const uvec2& code : engine::download(device, carried.lists().kept(), std::min<uint64_t>(report.lists.kept, carried.lists().kept_capacity())))
            if (!cut_is_hole(code) && cut_unpack(code).view < all.size()) groups.push_back(code);
        cut = node_views(groups, arity);
        return report;
    }
    void move(std::vector<View>& all) {
        for (View& v : all) {
            if (random() % 2) v.position += point(random() % 4 ? 0.002f : 0.3f);
            if (random() % 3 == 0) v.direction = glm::normalize(v.direction + point(random() % 4 ? 0.002f : 0.5f));
        }
    }
};

TEST_P(ArityTest, shapes_by_hand) {
    struct Expected {
        uint32_t depth;
        uint blocks, levels;
    };
    const std::vector<Expected> expected = arity == 2 ? std::vector<Expected>{{0, 1, 1}, {1, 1, 1}, {2, 3, 2}, {3, 7, 3}, {7, 127, 7}}
                                         : arity == 4 ? std::vector<Expected>{{0, 1, 1}, {1, 1, 1}, {2, 1, 1}, {3, 3, 2}, {4, 5, 2}, {7, 43, 4}}
                                                      : std::vector<Expected>{{0, 1, 1}, {1, 1, 1}, {3, 1, 1}, {4, 3, 2}, {6, 9, 2}, {7, 19, 3}};
    for (const Expected& e : expected) {
        soup(20, e.depth);
        EXPECT_EQ(tree->blocks(), e.blocks) << e.depth;
        EXPECT_EQ(tree->levels(), e.levels) << e.depth;
        EXPECT_EQ(tree->slots(), arity * (e.blocks + 1)) << e.depth;
        EXPECT_EQ(tree->root(), arity * e.blocks) << e.depth;
    }
}

// Trees whose root has one child, or fewer than the arity, or as many.
TEST_P(ArityTest, device_equals_twin_and_is_nested) {
    for (const uint32_t depth : {0u, 1u, 2u, 3u, 4u, 5u, 10u, 11u})
        for (const uint n : {1u, 200u}) {
            SCOPED_TRACE(testing::Message() << "depth " << depth << ", " << n << " triangles");
            soup(n, depth);
            ASSERT_EQ(check_tree(), "");
            for (vec3& p : positions) p = vec3(p.y * 3 + p.x * p.x, p.z - p.x, 2.0f * p.x + 5.0f);
            refit();
            ASSERT_EQ(check_tree(), "");
        }
}

TEST_P(ArityTest, the_validator_knows_the_arity) {
    soup(50, 7);
    for (const uint other : {2u, 4u, 8u}) {
        const auto samples = engine::download(device, tree->samples());
        BshArrays as_another = arrays;
        as_another.arity_log2 = uint(std::countr_zero(other));
        const std::string fault = bsh_check(as_another, {samples, positions, triangles, tree->sample_radius(), tree->sample_share()});
        EXPECT_EQ(fault.empty(), other == arity) << fault;
    }
    const CutRef good = cut_ref(host, views(3), 1, 32);
    std::vector<NodeView> lost = good.cut;
    lost.pop_back();
    EXPECT_NE(partition_violation(host, lost, 3), "");
}

TEST_P(ArityTest, a_refit_in_part_is_a_refit_and_a_rebuild_is_valid) {
    soup(200, 9, 150);
    EXPECT_GT(tree->moving_blocks(), 0u);
    EXPECT_LT(tree->moving_blocks(), tree->blocks());
    for (size_t i = 3 * 150; i < positions.size(); ++i) positions[i] += point(0.4f);
    refit(true);
    ASSERT_EQ(check_tree(), "");
    const auto on_p = on_device(positions);
    const auto on_t = on_device(triangles);
    engine::Recorder recorder(device);
    tree->rebuild(recorder, on_p, on_t);
    tree->measure(recorder);
    recorder.submit_and_wait();
    read();
    ASSERT_EQ(check_tree(), "");
    double extent = 0;
    for (uint slot = host.leaves; slot <= host.root(); ++slot)
        if (!host.absent(slot)) extent += std::pow(double(host.sphere(slot).radius), 2);
    EXPECT_NEAR(tree->quality().extent / extent, 1, 0.02);
}

TEST_P(ArityTest, cuts_of_trees_and_views_at_boundaries) {
    for (const uint32_t depth : {0u, 1u, 2u, 3u, 9u, 10u})
        for (const size_t n : depth == 9 ? std::vector<size_t>{0, 1, 7, 8, 9, 65} : std::vector<size_t>{arity - 1, arity + 1}) {
            SCOPED_TRACE(testing::Message() << "depth " << depth << ", " << n << " views");
            soup(100, depth);
            check_cut(views(n), 1);
            if (HasFatalFailure()) return;
        }
    for (const float epsilon : {0.0f, 0.3f, 8.0f, std::numeric_limits<float>::infinity()}) check_cut(views(9), epsilon);
}

TEST_P(ArityTest, no_scene_no_tree) {
    soup(0, 9);
    EXPECT_TRUE(tree->empty() && tree->blocks() + tree->slots() + tree->levels() + tree->bytes() == 0);
    std::vector<NodeView> cut;
    EXPECT_TRUE(basic(views(3), AppendMode::scan, 16, 1, cut).ok() && cut.empty());
    CarriedCut carried(device, AppendMode::scan, 16, 0, 3, bsh_constants(arity));
    EXPECT_EQ(carry(carried, views(3), 3, {}, cut).lists.kept, 0u);
}

TEST_P(ArityTest, too_short_lists_are_reported_and_growing_gives_the_same_cut) {
    soup(100, 11);
    const auto all = views(20);
    const auto expected = cut_ref(host, all, 1, 32).cut;
    std::vector<NodeView> cut;
    for (AppendMode mode : {AppendMode::scan, AppendMode::atomic}) {
        int redone = 0;
        for (uint64_t capacity = 1;; ++redone) {
            const AppendReport report = basic(all, mode, capacity, 1, cut);
            if (report.ok()) break;
            ASSERT_LT(redone, 40);
            capacity = std::max({capacity + 1, report.next_needed, report.kept_needed});
        }
        EXPECT_GT(redone, 0);
        EXPECT_TRUE(same(expected, cut));
        redone = 0;
        for (uint64_t capacity = 20;; ++redone) {
            CarriedCut carried(device, mode, capacity, 0, 20, bsh_constants(arity));
            const AppendReport report = carry(carried, all, 20, {}, cut).lists;
            if (report.ok()) break;
            ASSERT_LT(redone, 40);
            capacity = std::max({capacity + 1, report.next_needed, report.kept_needed});
        }
        EXPECT_GT(redone, 0);
        EXPECT_TRUE(same(expected, cut));
    }
}

// Views drift and jump, come and go; bounds move, in part and as a whole.
TEST_P(ArityTest, carried_cuts_are_the_basic_ones) {
    for (const uint32_t depth : {0u, 1u, 3u, 8u}) {
        soup(120, depth, 100);
        const uint32_t most = 12;
        for (AppendMode mode : depth < 3 ? std::vector{AppendMode::scan} : std::vector{AppendMode::scan, AppendMode::atomic}) {
            CarriedCut carried(device, mode, 1 << 14, 0, most, bsh_constants(arity));
            BoundsTravel travel(device, arity);
            std::vector<View> all = views(most);
            std::vector<NodeView> cut;
            uint64_t evaluated = 0, needed = 0;
            for (int f = 0; f < (depth == 8 ? 24 : 8); ++f) {
                SCOPED_TRACE(testing::Message() << "depth " << depth << ", frame " << f);
                if (f % 3) move(all);
                if (random() % 8 == 0) all.resize(1 + random() % most);
                if (random() % 4 == 0) while (all.size() < most) all.push_back(views(1)[0]);
                if (f % 4 == 3) {
                    const bool part = f % 8 == 3;
                    for (size_t i = part ? 300 : 0; i < positions.size(); ++i) positions[i] += point(0.003f);
                    refit(part);
                }
                const CarryReport report = carry(carried, all, most, {}, cut, &travel);
                ASSERT_TRUE(report.lists.ok());
                const CutRef expected = cut_ref(host, all, 1, 32);
                ASSERT_TRUE(same(expected.cut, cut));
                ASSERT_EQ(report.cut, expected.cut.size());
                if (f > 0) evaluated += report.lists.processed, needed += expected.tested;
            }
            EXPECT_TRUE(depth != 8 || evaluated < needed) << evaluated << " of " << needed;
        }
    }
}

TEST_P(ArityTest, lazy_cuts_are_the_twins) {
    soup(120, 10);
    const uint32_t most = 8;
    CarriedCut carried(device, AppendMode::scan, 1 << 15, 0, most, bsh_constants(arity));
    CarriedCutRef twin;
    std::vector<View> all = views(most);
    std::vector<NodeView> cut;
    uint64_t invalid = 0;
    for (int f = 0; f < 30; ++f) {
        SCOPED_TRACE(f);
        if (f % 10 > 3) move(all);
        const CarryReport report = carry(carried, all, most, {.edges = 1}, cut);
        twin.update(host, all, most, 1, 32, 1);
        ASSERT_TRUE(same(twin.cut(host, all, 1, 32), cut));
        ASSERT_EQ(report.invalid, twin.invalid());
        invalid += report.invalid;
    }
    EXPECT_GT(invalid, 0u);
}

INSTANTIATE_TEST_SUITE_P(Arities, ArityTest, testing::Values(2u, 4u, 8u), [](const auto& info) { return std::to_string(info.param); });

// Every (leaf, view) of a cut is named by a block's number, of which there are 2^26.
TEST(BshSize, more_blocks_than_cuts_can_name_are_refused) {
    for (const auto& [depth, arity] : {std::pair(25u, 2u), {27u, 4u}, {28u, 8u}, {0u, 2u}}) EXPECT_NO_THROW(check_bsh_size(depth, arity)) << depth << " " << arity;
    for (const auto& [depth, arity] : {std::pair(26u, 2u), {28u, 2u}, {28u, 4u}}) EXPECT_THROW(check_bsh_size(depth, arity), InputError) << depth << " " << arity;
    try {
        check_bsh_size(28, 4);
    } catch (const InputError& e) {
        EXPECT_NE(std::string(e.what()).find("--samples 27"), std::string::npos) << e.what();
    }
}

TEST(BshLevels, every_slot_knows_its_height_and_owner) {
    for (uint arity : {2u, 4u, 8u})
        for (uint depth = 0; depth <= 18; ++depth) {
            const std::vector<BshLevel> levels = bsh_levels(1u << depth, arity);
            const BshShape shape{1u << depth, levels.back().first_block(), levels.back().arity_log2};
            for (uint height = 0; height < levels.size(); ++height)
                for (uint slot = levels[height].first_slot; slot < levels[height].first_slot + levels[height].nodes; ++slot) {
                    ASSERT_EQ(bsh_height(slot, shape), height) << arity << " depth " << depth << " slot " << slot;
                    if (height == 0) continue;
                    const uint block = bsh_block_of(slot, shape);
                    ASSERT_EQ(bsh_owner_of(block, shape), slot);
                    ASSERT_EQ(block, levels[height - 1].first_block() + slot - levels[height].first_slot);
                }
        }
    EXPECT_EQ(bsh_height(0, {1u << 28, bsh_levels(1u << 28, 8).back().first_block(), 3}), 0u);
}

}  // namespace
}  // namespace myriad::compute
