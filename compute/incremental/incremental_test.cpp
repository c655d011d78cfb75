#include "compute/incremental/incremental.hpp"

#include <algorithm>
#include <memory>

#include "compute/incremental/incremental_ref.hpp"
#include "engine/testing.hpp"

namespace myriad::compute {
namespace {

using engine::same;

class IncrementalTest : public engine::DeviceTest {
protected:
    float uniform(float lo = -1, float hi = 1) { return std::uniform_real_distribution<float>(lo, hi)(random); }
    float log_uniform(float lo, float hi) { return std::exp(uniform(std::log(lo), std::log(hi))); }
    glm::vec3 point(float scale = 1) { return glm::vec3(uniform(), uniform(), uniform()) * scale; }

    // ---- A scene that may move ----
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec4> triangles;
    std::unique_ptr<Bsh> tree;
    HostTree host;

    // The triangles from `first_moving` on may move alone.
    void soup(size_t n, uint32_t log2_samples, float size = 0.1f, uint first_moving = ~0u) {
        for (size_t i = 0; i < n; ++i) {
            const glm::vec3 middle = point();
            for (int k = 0; k < 3; ++k) positions.push_back(middle + point(size));
            triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2, 0});
        }
        WorldTriangles world{positions, triangles};
        world.first_moving = first_moving;
        tree = std::make_unique<Bsh>(device, world, log2_samples, 1);
        refit();
    }
    void refit(bool moving = false) {
        if (!tree->empty()) {
            const auto on_p = on_device(std::vector<vec3>(positions));
            const auto on_t = on_device(std::vector<uvec4>(triangles));
            engine::Recorder recorder(device);
            moving ? tree->refit_moving(recorder, on_p, on_t) : tree->refit(recorder, on_p, on_t);
            recorder.submit_and_wait();
        }
        host = HostTree(device, *tree);
    }

    // What a view's cut shows: its nodes, with all that is drawn of them.
    struct Seen {
        uint slot;
        Sphere sphere;
        uint cone;
        uvec2 box;
        bool operator==(const Seen& o) const {
            return slot == o.slot && sphere.center == o.sphere.center && sphere.radius == o.sphere.radius && cone == o.cone && box == o.box;
        }
    };
    std::vector<std::vector<Seen>> seen(const std::vector<NodeView>& cut, size_t views) {
        const auto cones = engine::download(device, tree->cones());
        const auto boxes = engine::download(device, tree->boxes());
        std::vector<std::vector<Seen>> seen(views);
        for (const NodeView& nv : cut)
            if (!nv.culled) seen[nv.view].push_back({nv.slot, host.sphere(nv.slot), cones[nv.slot], boxes[nv.slot]});
        return seen;
    }

    // ---- Views that move ----
    View view(glm::vec3 position, glm::vec3 direction, float phi) {
        return {position, phi == 1 ? 0 : phi == 2 ? -1 : std::cos(phi * 1.5707963f), glm::normalize(direction), phi == 1 ? 1 : phi == 2 ? 0 : std::sin(phi * 1.5707963f)};
    }
    View random_view() {
        const float phis[] = {1, 1, 0.5f, 1.5f, 2};
        return view(point(1.2f), point(), phis[random() % 5]);
    }
    View random_parallel_view() {
        return {point(3), -1 - float(1 + random() % 500), glm::normalize(point() + vec3(0, 0, 1e-3f)), log_uniform(0.3f, 10)};
    }
    std::vector<View> random_views(size_t n) {
        std::vector<View> views;
        while (views.size() < n) views.push_back(random_view());
        return views;
    }
    // Rest, drift, shift, turn, jump.
    void move(View& v) {
        switch (random() % 8) {
            case 0: case 1: break;
            case 2: v.position += point(log_uniform(1e-8f, 1e-3f)); break;
            case 3: v.position += point(log_uniform(1e-3f, 0.3f)); break;
            case 4: v.direction = glm::normalize(v.direction + point(log_uniform(1e-7f, 1e-2f))); break;
            case 5: v.direction = glm::normalize(v.direction + point(log_uniform(1e-2f, 1))); v.position += point(0.01f); break;
            case 6: v.position = positions.empty() ? vec3(0) : vec3(positions[random() % positions.size()]); break;  // on a surface
            default: if (random() % 8 == 0) v = random_view();
        }
    }

