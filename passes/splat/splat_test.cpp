#include "passes/splat/splat.hpp"

#include <algorithm>
#include <functional>

#include <glm/gtc/matrix_transform.hpp>

#include "compute/manylods/manylods.hpp"
#include "compute/raytrace/raytrace_io.h"
#include "compute/views/view_testing.hpp"
#include "engine/testing.hpp"
#include "passes/environment/environment.hpp"
#include "passes/geometry/geometry_ref.hpp"
#include "passes/geometry/test_scene.hpp"
#include "passes/kernels.hpp"
#include "passes/splat/splat_ref.hpp"

namespace myriad::passes {
namespace {

using compute::AppendLists, compute::AppendMode, compute::Bsh, compute::BshArrays, compute::view;
using engine::same;

class SplatTest : public engine::DeviceTest {
protected:
    float uniform(float lo = -1, float hi = 1) { return std::uniform_real_distribution<float>(lo, hi)(random); }
    vec3 point(float scale = 1) { return scale * vec3(uniform(), uniform(), uniform()); }
    std::vector<View> random_views(size_t n, float scale) { return compute::random_views(random, n, scale, {0.7f, pi / 2, 2.5f, pi}); }

    std::vector<View> parallel_views(const TestScene& scene, size_t n, uint map_size) {
        std::vector<View> views;
        while (views.size() < n) {
            const vec3 d = point();
            views.push_back(parallel_view(normalize(dot(d, d) > 0.01f && random() % 4 ? d : vec3(views.size() % 2, views.size() % 2 ? 0 : -1, 0)), scene.triangles.lo, scene.triangles.hi, map_size));
        }
        return views;
    }
    uint arity = 8, coverage = coverage_exact;
    engine::Constants kind_of(const std::vector<View>& views) const {
        engine::Constants constants = compute::bsh_constants(arity);
        constants[parallel_constant] = !views.empty() && is_parallel(views[0]);
        constants[coverage_constant] = coverage;
        return constants;
    }

    // A scene and its tree on the device, and the tree read back.
    struct Tree {
        TestScene scene;
        std::unique_ptr<UploadedScene> uploaded;
        Bsh bsh;
        BshArrays host;
    };
    Tree grow(const TestScene& scene, uint32_t log2_samples) {
        auto uploaded = std::make_unique<UploadedScene>(device, scene);
        const compute::WorldTriangles& world = uploaded->data.world;
        Tree tree{scene, std::move(uploaded), Bsh(device, world, log2_samples, 1, arity), {}};
        if (tree.bsh.empty()) return tree;
        engine::Recorder recorder(device);
        tree.bsh.refit(recorder, tree.uploaded->geometry.positions(), tree.uploaded->geometry.triangles(), nullptr, tree.uploaded->geometry.opacity());
        recorder.submit_and_wait();
        tree.host = compute::bsh_download(device, tree.bsh);
        return tree;
    }
    Tree random_tree(uint32_t log2_samples) {
        TestScene scene;
        scene.material(vec3(1));
        scene.soup(40, 1, random);
        scene.quad(vec3(-1), {2, 0, 0}, {0, 0.3f, 2}, 0);
        return grow(scene, log2_samples);
    }

    std::vector<uvec2> cut(const Tree& tree, const std::vector<View>& views, float epsilon, uint map_size, uint32_t first = 0) {
        const auto on = on_device(views);
        const auto count = on_device(std::vector<uint>{uint(views.size())});
        AppendLists lists(device, AppendMode::scan, 1 << 18, 1 << 18);
        engine::Recorder recorder(device);
        compute::ManyLods(device, kind_of(views)).record(recorder, lists, {tree.bsh, on, count, first, uint32_t(views.size()), epsilon, map_size});
        recorder.submit_and_wait();
        EXPECT_TRUE(lists.report().ok());
        return engine::download(device, lists.kept(), lists.report().kept);
    }

