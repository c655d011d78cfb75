#include "compute/manylods/manylods.hpp"

#include <algorithm>
#include <limits>

#include "compute/bsh/tree_testing.hpp"
#include "compute/manylods/manylods_ref.hpp"

namespace myriad::compute {
namespace {

using engine::same;

class ManyLodsTest : public TreeTest {
protected:
    std::vector<View> random_views(size_t n, float scale = 1.2f) {
        const float phis[] = {0.5f, 1, 1.5f, 2};  // right angles
        std::vector<View> views;
        for (size_t i = 0; i < n; ++i) views.push_back(view(point(scale), point(), phis[random() % 4]));
        return views;
    }

    struct Outcome {
        std::vector<uvec2> groups;
        AppendReport report;
    };
    Outcome cut(const Bsh& tree, const std::vector<View>& views, AppendMode mode, float epsilon, uint map_size, uint64_t capacity = 1 << 18) {
        const auto on = on_device(views);
        const auto count = on_device(std::vector<uint>{uint(views.size())});
        ManyLods manylods(device);
        AppendLists lists(device, mode, std::max<uint64_t>(capacity, views.size()), capacity);
        engine::Recorder recorder(device);
        manylods.record(recorder, lists, {tree, on, count, 0, uint32_t(views.size()), epsilon, map_size});
        recorder.submit_and_wait();
        Outcome out{{}, lists.report()};
        out.groups = engine::download(device, lists.kept(), std::min<uint64_t>(out.report.kept, capacity));
        return out;
    }