    struct Frame {
        std::vector<uvec2> groups;
        CarryReport report;
    };
    // One frame of views [0, views.size()) of at most `most`.
    Frame run(CarriedCut& cut, const std::vector<View>& views, uint32_t most, const CarrySettings& settings, float epsilon, uint map_size,
              BoundsTravel* travel = nullptr) {
        std::vector<View> all = views;
        all.resize(std::max<size_t>(most, 1), {vec3(7), 1, vec3(1, 0, 0), 0});
        const auto on = on_device(all);
        const auto count = on_device(std::vector<uint>{uint(views.size())});
        engine::Recorder recorder(device);
        if (travel) travel->record(recorder, *tree);
        cut.record(recorder, {*tree, on, count, 0, most, epsilon, map_size}, settings, travel);
        recorder.submit_and_wait();
        Frame frame{{}, cut.report()};
        frame.groups = engine::download(device, cut.lists().kept(), std::min<uint64_t>(frame.report.lists.kept, cut.lists().kept_capacity()));
        return frame;
    }
    // Without holes, and without the roots that stand for views that do not exist.
    static std::vector<NodeView> cut_of(const Frame& frame, size_t views) {
        std::vector<uvec2> groups;
        for (const uvec2& code : frame.groups)
            if (!cut_is_hole(code) && cut_unpack(code).view < views) groups.push_back(code);
        return node_views(groups);
    }
};

// The slack's promise: of a block's nodes, none that moves less changes side.
TEST_F(IncrementalTest, slack_is_not_exceeded_by_what_moves_less) {
    size_t changed = 0, used = 0, worth = 0, directed = 0;
    for (int i = 0; i < 200000; ++i) {
        const View v = random_view();
        const float epsilon = log_uniform(0.2f, 10), size = float(8u << random() % 5), q = size / epsilon;
        const float far = log_uniform(1e-3f, 10), spread = far * log_uniform(1e-3f, 1);
        const bool abreast = random() % 8 == 0;  // where |d.x| has its edge, which the view then passes
        const glm::vec3 middle = v.position + glm::normalize(point() * glm::vec3(abreast ? 0.03f : 1, 1, 1)) * far;
        std::vector<Sphere> nodes(1 + random() % 9);
        std::vector<uint> heights, sides;
        Slack slack = slack_begin(middle - v.position);
        for (Sphere& s : nodes) {
            s.center = middle + point(spread);
            const vec3 d = s.center - v.position;
            const float length = std::sqrt(dot(d, d));
            s.radius = length * (random() % 4 == 0 ? log_uniform(1e-6f, 2) : 2 / q * log_uniform(0.2f, 5));  // any, or about on the threshold
            heights.push_back(random() % 4);
            sides.push_back(classify(v, s, heights.back(), epsilon, uint(size)));
            slack = slack_with(slack, unpack_towards(slack.towards), v, d, s.radius, heights.back(), sides.back(), q);
        }
        Travel t{log_uniform(1e-6f, 10), log_uniform(1e-6f, 10), log_uniform(1e-6f, 10), travel_exists, v.position, vec3(0)};
        if (random() % 2) {  // on its way already
            t.come = point(log_uniform(1e-4f, 10));
            t.anchor = v.position - t.come;
            t.come = v.position - t.anchor;
        }
        Way way{log_uniform(1e-6f, 10), log_uniform(1e-6f, 1), 0};
        const Due due = due_after(t, way_length(way, q), slack);
        const bool by_direction = due.rise < 1e30f || due.fall < 1e30f;
        const float by_frustum = due.frustum - travelled_frustum(t, due.reach, way_length(way, q));
        const float free = std::clamp(due.criterion - travelled_criterion(t, way_length(way, q)), 0.0f, random() % 2 ? std::max(by_frustum, 0.0f) : 1e3f);
        const glm::vec3 heading = glm::normalize(point() * (abreast ? glm::vec3(1, 0.1f, 0.1f) : glm::vec3(1)));
        View moving = v;
        for (int step = 0; step < 4; ++step) {
            View now = moving;
            const float go = free * uniform(0, 0.6f) + log_uniform(1e-9f, 1e-3f) * (random() % 3 == 0);
            if (random() % 4) now.position += (random() % 2 ? heading : glm::normalize(point() + (middle - v.position) / far)) * go * (random() % 4 ? 1.0f : -1.0f);
            if (random() % 2 == 0) now.direction = glm::normalize(now.direction + glm::normalize(point()) * (go / far));
            t = travel_on(t, moving, true, now, true);
            moving = now;
            const bool shifts = random() % 4 == 0;
            if (shifts) {  // the nodes go their way too
                float centers = 0, radii = 0;
                for (Sphere& s : nodes) {
                    const Sphere before = s;
                    s.center += glm::normalize(point()) * go * 0.3f;
                    s.radius = std::max(0.0f, s.radius + uniform() * 0.3f * go / q);
                    centers = std::max(centers, glm::length(s.center - before.center));
                    radii = std::max(radii, std::abs(s.radius - before.radius));
                }
                way = way_on(way, centers, radii);
            }
            bool side = false;
            for (size_t k = 0; k < nodes.size(); ++k) side = side || classify(now, nodes[k], heights[k], epsilon, uint(size)) != sides[k];
            changed += side;
            const bool asked = travel_stirs(t) || shifts;
            if (asked && is_due(due, t, way_length(way, q))) break;
            ++used;
            worth += asked;
            directed += asked && by_direction;
            ASSERT_FALSE(side) << i << ": " << nodes.size() << " nodes, step " << step << " of free " << free << (by_direction ? " by direction" : "")
                               << " distance " << far << " spread " << spread << " q " << q;
        }
    }
    EXPECT_TRUE(changed > 1000 && used > 100000 && worth > 100000 && directed > 15000) << changed << " " << used << " " << worth << " " << directed;
}

