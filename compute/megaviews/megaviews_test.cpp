#include "compute/megaviews/megaviews.hpp"

#include <algorithm>

#include "compute/bsh/tree_testing.hpp"
#include "compute/manylods/manylods.hpp"
#include "compute/megaviews/megaviews_ref.hpp"
#include "compute/svo/svo_ref.hpp"

namespace myriad::compute {
namespace {

using engine::same;

class MegaViewsTest : public TreeTest {
protected:
    // In clusters, as light paths' ends are: many see the same thing from nearly the same place.
    std::vector<View> random_views(size_t n, float scale = 1, float cluster = 0.01f) {
        const float phis[] = {0.3f, 1, 1, 1, 1.5f, 2};  // right angles
        std::vector<View> views;
        glm::vec3 middle{0}, direction{0, 0, 1};
        for (size_t i = 0; i < n; ++i) {
            if (i % 20 == 0) middle = point(), direction = point();
            views.push_back(view((middle + point(cluster)) * scale, direction + point(0.3f), phis[random() % 6]));
        }
        return views;
    }

    struct Outcome {
        std::vector<uvec2> groups;
        AppendReport lists;
        PairReport pairs;
        HostViewTree views;
    };
    static engine::Constants constants_of(const SceneTree& tree) { return dynamic_cast<const Svo*>(&tree) ? Svo::constants() : bsh_constants(tree.arity()); }
    HostTree host_of(const SceneTree& tree) {
        if (tree.empty()) return {};
        if (const Svo* svo = dynamic_cast<const Svo*>(&tree)) return svo_host_tree(svo_download(device, *svo));
        return HostTree(device, dynamic_cast<const Bsh&>(tree));
    }
    Svo build_svo(const Soup& soup, uint depth) {
        vec3 low(0), high(0);
        if (!soup.positions.empty()) low = high = soup.positions[0];
        for (const vec3& p : soup.positions) low = min(low, p), high = max(high, p);
        Svo svo(device, {soup.positions, soup.triangles}, depth, low, high);
        engine::Recorder recorder(device);
        svo.build(recorder, on_device(std::vector<vec3>(soup.positions)), on_device(std::vector<uvec4>(soup.triangles)));
        return svo;
    }
    Outcome walk(const SceneTree& tree, const std::vector<View>& views, AppendMode mode, float epsilon, uint map_size, uint first = 0, uint limit = ~0u,
                 uint64_t capacity = 1 << 20) {
        const uint n = uint(views.size());
        ViewTree view_tree(device, std::max(n, 1u));
        std::vector<View> room = views;
        room.resize(view_tree.capacity());
        const auto on = on_device(room);
        const auto count = on_device(std::vector<uint>{n});
        MegaViews mega(device, constants_of(tree));
        AppendLists lists(device, mode, capacity, capacity);
        engine::Recorder recorder(device);
        view_tree.record(recorder, on, count, vec3(-1), vec3(1));
        mega.record(recorder, lists, {tree, view_tree, first, std::min(limit, n), epsilon, map_size});
        recorder.submit_and_wait();
        Outcome out{{}, lists.report(), mega.report(), view_tree_download(device, view_tree, n)};
        out.groups = engine::download(device, lists.kept(), std::min<uint64_t>(out.lists.kept, capacity));
        return out;
    }

