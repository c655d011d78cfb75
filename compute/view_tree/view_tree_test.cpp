#include "compute/view_tree/view_tree.hpp"

#include <algorithm>

#include "compute/bsh/tree_testing.hpp"
#include "compute/view_tree/view_tree_ref.hpp"

namespace myriad::compute {
namespace {

class ViewTreeTest : public TreeTest {
protected:
    std::vector<View> random_views(size_t n, float scale = 1) {
        const float phis[] = {0.5f, 1, 1, 1, 2};  // right angles
        std::vector<View> views;
        for (size_t i = 0; i < n; ++i) views.push_back(view(point(scale), point(), phis[random() % 5]));
        return views;
    }
    HostViewTree build(const std::vector<View>& views, uint32_t capacity, vec3 low = vec3(-1), vec3 high = vec3(1)) {
        ViewTree tree(device, capacity);
        std::vector<View> room = views;
        room.resize(capacity, view({7, 7, 7}, {0, 1, 0}, 1));  // there, and not counted
        const auto on = on_device(room);
        const auto count = on_device(std::vector<uint>{uint(views.size())});
        engine::Recorder recorder(device);
        for (int again = 0; again < 2; ++again) tree.record(recorder, on, count, low, high);
        recorder.submit_and_wait();
        return view_tree_download(device, tree, uint32_t(views.size()));
    }
    void check(const std::vector<View>& views, uint32_t capacity, vec3 low = vec3(-1), vec3 high = vec3(1)) {
        const HostViewTree expected = view_tree_ref(views, capacity, low, high), found = build(views, capacity, low, high);
        ASSERT_EQ(view_tree_violation(expected, views), "") << "twin";
        ASSERT_EQ(view_tree_violation(found, views), "");
        EXPECT_TRUE(engine::same(expected.order, found.order));
        ASSERT_EQ(expected.groups.size(), found.groups.size());
        ASSERT_EQ(expected.levels.size(), found.levels.size());
        for (size_t i = 0; i < expected.groups.size(); ++i) {
            const ViewGroup &a = expected.groups[i], &b = found.groups[i];
            ASSERT_TRUE(a.first_child == b.first_child && a.children == b.children && a.first == b.first && a.end == b.end) << i;
            ASSERT_NEAR(a.radius, b.radius, 1e-5f * a.radius) << i;
            const View &c = expected.nodes[capacity + i], &d = found.nodes[capacity + i];
            // Near pi the cosine says little of the angle, and a sum may fall to either side of it.
            if (std::min(c.cos_phi, d.cos_phi) > -0.9999f) {
                ASSERT_NEAR(c.cos_phi, d.cos_phi, 1e-5f) << i;
            }
        }
    }
};

TEST_F(ViewTreeTest, equals_the_twin_at_sizes_around_its_own) {
    for (uint32_t n : {0, 1, 2, 7, 8, 9, 16, 63, 64, 65, 300, 5000}) {
        SCOPED_TRACE(n);
        check(random_views(n), std::max(n, 1u));
        check(random_views(n), n + 100);
    }
}

TEST_F(ViewTreeTest, more_views_than_there_is_room_for) {
    ViewTree tree(device, 10);
    const auto views = random_views(10);
    const auto on = on_device(views);
    const auto count = on_device(std::vector<uint>{1000});
    engine::Recorder recorder(device);
    tree.record(recorder, on, count, vec3(-1), vec3(1));
    recorder.submit_and_wait();
    EXPECT_EQ(view_tree_violation(view_tree_download(device, tree, 10), views), "");
}

TEST_F(ViewTreeTest, hard_places) {
    const auto at = [&](size_t n, auto place) {
        std::vector<View> views;
        for (size_t i = 0; i < n; ++i) views.push_back(view(place(i), point(), 1));
        return views;
    };
    check(at(1000, [](size_t) { return vec3(0.3f, 0.2f, 0.1f); }), 1000);                                             // one place
    check(at(1000, [](size_t i) { return vec3(0.3f + 1e-7f * float(i % 3), 0.2f, 0.1f); }), 1000);                   // one cell, three places
    check(at(500, [](size_t i) { return vec3(float(i) / 250 - 1, 0, 0); }), 500);                                     // a line
    check(at(500, [&](size_t) { return vec3(uniform(), 0, uniform()); }), 500);                                        // a plane
    check(at(500, [&](size_t) { return point(100); }), 500);                                                           // mostly outside of the box
    check(at(500, [&](size_t) { return point(1e-6f); }), 500, vec3(-1e-6f), vec3(1e-6f));
    check(at(500, [&](size_t) { return point(1e6f); }), 500, vec3(-1e6f), vec3(1e6f));
    check(at(500, [&](size_t) { return point() + vec3(1e6f, 0, 0); }), 500, vec3(1e6f - 1, -1, -1), vec3(1e6f + 1, 1, 1));
    check(at(500, [&](size_t i) { return i < 499 ? point(1e-3f) : vec3(1); }), 500);                                   // one far from the others
    check(random_views(100), 100, vec3(0), vec3(0));                                                                   // a box that is a point
}

TEST_F(ViewTreeTest, views_that_see_nothing_widen_no_bounds) {
    std::vector<View> views = random_views(200);
    for (size_t i = 0; i < views.size(); i += 3) views[i] = view_of_nothing();
    check(views, 200);
    EXPECT_LT(build(views, 200).groups[0].radius, 2);
    check(std::vector<View>(50, view_of_nothing()), 50);
    EXPECT_TRUE(view_sees_nothing(build(std::vector<View>(50, view_of_nothing()), 50).nodes[50]));
}

TEST_F(ViewTreeTest, a_million_views_at_one_place) {
    const uint32_t n = ViewTree::most_views;
    const HostViewTree tree = build(std::vector<View>(n, view({0.1f, 0.2f, 0.3f}, {0, 1, 0}, 1)), n);
    EXPECT_EQ(tree.levels.size(), 7u);
    EXPECT_EQ(tree.groups[0].end, n);
    EXPECT_EQ(tree.groups[0].radius, 0);
}

// What each check of the tree looks at, broken.
TEST_F(ViewTreeTest, the_check_finds_what_is_wrong) {
    const auto views = random_views(100);
    const HostViewTree good = view_tree_ref(views, 100, vec3(-1), vec3(1));
    ASSERT_EQ(view_tree_violation(good, views), "");
    const auto finds = [&](const char* what, auto spoil) {
        HostViewTree bad = good;
        spoil(bad);
        EXPECT_NE(view_tree_violation(bad, views).find(what), std::string::npos) << what << ": " << view_tree_violation(bad, views);
    };
    finds("permutation", [](HostViewTree& t) { t.order[3] = t.order[4]; });
    finds("sphere", [](HostViewTree& t) { t.groups[0].radius *= 0.5f; });
    finds("cone", [](HostViewTree& t) { t.nodes[t.capacity + t.groups.size() - 1].cos_phi = 0.99f, t.nodes[t.capacity + t.groups.size() - 1].sin_phi = 0.14f; });
    finds("elsewhere", [](HostViewTree& t) { ++t.groups.back().end; });
    finds("another view", [](HostViewTree& t) { t.nodes[5].position.x += 1; });
}

}  // namespace
}  // namespace myriad::compute