// From whatever cut was there, over jumps, views that come and go, and geometry that moves: the basic cut, exactly.
TEST_F(IncrementalTest, follows_the_basic_cut_through_random_frames) {
    soup(150, 9);
    const uint32_t most = 24;
    for (AppendMode mode : {AppendMode::scan, AppendMode::atomic}) {
        CarriedCut cut(device, mode, 1 << 14, 0, most);
        std::vector<View> views = random_views(most);
        uint64_t evaluated = 0, needed = 0, reused = 0;
        for (int f = 0; f < 500; ++f) {
            SCOPED_TRACE(f);
            for (View& v : views) move(v);
            if (random() % 10 == 0) views.resize(random() % (most + 1), random_view());
            if (random() % 4 == 0) while (views.size() < most) views.push_back(random_view());
            const bool moved = random() % 12 == 0;
            if (moved) {
                for (auto& p : positions) p += point(f % 3 ? 0.01f : 0.3f);
                refit();
            }
            const Frame frame = run(cut, views, most, {}, 1, 16);
            ASSERT_TRUE(frame.report.lists.ok());
            const CutRef expected = cut_ref(host, views, 1, 16);
            ASSERT_TRUE(same(expected.cut, cut_of(frame, views.size())));
            ASSERT_EQ(partition_violation(host, cut_of(frame, views.size()), uint(views.size())), "");
            ASSERT_EQ(frame.report.invalid, 0u);
            ASSERT_EQ(frame.report.cut, expected.cut.size());
            if (f > 0 && !moved) evaluated += frame.report.lists.processed, needed += expected.tested;
            reused += frame.report.made > 0 && frame.report.holes > 0;
        }
        EXPECT_LT(evaluated, needed / 2) << "half of the views hardly move";
        EXPECT_GT(reused, 20u);
    }
}