    struct Options {
        uint32_t first = 0, maps = 0;       // maps 0: of all views
        uint64_t capacity = 0, claimed = 0; // of the list, and how many groups its counter claims; 0: as many as there are
        uint32_t threads_per_group = 0;     // 0: what SplatPass chooses for the device
        uint32_t failed = 0;                // the lists' word of that name
    };
    // What the kernel makes of these groups; they need not come from a cut.
    std::vector<uint> splat(const Tree& tree, const std::vector<uvec2>& groups, const std::vector<View>& views, uint map_size, Options o) {
        if (!o.maps) o.maps = uint32_t(views.size()) - o.first;
        AppendLists lists(device, AppendMode::scan, 64, o.capacity ? o.capacity : std::max<size_t>(groups.size(), 1));
        engine::upload_bytes(device, groups.data(), lists.kept(), std::min<uint64_t>(groups.size(), lists.kept_capacity()) * sizeof(uvec2));
        std::vector<uint> state(lists.state().count());
        state[AppendLists::kept_word] = uint(o.claimed ? o.claimed : groups.size());
        state[AppendLists::failed_word] = o.failed;
        engine::upload_bytes(device, state.data(), lists.state(), state.size() * sizeof(uint));
        const auto on = on_device(views);
        engine::Array<uint> atlas(device, "test", "atlas", o.maps * map_texels(map_size));
        SplatPass pass(device, kind_of(views));
        compute::Grid grid(device);
        engine::Recorder recorder(device);
        if (!o.threads_per_group) {
            pass.record(recorder, {lists, tree.bsh, on, o.first, map_size}, atlas);
        } else {
            recorder.fill(atlas, atlas_nothing);
            engine::Constants constants = kind_of(views);
            constants[2] = o.threads_per_group;
            const engine::Program program(device, engine::passes_kernels, "splat/splat", constants);
            grid.dispatch(recorder, program, lists.state(), AppendLists::kept_word, lists.kept_capacity(), o.threads_per_group, [&] {
                return SplatPush{recorder.read(lists.kept()), recorder.read(lists.state(), AppendLists::kept_word),
                                 recorder.read(lists.state(), AppendLists::failed_word), tree.bsh.read(recorder),
                                 recorder.read(on), recorder.write(atlas), uint(lists.kept_capacity()), map_size, o.first};
            });
        }
        recorder.submit_and_wait();
        return engine::download(device, atlas);
    }