    // The twin's pairs, in both modes; every leaf and view below one pair, and nothing that is seen is culled.
    void check(const SceneTree& tree, const std::vector<View>& views, float epsilon, uint map_size, uint first = 0, uint limit = ~0u, bool brute = true) {
        const HostTree host = host_of(tree);
        std::vector<uvec2> once;
        for (AppendMode mode : {AppendMode::scan, AppendMode::atomic, AppendMode::scan}) {
            const Outcome found = walk(tree, views, mode, epsilon, map_size, first, limit);
            ASSERT_TRUE(found.lists.ok());
            const uint end = first + std::min(limit, uint(views.size()));
            const PairsRef expected = pairs_ref(host, found.views, first, end, epsilon, map_size);
            std::vector<TerminalPair> rendered;
            std::ranges::copy_if(expected.pairs, std::back_inserter(rendered), [](const TerminalPair& p) { return !p.culled && !p.edge_on; });
            EXPECT_TRUE(same(rendered, rendered_pairs(found.groups, tree.arity())));
            EXPECT_EQ(found.pairs.total.tested, expected.tested);
            EXPECT_EQ(found.pairs.total.culled, size_t(std::ranges::count(expected.pairs, true, &TerminalPair::culled)));
            EXPECT_EQ(found.pairs.total.edge_on, size_t(std::ranges::count(expected.pairs, true, &TerminalPair::edge_on)));
            EXPECT_EQ(found.pairs.total.rendered, rendered.size());
            EXPECT_EQ(found.pairs.total.shared, expected.shared);
            if (brute && mode == AppendMode::atomic) { EXPECT_EQ(pairs_violation(host, found.views, first, end, expected.pairs), ""); }
            if (mode == AppendMode::scan && !once.empty()) { EXPECT_TRUE(same(once, found.groups)) << "order of the scan mode"; }
            if (mode == AppendMode::scan) once = found.groups;
        }
    }
};

TEST_F(MegaViewsTest, pairs_are_the_twins_at_boundary_sizes) {
    for (uint depth : {0u, 1u, 8u}) {
        const Bsh tree = build(random_soup(50), depth);
        for (size_t views : {0, 1, 9, 200}) {
            SCOPED_TRACE(testing::Message() << "2^" << depth << " samples, " << views << " views");
            check(tree, random_views(views), 1, 16);
        }
    }
}

TEST_F(MegaViewsTest, trees_of_every_arity) {
    for (uint arity : {2u, 4u, 8u}) check(build(random_soup(100), 9, arity), random_views(100), 1, 16);
}

TEST_F(MegaViewsTest, octrees_of_voxels) {
    for (uint depth : {1u, 2u, 4u}) {
        const Svo tree = build_svo(random_soup(50), depth);
        for (size_t views : {0, 1, 9, 200}) {
            SCOPED_TRACE(testing::Message() << depth << " levels, " << views << " views");
            check(tree, random_views(views), 1, 16);
        }
    }
    const Svo deep = build_svo(random_soup(30, 0.02f), 9);
    for (float epsilon : {0.0f, 0.5f, 4.0f, 1e30f}) check(deep, random_views(50), epsilon, 16, 0, ~0u, false);
    check(deep, random_views(300), 2, 256, 100, 150, false);
    const Svo tree = build_svo(random_soup(100), 4);
    const auto host = host_of(tree);
    const auto views = view_tree_ref(random_views(40), 40, vec3(-1), vec3(1));
    auto bad = pairs_ref(host, views, 0, 40, 1, 16).pairs;
    ASSERT_EQ(pairs_violation(host, views, 0, 40, bad), "");
    for (TerminalPair& p : bad) p.culled = true;
    EXPECT_NE(pairs_violation(host, views, 0, 40, bad).find("culled"), std::string::npos);
    bad.pop_back();
    EXPECT_NE(pairs_violation(host, views, 0, 40, bad), "");
}

TEST_F(MegaViewsTest, epsilon_and_resolution) {
    const Bsh tree = build(random_soup(100), 9);
    const auto views = random_views(60);
    for (float epsilon : {0.0f, 0.5f, 4.0f, 1e30f}) check(tree, views, epsilon, 16);
    for (uint size : {2u, 256u}) check(tree, views, 1, size);
}

// A tree that holds nothing, or is one place, has no pairs that sharing would save.
TEST_F(MegaViewsTest, hard_cases) {
    auto over = [&](const SceneTree& tree, const Soup& soup, float scale) {
        std::vector<View> views = random_views(40, scale);
        for (size_t i = 0; i < std::min<size_t>(soup.positions.size(), 12); ++i) {  // exactly on surfaces; two at one place
            views.push_back(view(soup.positions[i], {0, 0, 1}, 1));
            views.push_back(view(soup.positions[i], {1, 0, 0}, 2));
            views.push_back(view(soup.positions[i], {1, 0, 0}, 2));
        }
        if (!tree.empty()) {
            const HostTree host = host_of(tree);
            for (uint slot = 0; slot < host.spheres.size(); slot += std::max(41u, uint(host.spheres.size()) / 32))
                if (!host.absent(slot)) views.push_back(view(host.sphere(slot).center, point(), 1));
        }
        views.push_back(view_of_nothing());
        check(tree, views, 1, 16);
        check(tree, std::vector<View>(100, views[0]), 1, 16);  // all alike
    };
    auto run = [&](const char* name, const Soup& soup, float scale = 1) {
        SCOPED_TRACE(name);
        over(build(soup, 8), soup, scale);
        SCOPED_TRACE("octree");
        over(build_svo(soup, 4), soup, scale);
    };
    run("nothing", {});
    run("one triangle", random_soup(1));
    run("all coincident", {std::vector<glm::vec3>(3, {0.3f, 0.2f, 0.1f}), {{0, 1, 2, 0}}});
    run("needles", {{{0, 0, 0}, {1, 1e-7f, 0}, {1, 0, 1e-7f}, {0, 0, 0}, {0, 1, 0}, {0, 2, 0}}, {{0, 1, 2, 0}, {3, 4, 5, 0}}});
    run("a plane", {{{-1, 0, -1}, {1, 0, -1}, {-1, 0, 1}, {1, 0, 1}}, {{0, 1, 2, 0}, {1, 3, 2, 0}}});
    for (const float scale : {1e-6f, 1e6f}) {
        Soup scaled = random_soup(60);
        for (auto& p : scaled.positions) p *= scale;
        run("scaled", scaled, scale);
    }
    Soup far = random_soup(60);
    for (auto& p : far.positions) p += vec3(1e6f, 0, 0);
    run("far away", far);
}

// The parts of a frame that is drawn in parts are the parts of the whole: a pair is the same in both, but for views that are not wanted.
TEST_F(MegaViewsTest, parts_of_the_views_have_the_pairs_of_the_whole) {
    const Bsh tree = build(random_soup(100), 10);
    const auto views = random_views(333);
    const auto whole = walk(tree, views, AppendMode::scan, 1, 16);
    std::vector<TerminalPair> of_parts;
    for (uint first : {0u, 100u, 300u}) {
        const uint limit = first == 300 ? 33 : first == 100 ? 200 : 100;
        check(tree, views, 1, 16, first, limit);
        const auto part = rendered_pairs(walk(tree, views, AppendMode::scan, 1, 16, first, limit).groups);
        of_parts.insert(of_parts.end(), part.begin(), part.end());
    }
    std::ranges::sort(of_parts);
    of_parts.erase(std::unique(of_parts.begin(), of_parts.end()), of_parts.end());  // of nodes that several parts have views of
    EXPECT_TRUE(same(rendered_pairs(whole.groups), of_parts));
}

// A view alone has its cut of ManyLoDs; many that are near to each other share most of it.
TEST_F(MegaViewsTest, a_lone_view_has_its_cut_and_near_ones_share) {
    const Bsh tree = build(random_soup(100), 12);
    const View lone = view({0.1f, 0.2f, 0.3f}, {0, 1, 1}, 1);
    const auto host = HostTree(device, tree);
    const auto cut = cut_ref(host, {lone}, 1, 16);
    std::vector<TerminalPair> expected;
    for (const NodeView& nv : cut.cut)
        if (!nv.culled && !pair_edge_on(lone, host.sphere(nv.slot), host.cones[nv.slot])) expected.push_back({1, nv.slot, false});  // the tree of one view has its root at 1
    EXPECT_TRUE(same(expected, rendered_pairs(walk(tree, {lone}, AppendMode::scan, 1, 16).groups)));
    std::vector<View> near;
    for (int i = 0; i < 500; ++i) near.push_back(view(lone.position + point(1e-4f), lone.direction, 1));
    const auto shared = walk(tree, near, AppendMode::scan, 1, 16).pairs.total;
    EXPECT_GT(double(shared.shared) / double(shared.rendered), 100);
    EXPECT_LT(shared.rendered, 3 * expected.size());
}

TEST_F(MegaViewsTest, lists_that_are_too_short_say_so) {
    const Bsh tree = build(random_soup(100), 9);
    const auto views = random_views(100);
    const auto ample = walk(tree, views, AppendMode::scan, 1, 16);
    for (AppendMode mode : {AppendMode::scan, AppendMode::atomic}) {
        const auto found = walk(tree, views, mode, 1, 16, 0, ~0u, 64);
        EXPECT_FALSE(found.lists.ok());
        EXPECT_GT(std::max(found.lists.next_needed, found.lists.kept_needed), 64u);
        EXPECT_TRUE(walk(tree, views, mode, 1, 16, 0, ~0u, std::max(ample.lists.next_needed, ample.lists.kept_needed)).lists.ok());
    }
}

// The check finds pairs that are missing, twice there, or culled for a view that sees them.
TEST_F(MegaViewsTest, the_check_finds_what_is_wrong) {
    const Bsh tree = build(random_soup(50), 6);
    const HostTree host(device, tree);
    const auto views = view_tree_ref(random_views(40), 40, vec3(-1), vec3(1));
    const auto good = pairs_ref(host, views, 0, 40, 1, 16).pairs;
    ASSERT_EQ(pairs_violation(host, views, 0, 40, good), "");
    auto bad = good;
    bad.pop_back();
    EXPECT_NE(pairs_violation(host, views, 0, 40, bad), "");
    bad = good;
    bad.push_back(bad[0]);
    EXPECT_NE(pairs_violation(host, views, 0, 40, bad), "");
    bad = good;
    for (TerminalPair& p : bad) p.culled = true;
    EXPECT_NE(pairs_violation(host, views, 0, 40, bad).find("culled"), std::string::npos);
}

}  // namespace
}  // namespace myriad::compute