// Where a part of the geometry moves, only what is above it and near a threshold is looked at again, and views that see none of it are told
// to be unchanged; all else as ever. At times all of the tree is refitted.
TEST_F(IncrementalTest, follows_geometry_that_moves_in_part) {
    const size_t first_moving = 120, n = 150;
    soup(n, 9, 0.1f, first_moving);
    const uint32_t most = 16;
    CarriedCut cut(device, AppendMode::scan, 1 << 14, 0, most);
    BoundsTravel travel(device);
    std::vector<View> views = random_views(most);
    for (size_t i = 0; i < 6; ++i) views[i] = view(vec3(0), point(), 0.3f);  // see little
    uint64_t evaluated = 0, needed = 0, unchanged = 0;
    std::vector<std::vector<Seen>> before;
    for (int f = 0; f < 150; ++f) {
        SCOPED_TRACE(f);
        if (f % 3 == 0) for (size_t i = 0; i < views.size(); i += 2) move(views[i]);
        if (f % 40 == 20) views.resize(most - 3), before.resize(most - 3);
        if (f % 40 == 30) while (views.size() < most) views.push_back(random_view()), before.emplace_back();
        if (f % 5 != 4) {  // rests at times
            const bool all = f % 50 == 7;
            const size_t part = all ? 0 : first_moving + random() % 15;
            const float far = log_uniform(1e-6f, f % 10 ? 0.02f : 0.5f);
            for (size_t i = 3 * part; i < 3 * (part + 15); ++i) positions[i] += f % 2 ? vec3(0, far, 0) : vec3(point(far));
            refit(!all);
        }
        const Frame frame = run(cut, views, most, {}, 1, 16, &travel);
        const CutRef expected = cut_ref(host, views, 1, 16);
        ASSERT_TRUE(same(expected.cut, cut_of(frame, views.size())));
        if (f > 0) evaluated += frame.report.lists.processed, needed += expected.tested;
        const std::vector<uint> changed = engine::download(device, cut.changed());
        EXPECT_EQ(frame.report.changed, uint64_t(std::count(changed.begin(), changed.end(), 1u)));
        const std::vector<std::vector<Seen>> now = seen(expected.cut, views.size());
        for (size_t v = 0; v < views.size() && f > 0; ++v) {
            if (changed[v]) continue;
            ++unchanged;
            ASSERT_TRUE(same(before[v], now[v])) << "view " << v;
        }
        before = now;
    }
    EXPECT_LT(evaluated, needed / 5) << "half of the views move at times";
    EXPECT_GT(unchanged, 300u);
}

// A view of nothing draws nothing, and is changed by what comes and goes all the same.
TEST_F(IncrementalTest, what_comes_into_view_changes_it) {
    soup(8, 6, 0.1f, 0);
    const std::vector<View> views = {view(vec3(0, 0, 9), vec3(0, 0, 1), 0.2f), view(vec3(0, 0, 9), vec3(0, 0, -1), 0.2f)};  // looks away, looks at it
    CarriedCut cut(device, AppendMode::scan, 1 << 12, 0, 2);
    BoundsTravel travel(device);
    run(cut, views, 2, {}, 1, 16, &travel);
    EXPECT_EQ(run(cut, views, 2, {}, 1, 16, &travel).report.changed, 0u);
    const auto shift = [&](float z) {
        for (auto& p : positions) p.z += z;
        refit(true);
        return run(cut, views, 2, {}, 1, 16, &travel).report.changed;
    };
    EXPECT_EQ(shift(0.01f), 1u) << "the one that looks at it";
    EXPECT_EQ(shift(20), 2u);
    EXPECT_EQ(shift(0.01f), 1u) << "the other";
    EXPECT_EQ(shift(-20), 2u);
}

// Parallel views change side by radii alone, which slack covers.
TEST_F(IncrementalTest, slack_of_parallel_views_is_not_exceeded_by_radii) {
    size_t changed = 0, used = 0;
    for (int i = 0; i < 200000; ++i) {
        const View v = random_parallel_view();
        const float epsilon = log_uniform(0.2f, 10), size = float(8u << random() % 5), q = size / epsilon;
        const uint height = random() % 4;
        Sphere s{point(), v.sin_phi / q * (random() % 2 ? log_uniform(0.01f, 100) : uniform(0.9f, 1.1f))};
        const uint where = classify(v, s, height, epsilon, uint(size));
        ASSERT_NE(where, node_view_culled);
        const Slack begun = slack_begin(s.center);
        const Slack slack = slack_with(begun, unpack_towards(begun.towards), v, s.center - v.position, s.radius, height, where, q);
        Travel t{0, 0, 0, travel_exists | travel_moved, v.position, vec3(0)};
        Way way{log_uniform(1e-6f, 10), log_uniform(1e-6f, 1), 0};
        const Due due = due_after(t, way_length(way, q), slack);
        for (int step = 0; step < 4; ++step) {
            const float before = s.radius;
            s.center += point(log_uniform(1e-9f, 1e-3f));
            s.radius = std::max(0.0f, s.radius + uniform() * (random() % 3 ? std::abs(v.sin_phi / q - s.radius) : s.radius));
            way = way_on(way, 0, std::abs(s.radius - before));
            const bool side = classify(v, s, height, epsilon, uint(size)) != where;
            changed += side;
            if (is_due(due, t, way_length(way, q))) break;
            ++used;
            ASSERT_FALSE(side) << i << ": " << where << " slack " << slack.any << " radius " << before << " to " << s.radius << " of " << v.sin_phi / q;
        }
    }
    EXPECT_TRUE(changed > 1000 && used > 100000) << changed << " " << used;
}