    // The cut of these views, by both variants of the kernel, against the twin. Returns the share of texels that hold something.
    double check(const Tree& tree, const std::vector<View>& views, float epsilon, uint map_size) {
        const auto groups = cut(tree, views, epsilon, map_size);
        const auto expected = splat_ref(tree.host, groups, views, 0, uint(views.size()), map_size, coverage);
        EXPECT_TRUE(same(expected, splat(tree, groups, views, map_size, {})));
        EXPECT_TRUE(same(expected, splat(tree, groups, views, map_size, {.threads_per_group = 8})));
        return 1 - double(std::ranges::count(expected, atlas_nothing)) / double(expected.size());
    }
};

TEST_F(SplatTest, cuts_of_every_map_size) {
    const Tree tree = random_tree(9);
    for (uint size : {2u, 3u, 16u, 31u, 64u}) {
        SCOPED_TRACE(size);
        for (float epsilon : {0.3f, 2.0f}) EXPECT_GT(check(tree, random_views(9, 1.5f), epsilon, size), 0.2);
    }
}

TEST_F(SplatTest, trees_of_every_arity) {
    for (const uint a : {2u, 4u}) {
        SCOPED_TRACE(a);
        arity = a;
        for (const uint32_t depth : {0u, 1u, 3u, 9u}) check(random_tree(depth), random_views(9, 1.5f), 1, 16);
    }
}

// A pane of alpha 0.4 fills two fifths of the maps, and each wholly or not at all, at every level of detail and every stride of views.
TEST_F(SplatTest, blended_surfaces_are_there_in_their_share_of_views) {
    TestScene scene;
    scenes::Material& m = scene.scene.materials[scene.material(vec3(1))];
    m.alpha = scenes::Material::Alpha::blend, m.base_color.a = 0.4f;
    scene.quad({-9, 1, -9}, {0, 0, 18}, {18, 0, 0}, 0);
    scene.soup(30, 1, random);
    const Tree tree = grow(scene, 10);
    EXPECT_GT(check(tree, random_views(40, 1), 1, 16), 0.2);

    scene.triangles.triangles.resize(2);  // the quad alone
    const Tree pane = grow(scene, 10);
    const std::vector<View> views(2048, view(vec3(0), {0, 1, 0}, pi / 2));
    for (float epsilon : {0.5f, 4.0f}) {
        const auto atlas = splat(pane, cut(pane, views, epsilon, 8), views, 8, {});
        std::vector<uint> covered;
        for (size_t v = 0; v < views.size(); ++v)
            covered.push_back(uint(128 - std::count(&atlas[v * 128], &atlas[v * 128] + 128, atlas_nothing)));
        const uint all = *std::max_element(covered.begin(), covered.end());
        EXPECT_GT(all, 20u);
        for (size_t stride : {1u, 4u, 16u, 64u}) {
            size_t shown = 0, of = 0;
            for (size_t v = 1; v < views.size(); v += stride) {
                ASSERT_TRUE(covered[v] == 0 || covered[v] == all);
                shown += covered[v] == all, ++of;
            }
            EXPECT_NEAR(double(shown) / double(of), 0.4, 0.03) << stride;
        }
    }
}

TEST_F(SplatTest, trees_of_every_depth) {
    for (uint32_t depth : {0u, 1u, 2u, 3u, 4u, 6u, 12u}) {
        SCOPED_TRACE(depth);
        EXPECT_GT(check(random_tree(depth), random_views(12, 1.5f), 1, 16), 0.02);
    }
}

TEST_F(SplatTest, parallel_views_of_every_map_size) {
    for (uint32_t depth : {0u, 3u, 7u, 12u}) {
        const Tree tree = random_tree(depth);
        for (uint size : {2u, 16u, 31u}) {
            SCOPED_TRACE(testing::Message() << depth << ", " << size);
            EXPECT_GT(check(tree, parallel_views(tree.scene, 12, size), depth == 12 ? 0.5f : 2, size), 0.02);
        }
    }
}

// Fine cuts, most of whose nodes are smaller than a texel.
TEST_F(SplatTest, every_coverage) {
    const Tree tree = random_tree(12);
    for (coverage = coverage_exact; coverage <= coverage_stochastic; ++coverage)
        for (const uint size : {2u, 16u, 31u}) {
            SCOPED_TRACE(testing::Message() << "coverage " << coverage << ", maps of " << size);
            EXPECT_GT(check(tree, random_views(12, 1.5f), 0.4f, size), 0.2);
            EXPECT_GT(check(tree, parallel_views(tree.scene, 12, size), 0.6f, size), 0.02);
        }
}

// A square of 0.36 texels fills, in the mean, 0.36 of a texel: of many views by the dice, of many places by the texels' middles. A point fills one.
TEST_F(SplatTest, small_nodes_cover_their_share_of_texels) {
    const uint size = 32;
    const float distance = 10, texel = 4 * distance / float(size), side = 0.6f * texel;  // along the axis du subtends 2 du
    TestScene scene;
    scene.material(vec3(1));
    scene.quad({distance, -side / 2, -side / 2}, {0, side, 0}, {0, 0, side}, 0);
    const Tree tree = grow(scene, 6);
    std::vector<View> still(4096, view({0, 0.3f * texel, 0.1f * texel}, {1, 0, 0}, pi)), parallel(4096, parallel_view({1, 0, 0}, {0, -34, -34}, {distance, 34, 34}, size));
    std::vector<View> moved = still;
    for (View& v : moved) v.position += texel * vec3(0, uniform(), uniform());
    const auto covered = [&](const std::vector<View>& views) {
        const auto groups = cut(tree, views, 1, size);
        EXPECT_EQ(groups.size(), views.size()) << "the root in each";
        const auto atlas = splat(tree, groups, views, size, {});
        return 1.0 / double(views.size()) * double(atlas.size() - size_t(std::ranges::count(atlas, atlas_nothing)));
    };
    const double share = 0.36, sigma = std::sqrt(share * (1 - share) / 4096);
    const double margin = 2 * 2 * double(side) / double(texel) * 0.6 / 128;  // boxes are drawn by splat_margin of a radius larger, and curve
    const float parallel_side = side / parallel_texel(parallel[0], size);
    ASSERT_LT(parallel_side, 0.6f);
    coverage = coverage_stochastic;
    for (const auto& [views, expected] : {std::pair{&still, share}, {&moved, share}, {&parallel, double(parallel_side * parallel_side)}})
        EXPECT_NEAR(covered(*views), expected, 4 * sigma + margin);
    coverage = coverage_exact;
    EXPECT_NEAR(covered(moved), share, 4 * sigma + margin);
    coverage = coverage_full;
    for (const std::vector<View>* views : {&still, &moved, &parallel}) EXPECT_EQ(covered(*views), 1);
}

// What is drawn is what lines of sight meet, in doubles, but for texels at edges; and the map is put to use.
TEST_F(SplatTest, parallel_maps_hold_the_depths_of_surfaces) {
    TestScene scene;
    scene.material(vec3(1));
    scene.quad({-3, 0, -2}, {0, 0, 4}, {6, 0, 0}, 0);
    scene.quad({-1, 0.5f, -1}, {2, 0.2f, 0}, {0.1f, 1.5f, 0.4f}, 0);
    scene.quad({0.5f, 1.2f, -1}, {1, 0, 0}, {0, 0.3f, 2}, 0);
    const Tree tree = grow(scene, 15);
    const uint size = 32;
    auto views = parallel_views(scene, 24, size);
    const auto atlas = splat(tree, cut(tree, views, 1, size), views, size, {});
    size_t right = 0, hits = 0, all = 0, hidden = 0;
    for (size_t v = 0; v < views.size(); ++v) {
        const View& view = views[v];
        if (std::abs(view.direction.y) < 0.1f) continue;  // the ground is seen edge-on
        const ParallelFrame f = parallel_frame(view.direction);
        const double texel = parallel_texel(view, size);
        const glm::dvec3 n(view.direction);
        for (uint y = 0; y < parallel_rows(view, size); ++y)
            for (uint x = 0; x < parallel_columns(view); ++x) {
                const glm::dvec3 from = glm::dvec3(view.position) + glm::dvec3(f.across) * ((x + 0.5) * texel) + glm::dvec3(f.down) * ((y + 0.5) * texel);
                const double exact = closest_ref(scene.triangles, from, n, 0, 1e30).t;
                const float drawn = uintBitsToFloat(atlas[v * map_texels(size) + y * parallel_columns(view) + x]);
                const bool hit = exact < 1e29;
                right += hit ? std::abs(drawn - exact) < 0.02 : !(drawn < 1e29f);
                hits += hit, ++all, hidden += hit && drawn < exact - 0.02;
            }
    }
    EXPECT_GT(right, 0.95 * double(all)) << right << " of " << all;
    EXPECT_LT(hidden, 0.02 * double(hits));
    EXPECT_GT(hits, 0.35 * double(all)) << "of the texels that there are";
}

// Views at and around the middles of leaves, on the nodes' planes, and where nodes lie along the axis and across the equator.
TEST_F(SplatTest, views_in_leaves_and_spheres_across_the_equator) {
    const Tree tree = random_tree(6);
    std::vector<View> views;
    for (uint leaf = 0; leaf < 64; leaf += 7) {
        const Sphere s = tree.host.sphere(leaf);
        for (const vec3& off : {vec3(0), 0.5f * point(s.radius), vec3(s.radius, 0, 0), vec3(1.01f * s.radius, 0, 0), vec3(0, 3 * s.radius, 0),
                                vec3(0, 0, -5 * s.radius), vec3(s.radius, 4 * s.radius, 0), vec3(-40 * s.radius, 0, 0)})
            views.push_back(view(s.center + off, point(), random() % 2 ? pi : pi / 2));
    }
    EXPECT_GT(check(tree, views, 1, 31), 0.2);
}

TEST_F(SplatTest, hard_scenes) {
    const auto run = [&](const char* name, const std::function<void(TestScene&)>& fill, float scale, bool seen = true) {
        SCOPED_TRACE(name);
        TestScene scene;
        scene.material(vec3(1));
        fill(scene);
        EXPECT_TRUE(check(grow(scene, 6), random_views(12, scale), 1, 16) > 0 || !seen);
    };
    const auto triangle = [](TestScene& s, const vec3& a, const vec3& b, const vec3& c) {
        const uint i = s.vertex(a, {0, 1, 0});
        s.vertex(b, {0, 1, 0}), s.vertex(c, {0, 1, 0});
        s.triangles.triangles.emplace_back(i, i + 1, i + 2, 0);
    };
    run("one triangle", [&](TestScene& s) { triangle(s, point(), point(), point()); }, 1);
    run("coincident", [&](TestScene& s) { triangle(s, vec3(0.3f), vec3(0.3f), vec3(0.3f)); }, 1, false);
    run("needle", [&](TestScene& s) { triangle(s, vec3(-1), vec3(1), vec3(1, 1, 1 + 1e-6f)); }, 1, false);
    for (float scale : {1e-6f, 1e6f})
        run("scaled", [&](TestScene& s) { for (int i = 0; i < 30; ++i) triangle(s, point(scale), point(scale), point(scale)); }, scale);
    run("one to a million", [&](TestScene& s) {
        s.quad({-1e3f, -1, -1e3f}, {2e3f, 0, 0}, {0, 0, 2e3f}, 0);
        for (int i = 0; i < 30; ++i) triangle(s, point(1e-3f), point(1e-3f), point(1e-3f));
    }, 1);
}

TEST_F(SplatTest, groups_made_by_hand) {
    const Tree tree = random_tree(8);
    const auto views = random_views(20, 1.5f);
    std::vector<uvec2> groups;
    for (int i = 0; i < 300; ++i) {
        const uint block = random() % tree.host.blocks;
        uint drawn = 0;
        for (uint k = 0; k < 8; ++k) drawn |= uint(!bsh_is_absent(tree.host.spheres[8 * block + k])) << k;
        groups.push_back(cut_pack(block, 5 + random() % 15, (random() & drawn) | (random() % 256) << 8));  // culled ones must not show
    }
    const auto expected = splat_ref(tree.host, groups, views, 5, 15, 31);
    for (uint32_t threads : {1u, 8u})
        EXPECT_TRUE(same(expected, splat(tree, groups, views, 31, {.first = 5, .maps = 15, .threads_per_group = threads})));
    std::ranges::shuffle(groups, random);
    EXPECT_TRUE(same(expected, splat(tree, groups, views, 31, {.first = 5, .maps = 15}))) << "order";
    groups.insert(groups.end(), groups.begin(), groups.begin() + 100);
    EXPECT_TRUE(same(expected, splat(tree, groups, views, 31, {.first = 5, .maps = 15}))) << "some of them twice";
}

TEST_F(SplatTest, first_view_moves_the_atlas) {
    const Tree tree = random_tree(9);
    const auto views = random_views(10, 1.5f);
    const auto all = splat(tree, cut(tree, views, 1, 16), views, 16, {});
    const auto rest = splat(tree, cut(tree, views, 1, 16, 6), views, 16, {.first = 6});
    EXPECT_TRUE(same({all.begin() + 6 * map_texels(16), all.end()}, rest));
}

TEST_F(SplatTest, counts_beyond_the_capacity_are_clamped) {
    const Tree tree = random_tree(9);
    const auto views = random_views(4, 1.5f);
    const auto groups = cut(tree, views, 1, 16);
    ASSERT_GT(groups.size(), 65u);
    for (uint64_t capacity : {1u, 64u, 65u}) {
        const std::vector<uvec2> fit(groups.begin(), groups.begin() + long(capacity));
        const auto expected = splat_ref(tree.host, fit, views, 0, 4, 16);
        for (uint32_t threads : {1u, 8u})
            EXPECT_TRUE(same(expected, splat(tree, groups, views, 16, {.capacity = capacity, .claimed = 1u << 30, .threads_per_group = threads})));
    }
}

// What is drawn of lists that lost groups would be thrown away: the batch is done again.
TEST_F(SplatTest, lists_that_overflowed_draw_nothing) {
    const Tree tree = random_tree(8);
    const auto views = random_views(2, 2);
    const auto groups = cut(tree, views, 1, 16);
    const std::vector<uint> nothing(2 * map_texels(16), atlas_nothing);
    EXPECT_FALSE(same(nothing, splat(tree, groups, views, 16, {})));
    for (const uint32_t failed : {append_next_overflow, append_kept_overflow})
        for (const uint32_t threads : {0, 8})
            EXPECT_TRUE(same(nothing, splat(tree, groups, views, 16, {.threads_per_group = threads, .failed = failed})));
}

TEST_F(SplatTest, nothing_to_draw_leaves_nothing) {
    const auto views = random_views(3, 1);
    const std::vector<uint> nothing(3 * map_texels(16), atlas_nothing);
    EXPECT_TRUE(same(nothing, splat(random_tree(6), {}, views, 16, {})));
    EXPECT_TRUE(same(nothing, splat(random_tree(6), {cut_pack(0, 1, 0xff00)}, views, 16, {}))) << "all culled";
    EXPECT_TRUE(same(nothing, splat(grow({}, 6), {}, views, 16, {}))) << "no scene";
}

TEST_F(SplatTest, the_comparator_sees_a_bit) {
    const Tree tree = random_tree(6);
    const auto views = random_views(2, 1);
    auto groups = cut(tree, views, 1, 16);
    const auto expected = splat_ref(tree.host, groups, views, 0, 2, 16);
    auto wrong = expected;
    wrong[100] ^= 1;
    EXPECT_FALSE(same(expected, wrong));
    groups.erase(groups.begin(), groups.begin() + long(groups.size() / 2));
    EXPECT_FALSE(same(expected, splat(tree, groups, views, 16, {}))) << "half of the cut is missing";
}

// ---- What the maps are for: the depth of the nearest surface ----

class SplatDepthTest : public SplatTest {
protected:
    static constexpr uint size = 32;
    static constexpr float half = 2;  // the room is [-2, 2]^3