    // The invariants of the spec for the basic cut: partition, oracle, order independence.
    void check(const Soup& soup, uint32_t log2_samples, const std::vector<View>& views, float epsilon, uint map_size) {
        const Bsh tree = build(soup, log2_samples);
        const HostTree host(device, tree);
        const CutRef expected = cut_ref(host, views, epsilon, map_size);
        ASSERT_EQ(partition_violation(host, expected.cut, uint(views.size())), "");
        for (AppendMode mode : {AppendMode::scan, AppendMode::atomic}) {
            const Outcome found = cut(tree, views, mode, epsilon, map_size);
            ASSERT_TRUE(found.report.ok());
            EXPECT_TRUE(same(expected.cut, node_views(found.groups)));
            EXPECT_EQ(expected.tested, found.report.processed);
        }
        const Outcome first = cut(tree, views, AppendMode::scan, epsilon, map_size);
        EXPECT_TRUE(same(first.groups, cut(tree, views, AppendMode::scan, epsilon, map_size).groups)) << "order of the scan mode";
    }
};

TEST_F(ManyLodsTest, random_scenes_of_every_depth) {
    for (uint32_t depth : {0, 1, 2, 3, 4, 5, 6, 8, 9, 12}) {
        SCOPED_TRACE(depth);
        check(random_soup(200), depth, random_views(65), 1.0f, 32);
    }
}

TEST_F(ManyLodsTest, view_counts_at_boundaries) {
    const Soup soup = random_soup(50);
    for (size_t views : {0, 1, 7, 8, 9, 63, 64, 65, 300}) {
        SCOPED_TRACE(views);
        check(soup, 9, random_views(views), 1.0f, 16);
    }
}

TEST_F(ManyLodsTest, epsilon_from_nothing_to_everything) {
    const Soup soup = random_soup(50);
    const auto views = random_views(20);
    for (float epsilon : {0.0f, 0.01f, 0.5f, 4.0f, 1e30f, std::numeric_limits<float>::infinity()}) {
        SCOPED_TRACE(epsilon);
        check(soup, 9, views, epsilon, 32);
    }
}

TEST_F(ManyLodsTest, hard_cases) {
    std::vector<View> views = random_views(24);
    auto run = [&](const char* name, const Soup& soup) {
        SCOPED_TRACE(name);
        std::vector<View> all = views;
        for (size_t i = 0; i < std::min<size_t>(soup.positions.size(), 24); ++i) {  // views exactly on surfaces and inside spheres
            all.push_back(view(soup.positions[i], {0, 0, 1}, 1));
            all.push_back(view(soup.positions[i], {1, 0, 0}, 2));
            all.push_back(view(soup.positions[i], {1, 0, 0}, 2));  // two views at the same point
        }
        const Bsh tree = build(soup, 9);
        const HostTree host = tree.empty() ? HostTree() : HostTree(device, tree);
        for (uint slot = 0; slot < host.spheres.size(); slot += 13)  // views at nodes' centres
            if (!host.absent(slot)) all.push_back(view(host.sphere(slot).center, point(), 1));
        check(soup, 9, all, 1.0f, 32);
    };
    run("one triangle", random_soup(1));
    run("all coincident", {std::vector<glm::vec3>(3, {0.3f, 0.2f, 0.1f}), {{0, 1, 2, 0}}});
    run("needles", {{{0, 0, 0}, {1, 1e-7f, 0}, {1, 0, 1e-7f}, {0, 0, 0}, {0, 1, 0}, {0, 2, 0}}, {{0, 1, 2, 0}, {3, 4, 5, 0}}});
    Soup plane{{{-1, 0, -1}, {1, 0, -1}, {-1, 0, 1}, {1, 0, 1}}, {{0, 1, 2, 0}, {1, 3, 2, 0}}};
    views.push_back(view({5, 0, 0}, {-1, 0, 0}, 1));  // the plane edge-on, along the maps' axis
    views.push_back(view({0, 0, 5}, {0, 0, -1}, 1));  // … and along their equator
    run("a plane edge-on", plane);
    for (float scale : {1e-6f, 1e6f}) {
        Soup scaled = random_soup(100);
        for (auto& p : scaled.positions) p *= scale;
        for (int i = 0; i < 20; ++i) views.push_back(view(point(scale), point(), 1));
        run("scaled", scaled);
    }
    Soup far = random_soup(100);
    for (auto& p : far.positions) p += 1e6f;
    for (int i = 0; i < 20; ++i) views.push_back(view(point() + 1e6f, point(), 1));
    run("a million away", far);
    Soup ratio = random_soup(200, 1e-6f);
    for (auto& p : ratio.positions) p *= 1e-3f;
    const uint base = uint(ratio.positions.size());
    for (auto p : plane.positions) ratio.positions.push_back(p * 1e3f);
    for (auto t : plane.triangles) ratio.triangles.push_back({t.x + base, t.y + base, t.z + base, 0});
    run("one to a million", ratio);
    run("empty scene", {});
}

TEST_F(ManyLodsTest, view_ranges_make_the_same_cuts) {
    const Bsh tree = build(random_soup(100), 9);
    const auto views = random_views(100);
    const auto all = node_views(cut(tree, views, AppendMode::scan, 1, 32).groups);
    const auto on = on_device(views);
    const auto count = on_device(std::vector<uint>{100});
    std::vector<NodeView> parts;
    ManyLods manylods(device);
    for (uint32_t first = 0; first < 128; first += 33) {  // the last range reaches past the end
        AppendLists lists(device, AppendMode::scan, 1 << 16, 1 << 16);
        engine::Recorder recorder(device);
        manylods.record(recorder, lists, {tree, on, count, first, 33, 1.0f, 32});
        recorder.submit_and_wait();
        const auto part = node_views(engine::download(device, lists.kept(), lists.report().kept));
        parts.insert(parts.end(), part.begin(), part.end());
    }
    EXPECT_TRUE(same(all, parts));
}

TEST_F(ManyLodsTest, too_short_lists_are_reported_and_growing_gives_the_same_cut) {
    const Bsh tree = build(random_soup(100), 12);
    const auto views = random_views(40);
    const auto expected = cut(tree, views, AppendMode::scan, 1, 32);
    for (AppendMode mode : {AppendMode::scan, AppendMode::atomic}) {
        uint64_t capacity = 1;
        int redone = 0;
        Outcome found;
        for (;; ++redone) {
            found = cut(tree, views, mode, 1, 32, capacity);
            if (found.report.ok()) break;
            ASSERT_LT(redone, 30);
            capacity = std::max({capacity + 1, found.report.next_needed, found.report.kept_needed});
        }
        EXPECT_GT(redone, 0);
        EXPECT_TRUE(same(node_views(expected.groups), node_views(found.groups)));
    }
}

TEST_F(ManyLodsTest, identical_views_have_identical_cuts) {
    const Bsh tree = build(random_soup(100), 6);
    const std::vector<View> views(10000, view({0.1f, 0.2f, 0.3f}, {0, 1, 0}, 1));
    const auto all = node_views(cut(tree, views, AppendMode::scan, 1, 16, 1 << 21).groups);
    const auto one = node_views(cut(tree, {views[0]}, AppendMode::scan, 1, 16).groups);
    ASSERT_EQ(all.size(), one.size() * views.size());
    for (size_t i = 0; i < all.size(); ++i) {
        const NodeView& expected = one[i % one.size()];
        ASSERT_TRUE(all[i].slot == expected.slot && all[i].culled == expected.culled) << "view " << all[i].view;
    }
}

TEST_F(ManyLodsTest, a_million_identical_views) {
    const Bsh tree = build(random_soup(100), 3);
    const uint32_t many = 1 << 20;
    const auto groups = cut(tree, std::vector<View>(many, view({0.1f, 0.2f, 0.3f}, {0, 1, 0}, 1)), AppendMode::scan, 1, 16, 1 << 22).groups;
    const auto one = cut(tree, {view({0.1f, 0.2f, 0.3f}, {0, 1, 0}, 1)}, AppendMode::scan, 1, 16).groups;
    ASSERT_EQ(groups.size(), one.size() * many);
    std::vector<uint> seen(many);
    for (const uvec2& code : groups) {
        const CutGroup g = cut_unpack(code);
        ASSERT_LT(g.view, many);
        ++seen[g.view];
        const bool known = std::ranges::any_of(one, [&](const uvec2& c) {
            const CutGroup o = cut_unpack(c);
            return o.block == g.block && o.drawn == g.drawn && o.culled == g.culled;
        });
        ASSERT_TRUE(known) << "view " << g.view;
    }
    EXPECT_TRUE(std::ranges::all_of(seen, [&](uint n) { return n == one.size(); }));
}

TEST_F(ManyLodsTest, walk_equals_lists) {
    for (uint32_t depth : {0, 2, 6, 12}) {
        const Bsh tree = build(random_soup(100), depth);
        const auto views = random_views(70);
        const auto on = on_device(views);
        const auto count = on_device(std::vector<uint>{70});
        engine::Array<uvec2> kept(device, "test", "walk cut", 1 << 17);
        engine::Array<uint> state(device, "test", "walk state", sizeof(AppendState) / 4);
        engine::Recorder recorder(device);
        ManyLods(device).record_walk(recorder, kept, state, {tree, on, count, 0, 70, 1.0f, 32});
        recorder.submit_and_wait();
        const uint found = engine::download(device, state)[AppendLists::kept_word];
        EXPECT_TRUE(same(node_views(cut(tree, views, AppendMode::scan, 1, 32).groups), node_views(engine::download(device, kept, found))));
    }
}

TEST_F(ManyLodsTest, the_validator_sees_a_broken_cut) {
    const Bsh tree = build(random_soup(100), 9);
    const HostTree host(device, tree);
    const auto views = random_views(3);
    const auto good = cut_ref(host, views, 1, 32).cut;
    ASSERT_EQ(partition_violation(host, good, 3), "");
    auto lost = good;
    lost.erase(lost.begin() + lost.size() / 2);
    EXPECT_NE(partition_violation(host, lost, 3), "");
    auto twice = good;
    twice.insert(twice.begin() + twice.size() / 2, twice[twice.size() / 2]);
    EXPECT_NE(partition_violation(host, twice, 3), "");
    auto stray = good;
    stray.push_back({3, 0, false});
    EXPECT_NE(partition_violation(host, stray, 3), "");
}

TEST(CutGroup, packs_every_bit) {
    for (uint block : {0u, 1u, 12345u, cut_max_blocks - 1})
        for (uint view : {0u, 63u, 64u, 1u << 20, cut_max_views - 1})
            for (uint masks : {0u, 0x0001u, 0x8000u, 0xa55au}) {
                const CutGroup g = cut_unpack(cut_pack(block, view, masks));
                EXPECT_TRUE(g.block == block && g.view == view && g.drawn == (masks & 255) && g.culled == masks >> 8);
            }
}

}  // namespace
}  // namespace myriad::compute