// Views of an environment rest as a rule; here they also jump, come and go, and geometry moves under them.
TEST_F(IncrementalTest, parallel_views_follow_the_basic_cut) {
    soup(150, 9);
    const uint32_t most = 16;
    for (AppendMode mode : {AppendMode::scan, AppendMode::atomic}) {
        CarriedCut cut(device, mode, 1 << 14, 0, most, {{parallel_constant, 1}});
        BoundsTravel travel(device);
        std::vector<View> views(most);
        for (View& v : views) v = random_parallel_view();
        uint64_t evaluated = 0, needed = 0, drawn = 0;
        for (int f = 0; f < 150; ++f) {
            SCOPED_TRACE(f);
            if (random() % 4 == 0) views[random() % views.size()] = random_parallel_view();
            if (random() % 8 == 0) views[random() % views.size()].position += point(0.1f);
            if (random() % 12 == 0) views.resize(1 + random() % most, random_parallel_view());
            if (f % 2) {
                const size_t part = random() % 100 * 3;
                const float far = log_uniform(1e-6f, f % 10 ? 0.02f : 0.5f);
                for (size_t i = part; i < part + 60; ++i) positions[i] += point(far);
                refit();
            }
            const Frame frame = run(cut, views, most, {}, 1, 16, &travel);
            const CutRef expected = cut_ref(host, views, 1, 16);
            ASSERT_TRUE(same(expected.cut, cut_of(frame, views.size())));
            ASSERT_EQ(partition_violation(host, cut_of(frame, views.size()), uint(views.size())), "");
            if (f > 0) evaluated += frame.report.lists.processed, needed += expected.tested;
            for (const NodeView& nv : expected.cut) drawn += !bsh_is_leaf(nv.slot, host.leaves) && !nv.culled;
        }
        EXPECT_LT(evaluated, needed / 3);
        EXPECT_GT(drawn, 1000u) << "cuts end above the leaves";
    }
}

// 3.3: the twin evaluates everything in every frame, the device what is due; the cuts are the same.
TEST_F(IncrementalTest, lazy_lags_by_the_edges_it_may_not_walk) {
    soup(150, 12);
    const uint32_t most = 12;
    for (uint32_t edges : {1u, 2u, 3u}) {
        CarriedCut cut(device, edges == 2 ? AppendMode::atomic : AppendMode::scan, 1 << 15, 0, most);
        CarriedCutRef twin;
        std::vector<View> views = random_views(most);
        uint64_t invalid = 0;
        for (int f = 0; f < 100; ++f) {
            SCOPED_TRACE(testing::Message() << "q " << edges << " frame " << f);
            if (f % 10 > 3) for (View& v : views) move(v);  // rests at times, and catches up
            if (random() % 10 == 0) views.resize(random() % (most + 1), random_view());
            if (random() % 4 == 0) while (views.size() < most) views.push_back(random_view());
            const Frame frame = run(cut, views, most, {.edges = edges}, 0.7f, 32);
            twin.update(host, views, most, 0.7f, 32, edges);
            ASSERT_TRUE(same(twin.cut(host, views, 0.7f, 32), cut_of(frame, views.size())));
            ASSERT_EQ(frame.report.invalid, twin.invalid());
            ASSERT_EQ(frame.report.cut, cut_of(frame, views.size()).size());
            ASSERT_EQ(partition_violation(host, cut_of(frame, views.size()), uint(views.size())), "");
            invalid += frame.report.invalid;
        }
        EXPECT_GT(invalid, 0u);
        for (uint32_t rest = 0; rest < tree->levels(); ++rest) run(cut, views, most, {.edges = edges}, 0.7f, 32);
        EXPECT_TRUE(same(cut_ref(host, views, 0.7f, 32).cut, cut_of(run(cut, views, most, {.edges = edges}, 0.7f, 32), views.size())));
    }
}