    // Walls of n x n squares, each of two triangles.
    Tree room(uint n, uint32_t log2_samples, const glm::mat3& turn = glm::mat3(1)) {
        TestScene scene;
        scene.material(vec3(1));
        const float cell = 2 * half / float(n);
        for (int side = 0; side < 6; ++side)
            for (uint i = 0; i < n; ++i)
                for (uint j = 0; j < n; ++j) {
                    vec3 corner(0), a(0), b(0);
                    const int axis = side / 2;
                    corner[axis] = side % 2 ? half : -half;
                    corner[(axis + 1) % 3] = -half + float(i) * cell, corner[(axis + 2) % 3] = -half + float(j) * cell;
                    a[(axis + 1) % 3] = cell, b[(axis + 2) % 3] = cell;
                    scene.quad(turn * corner, turn * a, turn * b, 0);
                }
        return grow(scene, log2_samples);
    }
    static float wall(const vec3& from, const vec3& w) {
        float nearest = 1e30f;
        for (int i = 0; i < 3; ++i)
            if (w[i] != 0) nearest = std::min(nearest, ((w[i] > 0 ? half : -half) - from[i]) / w[i]);
        return nearest;
    }

    struct Share {
        size_t seen = 0, hole = 0, near = 0, far = 0, rim_hole = 0, stray = 0, black = 0;  // black: hidden by what is next to nothing away
    };
    Share measure(const Tree& tree, const std::vector<View>& views, float epsilon, float tolerance, const glm::mat3& turn = glm::mat3(1)) {
        const auto groups = cut(tree, views, epsilon, size);
        const auto atlas = splat(tree, groups, views, size, {});
        std::vector<float> reach(views.size());  // the sine of the largest angular radius that is drawn: how far over the frustum's edge it may go
        for (const uvec2& code : groups) {
            const CutGroup g = cut_unpack(code);
            for (uint k = 0; k < 8; ++k)
                if (g.drawn >> k & 1) {
                    const Sphere s = tree.host.sphere(8 * g.block + k);
                    reach[g.view] = std::max(reach[g.view], s.radius / glm::length(s.center - views[g.view].position));
                }
        }
        Share share;
        for (uint v = 0; v < views.size(); ++v)
            for (uint h : {half_front, half_back})
                for (uint y = 0; y < size; ++y)
                    for (uint x = 0; x < size; ++x) {
                        const vec2 uv = texel_middle(x, y, size), inner = max(abs(uv) - 1.0f / float(size), vec2(0));
                        if (dot(inner, inner) >= 1) continue;  // no direction falls in it
                        const vec3 w = unproject(h, uv);
                        const float angle = std::acos(std::clamp(dot(w, views[v].direction), -1.0f, 1.0f)), phi = std::atan2(views[v].sin_phi, views[v].cos_phi);
                        const float depth = uintBitsToFloat(atlas[v * map_texels(size) + texel_index(h, x, y, size)]), exact = wall(glm::transpose(turn) * views[v].position, glm::transpose(turn) * w);
                        const bool covered = depth < 1e30f;
                        share.stray += covered && reach[v] < 1 && angle > phi + 3 * std::asin(reach[v]);  // boxes stick out of spheres
                        if (angle > phi) continue;
                        ++share.seen;
                        share.hole += !covered;
                        share.rim_hole += !covered && dot(uv, uv) > 1;
                        share.black += covered && depth < 0.01f * exact;
                        share.near += covered && depth < exact - tolerance;
                        share.far += covered && depth > exact + tolerance;
                    }
        return share;
    }
};

TEST_F(SplatDepthTest, a_closed_room) {
    for (uint n : {1u, 8u}) {
        const Share s = measure(room(n, 14), random_views(40, 0.9f * half), 1, 0.01f * half);
        SCOPED_TRACE(testing::Message() << n << " squares a side: of " << s.seen << " texels " << s.hole << " are holes, " << s.rim_hole << " of them at the rim, "
                                        << s.near << " too near, " << s.far << " too far, " << s.stray << " outside the frustum");
        EXPECT_LE(100 * (s.hole + s.near + s.far), s.seen);
        EXPECT_LE(400 * s.hole, s.seen);  // nodes in corners of the room have no one plane
        EXPECT_LE(5000 * s.rim_hole, s.seen) << "directions just this side of the equator see the other half's nodes";
        EXPECT_EQ(s.far, 0u);
        EXPECT_EQ(s.stray, 0u);
    }
}

// As VPLs see it: from a hair above a wall, which must not hide the rest, whatever its node's rounded plane says.
TEST_F(SplatDepthTest, views_on_the_walls) {
    for (int turned = 0; turned < 4; ++turned) {
        const glm::mat3 turn = turned ? glm::mat3(glm::rotate(mat4(1), uniform(0, 6), glm::normalize(point()))) : glm::mat3(1);
        for (uint n : {1u, 8u}) {
            std::vector<View> views;
            for (int i = 0; i < 60; ++i) {
                vec3 at = point(0.9f * half), normal(0);
                const int axis = i % 3;
                at[axis] = i % 2 ? half : -half, normal[axis] = i % 2 ? -1.0f : 1.0f;
                views.push_back(view(ray_origin(turn * at, turn * normal, 2 * half), turn * normal, pi / 2));
            }
            const Share s = measure(room(n, 14, turn), views, 1, 0.01f * half, turn);
            SCOPED_TRACE(testing::Message() << n << " squares a side, turned " << turned << ": of " << s.seen << " texels " << s.hole << " are holes, " << s.near
                                            << " too near, " << s.far << " too far");
            EXPECT_EQ(s.black, 0u);
            EXPECT_LE(100 * s.near, 2 * s.seen);  // edges between walls
            EXPECT_LE(400 * s.hole, s.seen);
            EXPECT_LE(400 * s.far, s.seen);       // seen past what is edge-on
            EXPECT_EQ(s.stray, 0u);
        }
    }
}

// A known weakness, held here so that it cannot grow: where triangles are as small as what a sample stands for, patches (bsh_patch_small)
// do not meet, and walls have holes until there are several samples a triangle.
TEST_F(SplatDepthTest, walls_of_small_triangles_have_holes) {
    for (const auto& [log2_samples, most] : {std::pair{14u, 0.40}, {16u, 0.01}}) {  // 0.85 and 3.4 samples a triangle
        const Share s = measure(room(40, log2_samples), random_views(40, 0.9f * half), 1, 0.01f * half);
        EXPECT_LE(double(s.hole), most * double(s.seen)) << log2_samples;
        EXPECT_LE(100 * s.near, s.seen);
        EXPECT_EQ(s.far, 0u);
    }
}

}  // namespace
}  // namespace myriad::passes