TEST_F(IncrementalTest, what_rests_costs_no_evaluation) {
    soup(100, 9);
    const std::vector<View> views = random_views(30);
    CarriedCut cut(device, AppendMode::scan, 1 << 14, 0, 30);
    EXPECT_GT(run(cut, views, 30, {}, 1, 32).report.lists.processed, 1000u);
    for (int f = 0; f < 3; ++f) {
        const CarryReport still = run(cut, views, 30, {}, 1, 32).report;
        EXPECT_EQ(still.lists.processed, 0u);
        EXPECT_EQ(still.due + still.made + still.dropped + still.changed, 0u);
    }
    std::vector<View> one = views;
    one[7].position += 0.3f;
    const CarryReport some = run(cut, one, 30, {}, 1, 32).report;
    EXPECT_TRUE(some.due > 0 && some.due < some.items() / 10) << some.due << " of " << some.items();
    EXPECT_EQ(some.changed, 1u);
    // One that went to nothing and came back has its slack again.
    std::vector<View> gone = one;
    gone[7] = {vec3(1e15f, 0, 0), 0, vec3(1, 0, 0), 1};
    run(cut, gone, 30, {}, 1, 32);
    run(cut, one, 30, {}, 1, 32);
    one[7].position += 1e-5f;
    const CarryReport back = run(cut, one, 30, {}, 1, 32).report;
    EXPECT_LT(back.due, some.due / 4);
    const CarryReport all = run(cut, one, 30, {.everything = true}, 1, 32).report;
    EXPECT_EQ(all.due, all.items()) << "the paper's way";
    EXPECT_EQ(all.made + all.dropped, 0u);
}

TEST_F(IncrementalTest, same_frames_same_bits) {
    soup(100, 9);
    std::vector<std::vector<View>> path{random_views(40)};
    for (int f = 0; f < 6; ++f) {
        path.push_back(path.back());
        for (View& v : path.back()) move(v);
    }
    CarriedCut a(device, AppendMode::scan, 1 << 14, 0, 40), b(device, AppendMode::scan, 1 << 14, 0, 40);
    for (const auto& views : path) EXPECT_TRUE(same(run(a, views, 40, {}, 1, 32).groups, run(b, views, 40, {}, 1, 32).groups));
}

TEST_F(IncrementalTest, trees_and_view_counts_at_boundaries) {
    for (uint32_t depth : {0u, 1u, 3u, 4u, 8u}) {
        positions.clear(), triangles.clear();
        soup(40, depth);
        for (uint32_t n : {1u, 7u, 65u}) {
            SCOPED_TRACE(testing::Message() << "depth " << depth << " views " << n);
            std::vector<View> views = random_views(n);
            CarriedCut cut(device, AppendMode::scan, 1 << 14, 0, n);
            for (int f = 0; f < 4; ++f) {
                ASSERT_TRUE(same(cut_ref(host, views, 1, 32).cut, cut_of(run(cut, views, n, {}, 1, 32), n)));
                for (View& v : views) move(v);
            }
        }
    }
    positions.clear(), triangles.clear();
    soup(0, 9);
    CarriedCut cut(device, AppendMode::scan, 64, 0, 5);
    const CarryReport empty = run(cut, random_views(5), 5, {}, 1, 32).report;
    EXPECT_EQ(empty.lists.kept + empty.cut + empty.invalid, 0u);
}

// Hard cases of the spec: sizes, distances, coincidence, thresholds met exactly.
TEST_F(IncrementalTest, hard_cases) {
    const auto check = [&](const char* name, float scale, glm::vec3 origin) {
        SCOPED_TRACE(name);
        tree = std::make_unique<Bsh>(device, WorldTriangles{positions, triangles}, 9, 1);
        refit();
        for (float epsilon : {1.0f, 20.0f}) {
            CarriedCut cut(device, AppendMode::scan, 1 << 15, 0, 30);
            std::vector<View> views = random_views(30);
            for (View& v : views) v.position = v.position * scale + origin;
            for (int f = 0; f < 12; ++f) {
                ASSERT_TRUE(same(cut_ref(host, views, epsilon, 32).cut, cut_of(run(cut, views, 30, {}, epsilon, 32), 30)));
                for (View& v : views) {
                    View w = v;
                    w.position = (w.position - origin) / scale;
                    move(w);
                    w.position = random() % 4 || positions.empty() ? w.position * scale + origin : vec3(positions[random() % positions.size()]);
                    v = w;
                }
            }
        }
    };
    const auto random_soup = [&](size_t n, float scale, glm::vec3 origin) {
        positions.clear(), triangles.clear();
        for (size_t i = 0; i < n; ++i) {
            const glm::vec3 middle = point();
            for (int k = 0; k < 3; ++k) positions.push_back((middle + point(0.1f)) * scale + origin);
            triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2, 0});
        }
    };
    for (float scale : {1e-6f, 1e6f, 1e-12f}) {
        random_soup(60, scale, vec3(0));
        check("scaled", scale, vec3(0));
    }
    random_soup(60, 1, vec3(1e6f));
    check("a million away", 1, vec3(1e6f));
    positions.assign(3, glm::vec3(0.3f, 0.2f, 0.1f)), triangles = {{0, 1, 2, 0}};
    check("coincident", 1, vec3(0));
    random_soup(60, 1e-3f, vec3(0));
    for (glm::vec3 p : {glm::vec3(-1, 0, -1), glm::vec3(1, 0, -1), glm::vec3(0, 0, 1)}) positions.push_back(p * 1e3f);
    triangles.push_back({180, 181, 182, 0});
    check("one to a million", 1, vec3(0));
}

TEST_F(IncrementalTest, a_list_that_is_too_short_says_so_and_a_longer_one_has_the_cut) {
    soup(100, 9);
    std::vector<View> views = random_views(20);
    const auto expected = cut_ref(host, views, 1, 32).cut;
    for (AppendMode mode : {AppendMode::scan, AppendMode::atomic}) {
        int redone = 0;
        for (uint64_t capacity = 20;; ++redone) {
            ASSERT_LT(redone, 20);
            CarriedCut cut(device, mode, capacity, 0, 20);
            const Frame frame = run(cut, views, 20, {}, 1, 32);
            if (frame.report.lists.ok()) {
                EXPECT_TRUE(same(expected, cut_of(frame, 20)));
                EXPECT_TRUE(same(expected, cut_of(run(cut, views, 20, {}, 1, 32), 20)));
                break;
            }
            capacity = std::max({capacity + 1, frame.report.lists.next_needed, frame.report.lists.kept_needed});
        }
        EXPECT_GT(redone, 0);
        // One place too few, and just enough; and a list that the first views fit, but not all.
        CarriedCut ample(device, mode, 1 << 14, 0, 20);
        const uint64_t items = run(ample, views, 20, {}, 1, 32).report.lists.kept;
        CarriedCut tight(device, mode, items - 1, 0, 20), enough(device, mode, items, 0, 20);
        const AppendReport overflow = run(tight, views, 20, {}, 1, 32).report.lists;
        EXPECT_TRUE(overflow.kept_overflowed && overflow.kept_needed == items);
        EXPECT_TRUE(run(enough, {views.begin(), views.begin() + 2}, 20, {}, 1, 32).report.lists.ok());
        EXPECT_TRUE(same(expected, cut_of(run(enough, views, 20, {}, 1, 32), 20)));
        CarriedCut later(device, mode, items - 1, 0, 20);
        EXPECT_TRUE(run(later, {views.begin(), views.begin() + 2}, 20, {}, 1, 32).report.lists.ok());
        EXPECT_FALSE(run(later, views, 20, {}, 1, 32).report.lists.ok());
    }
}

TEST_F(IncrementalTest, restart_forgets) {
    soup(100, 9);
    std::vector<View> views = random_views(20);
    CarriedCut cut(device, AppendMode::scan, 1 << 14, 0, 20);
    const Frame first = run(cut, views, 20, {}, 1, 32);
    cut.restart();
    const Frame again = run(cut, views, 20, {}, 1, 32);
    EXPECT_TRUE(same(first.groups, again.groups));
    EXPECT_EQ(first.report.lists.processed, again.report.lists.processed);
}

}  // namespace
}  // namespace myriad::compute
