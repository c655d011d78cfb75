#include "passes/points/points.hpp"

#include <algorithm>

#include "engine/testing.hpp"
#include "passes/gbuffer/gbuffer.hpp"
#include "passes/geometry/geometry_ref.hpp"
#include "passes/geometry/test_scene.hpp"
#include "passes/points/points_ref.hpp"

namespace myriad::passes {
namespace {

using compute::AppendMode, compute::Bsh, compute::BshArrays;
using engine::same;
using glm::dvec2, glm::dvec3;

// A record in words, so that it compares to the bit.
using Words = std::array<uint, 5>;
std::vector<Words> words(const std::vector<RayHitRecord>& hits) {
    std::vector<Words> out;
    for (const RayHitRecord& h : hits) out.push_back({floatBitsToUint(h.t), h.triangle, floatBitsToUint(h.u), floatBitsToUint(h.v), h.front});
    return out;
}

vec3 cross_of(const Corners& c) { return glm::cross(c.p1 - c.p0, c.p2 - c.p0); }

class PointsTest : public engine::DeviceTest {
protected:
    float uniform(float lo = -1, float hi = 1) { return std::uniform_real_distribution<float>(lo, hi)(random); }

    // A scene and its tree on the device, and the tree read back.
    struct Tree {
        TestScene scene;
        std::unique_ptr<UploadedScene> uploaded;
        std::unique_ptr<Bsh> bsh;
        BshArrays host;
        std::vector<SurfaceSample> samples;

        PointsCells cells;

        PointsSceneRef ref() const { return {host, samples, uploaded->data.world, cells}; }
    };
    Tree grow(const TestScene& scene, uint32_t log2_samples, uint arity = 8) {
        Tree tree{scene, nullptr, nullptr, {}, {}, {}};
        tree.uploaded = std::make_unique<UploadedScene>(device, tree.scene);
        const UploadedScene& on = *tree.uploaded;
        tree.bsh = std::make_unique<Bsh>(device, on.data.world, log2_samples, 1, arity);
        if (tree.bsh->empty()) return tree;
        engine::Recorder recorder(device);
        tree.bsh->refit(recorder, on.geometry.positions(), on.geometry.triangles(), on.geometry.instances(), on.geometry.opacity());
        recorder.submit_and_wait();
        tree.host = compute::bsh_download(device, *tree.bsh);
        tree.samples = engine::download(device, tree.bsh->samples());
        tree.cells = points_cells(on.data.world, tree.samples, tree.bsh->sample_share());
        return tree;
    }
    TestScene soup(size_t count = 60) {
        TestScene test;
        test.material(vec3(1));
        test.soup(count, 2, random);
        test.quad({-4, -2, -4}, {8, 0, 0}, {0, 0.3f, 8}, 0);
        test.look({0.3f, 0.4f, 5}, vec3(0), 1.1f);
        return test;
    }
    // Walls of n x n squares, seen from inside, with a box in the middle.
    TestScene room(uint n, const vec3& eye = {0.7f, 0.2f, 0.9f}) {
        TestScene test;
        test.material(vec3(1));
        const auto wall = [&](const vec3& corner, const vec3& along, const vec3& up) {
            for (uint i = 0; i < n; ++i)
                for (uint k = 0; k < n; ++k) test.quad(corner + float(i) / float(n) * along + float(k) / float(n) * up, along / float(n), up / float(n), 0);
        };
        const auto box = [&](float s) {
            const vec3 lo(-s), hi(s), x(2 * s, 0, 0), y(0, 2 * s, 0), z(0, 0, 2 * s);
            wall(lo, y, z), wall(lo, z, x), wall(lo, x, y), wall(hi, -z, -y), wall(hi, -x, -z), wall(hi, -y, -x);
        };
        box(1), box(0.2f);
        test.look(eye, {-0.1f, 0.05f, 0}, 1.0f);
        return test;
    }

    struct Picture {
        std::vector<uint> pixels;
        std::vector<RayHitRecord> hits;
        std::vector<uvec2> groups;
        PointsCounters counters;
    };
    Picture draw(const Tree& tree, uint32_t width, uint32_t height, const PointsSettings& settings) {
        const UploadedScene& on = *tree.uploaded;
        PointsPass pass(device, settings, *tree.bsh, on.geometry, on.data.world, width, height, on.bvh.constants());
        const engine::Array<RayHitRecord> hits(device, "test", "hits", uint64_t(width) * height);
        engine::Recorder recorder(device);
        for (int tries = 0;; ++tries) {
            EXPECT_LT(tries, 30);
            pass.record(recorder, camera_push(tree.scene.scene.cameras[0], width, height), hits);
            recorder.submit_and_wait();
            if (pass.accept() || tries >= 30) break;
        }
        Picture picture{engine::download(device, pass.pixels(), 2 * uint64_t(width) * height), engine::download(device, hits), {}, pass.take_counters()};
        if (!tree.bsh->empty()) picture.groups = engine::download(device, pass.lists().kept(), picture.counters.groups);
        return picture;
    }

    // The kernels against the twin, to the bit, whatever draws them. Returns the share of pixels where something is.
    double check(const Tree& tree, uint32_t width, uint32_t height, float c) {
        const CameraPush camera = camera_push(tree.scene.scene.cameras[0], width, height);
        const Picture first = draw(tree, width, height, {.pixels = c});
        const auto expected = points_ref(tree.ref(), first.groups, camera, width, height);
        EXPECT_TRUE(same(expected, first.pixels));
        EXPECT_TRUE(same(words(points_hits_ref(tree.ref(), expected, camera, width, height)), words(first.hits)));
        for (const PointsSettings& other : {PointsSettings{.pixels = c, .append = AppendMode::atomic}, {.pixels = c, .lanes = 8}, {.pixels = c, .lanes = 64}})
            EXPECT_TRUE(same(first.pixels, draw(tree, width, height, other).pixels)) << other.lanes;
        uint64_t drawn = 0;
        for (const uvec2& code : first.groups) drawn += uint64_t(__builtin_popcount(cut_unpack(code).drawn));
        EXPECT_EQ(drawn, first.counters.drawn);
        EXPECT_GE(first.counters.cut, drawn);
        EXPECT_GE(first.counters.node_views, first.counters.cut);
        return 1 - double(std::ranges::count(expected, points_nothing)) / (double(width) * height);
    }

    // Against exact rays.
    struct Share {
        double hole = 0, stray = 0, deep = 0, triangle = 0;  // of all pixels: nothing where there is something; the reverse; another depth; of those alike, another triangle
    };
    Share against_rays(const Tree& tree, uint32_t width, uint32_t height, float c, double tolerance = 1e-3) {
        const UploadedScene& on = *tree.uploaded;
        GBufferPass rays(device, width, height, on.bvh.constants()), points(device, width, height, on.bvh.constants(), false, false);
        PointsPass pass(device, {.pixels = c}, *tree.bsh, on.geometry, on.data.world, width, height, on.bvh.constants());
        const scenes::Camera& camera = tree.scene.scene.cameras[0];
        engine::Recorder recorder(device);
        rays.record(recorder, on.geometry, on.bvh, camera);
        pass.record(recorder, camera_push(camera, width, height), points.hits());
        points.record_seen(recorder, on.geometry, camera);
        recorder.submit_and_wait();
        EXPECT_TRUE(pass.accept());
        const auto expected = engine::download(device, rays.gbuffer().positions), found = engine::download(device, points.gbuffer().positions);
        const auto ids = engine::download(device, rays.hits()), own_ids = engine::download(device, points.hits());
        Share share;
        const double one = 1 / double(expected.size());
        for (size_t i = 0; i < expected.size(); ++i) {
            const bool is = expected[i].w > 0, here = found[i].w > 0;
            share.hole += one * (is && !here), share.stray += one * (!is && here);
            if (!is || !here) continue;
            if (std::abs(double(found[i].w) - double(expected[i].w)) > tolerance * double(expected[i].w)) share.deep += one;
            else if (ids[i].triangle != own_ids[i].triangle) share.triangle += one;
        }
        return share;
    }
};

TEST_F(PointsTest, equals_the_twin_on_random_triangles) {
    for (const uint32_t log2_samples : {0u, 1u, 3u, 5u, 9u, 12u}) {
        const Tree tree = grow(soup(), log2_samples);
        for (const float c : {0.5f, 1.0f, 4.0f, 50.0f}) {
            SCOPED_TRACE(testing::Message() << "2^" << log2_samples << " samples, c = " << c);
            const double seen = check(tree, 67, 41, c);
            if (log2_samples >= 9) { EXPECT_GT(seen, 0.2); }
        }
    }
}

TEST_F(PointsTest, trees_of_every_arity) {
    const TestScene scene = soup();
    for (const float c : {1.0f, 8.0f}) {
        std::vector<std::vector<RayHitRecord>> hits;
        for (const uint arity : {2u, 4u, 8u}) {
            SCOPED_TRACE(arity);
            const Tree tree = grow(scene, 12, arity);
            EXPECT_GT(check(tree, 67, 41, c), 0.2);
            hits.push_back(draw(tree, 67, 41, {.pixels = c}).hits);
        }
        size_t other = 0;
        for (size_t i = 0; i < hits[0].size(); ++i) other += hits[0][i].triangle != hits[2][i].triangle;
        EXPECT_LE(other, hits[0].size() / 5);
    }
}

TEST_F(PointsTest, every_size_of_picture) {
    const Tree tree = grow(soup(), 10);
    for (const auto& [w, h] : {std::pair{1u, 1u}, {63u, 1u}, {64u, 1u}, {65u, 1u}, {1u, 65u}, {9u, 7u}, {130u, 100u}}) {
        SCOPED_TRACE(testing::Message() << w << " x " << h);
        check(tree, w, h, 2);
    }
}

TEST_F(PointsTest, equals_the_twin_with_holes_and_blended_surfaces) {
    using Alpha = scenes::Material::Alpha;
    TestScene test;
    for (const Alpha alpha : {Alpha::opaque, Alpha::mask, Alpha::blend}) {
        test.textured(random).alpha = alpha;
        scenes::Material& plain = test.scene.materials[test.material(vec3(0.5f))];
        plain.alpha = alpha, plain.base_color.a = 0.6f;
    }
    test.soup(100, 2, random);
    test.look({0.3f, 0.4f, 5}, vec3(0), 1.1f);
    const Tree tree = grow(test, 12);
    for (const float c : {1.0f, 8.0f}) EXPECT_GT(check(tree, 67, 41, c), 0.2);
}

// Lists that are too short are made longer, whatever they begin with, and nothing is lost.
TEST_F(PointsTest, over_capacity) {
    const Tree tree = grow(soup(), 12);
    const Picture ample = draw(tree, 67, 41, {.pixels = 1});
    EXPECT_EQ(ample.counters.redone, 0u);
    for (const AppendMode append : {AppendMode::scan, AppendMode::atomic})
        for (const uint64_t capacity : {uint64_t(1), uint64_t(7), uint64_t(64), ample.counters.list_peak - 1, ample.counters.list_peak}) {
            const Picture found = draw(tree, 67, 41, {.pixels = 1, .append = append, .capacity = capacity});
            EXPECT_EQ(found.counters.redone > 0, capacity < ample.counters.list_peak) << capacity;
            EXPECT_TRUE(same(ample.pixels, found.pixels)) << capacity;
            EXPECT_EQ(found.counters.cut, ample.counters.cut);
            EXPECT_EQ(found.counters.drawn, ample.counters.drawn);
        }
}

// No node of the cut that is no leaf is larger than c, and what is not drawn is outside the picture: larger pictures of the same view only add.
TEST_F(PointsTest, larger_c_opens_less) {
    const Tree tree = grow(room(1), 15);
    uint64_t last = ~0ull;
    for (const float c : {1.0f, 2.0f, 4.0f, 16.0f, 1e6f}) {
        const Picture picture = draw(tree, 64, 48, {.pixels = c});
        EXPECT_LE(picture.counters.node_views, last);
        last = picture.counters.node_views;
    }
    EXPECT_LT(last, 400u);
}

// What a ray would see is what is seen, however large leaves are in pixels.
TEST_F(PointsTest, large_triangles_are_exact) {
    for (const vec3& eye : {vec3(0.7f, 0.2f, 0.9f), vec3(-0.95f, -0.9f, 0.97f)}) {
        const Tree tree = grow(room(1, eye), 12);
        const Share share = against_rays(tree, 160, 120, 1);
        SCOPED_TRACE(testing::Message() << share.hole << " " << share.stray << " " << share.deep << " " << share.triangle);
        EXPECT_EQ(share.hole, 0);
        EXPECT_EQ(share.stray, 0);
        EXPECT_LE(share.deep, 0.0005);
        EXPECT_LE(share.triangle, 0.001);
    }
}

// Inner nodes: up to c pixels of silhouettes may be wrong, and little else.
TEST_F(PointsTest, error_goes_with_c) {
    const Tree tree = grow(room(1), 17);
    for (const auto& [c, most] : {std::pair{1.0f, 0.02}, {2.0f, 0.03}, {4.0f, 0.05}}) {
        const Share share = against_rays(tree, 80, 60, c, 0.02);
        EXPECT_LE(share.hole + share.deep, most) << c;
    }
}

// Where most triangles have no sample, too: leaves stand for them.
TEST_F(PointsTest, triangles_without_a_sample_are_seen) {
    for (const uint32_t log2_samples : {8u, 11u, 14u}) {
        const Tree tree = grow(room(24), log2_samples);
        const Share share = against_rays(tree, 160, 120, 1);
        SCOPED_TRACE(testing::Message() << log2_samples << ": " << share.hole << " " << share.stray << " " << share.deep << " " << share.triangle);
        EXPECT_EQ(share.hole, 0);
        EXPECT_EQ(share.stray, 0);
        EXPECT_LE(share.deep, 0.001);
        EXPECT_LE(share.triangle, 0.002);
    }
}

// Each point of a triangle that can be seen stands with one leaf, and no cell is larger than two shares.
TEST_F(PointsTest, cells_are_a_partition) {
    TestScene test = room(5);
    test.quad({-1, 0.3f, 0.2f}, {2, 0, 0}, {0, 1e-3f, 0}, 0);  // thin
    test.scene.materials[0].alpha = scenes::Material::Alpha::mask;
    const uint32_t hidden = test.material(vec3(1));
    test.scene.materials[hidden].alpha = scenes::Material::Alpha::mask, test.scene.materials[hidden].base_color.a = 0;
    test.quad(vec3(0.5f), {0.1f, 0, 0}, {0, 0.1f, 0}, hidden);
    const uint32_t v = test.vertex(vec3(0.5f), vec3(0));
    test.triangles.triangles.emplace_back(v, v, v, 0);
    const uint32_t count = uint32_t(test.triangles.triangles.size());
    for (const uint32_t log2_samples : {0u, 2u, 6u, 14u}) {
        const Tree tree = grow(test, log2_samples);
        ASSERT_EQ(tree.cells.first.size(), tree.samples.size() + 1);
        ASSERT_EQ(tree.cells.first.back(), tree.cells.cells.size());
        ASSERT_LE(tree.cells.cells.size(), count + tree.samples.size());
        std::vector<std::vector<std::array<dvec2, 3>>> of(count);
        std::vector<double> whole(count);
        const auto cross = [](const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; };
        for (const uvec4& code : tree.cells.cells) {
            const dvec2 a(points_corner(code.y)), b(points_corner(code.z)), c(points_corner(code.w));
            const double part = cross(b - a, c - a);  // of the triangle
            EXPECT_GT(part, 0);
            const Corners at = tree.uploaded->data.world.corners(code.x);
            EXPECT_LE(part * 0.5 * double(glm::length(cross_of(at))), 2.0001 * double(tree.bsh->sample_share()));
            whole[code.x] += part;
            of[code.x].push_back({a, b, c});
        }
        for (uint32_t id = 0; id < count; ++id) EXPECT_EQ(whole[id], id < count - 3) << id << "; the last three cannot be seen";
        for (uint32_t id = 0; id < count - 3; id += 7)  // as many, and they do not overlap: a random point is in one
            for (int k = 0; k < 20; ++k) {
                dvec2 p(uniform(0, 1), uniform(0, 1));
                if (p.x + p.y > 1) p = 1.0 - p;
                int inside = 0;
                for (const auto& [a, b, c] : of[id]) inside += cross(b - a, p - a) > 0 && cross(c - b, p - b) > 0 && cross(a - c, p - c) > 0;
                EXPECT_LE(inside, 1);
            }
        // Built anew, the leaves are in another order, and stand for the same.
        std::vector<uint> order(tree.samples.size());
        for (uint i = 0; i < order.size(); ++i) order[i] = i;
        std::shuffle(order.begin(), order.end(), random);
        std::vector<SurfaceSample> now;
        for (const uint i : order) now.push_back(tree.samples[i]);
        const PointsCells again = points_reorder(tree.cells, tree.samples, now);
        ASSERT_EQ(again.first.size(), tree.cells.first.size());
        for (uint i = 0; i < order.size(); ++i) {
            const auto list = [](const PointsCells& o, uint leaf) { return std::vector<uvec4>(o.cells.begin() + o.first[leaf], o.cells.begin() + o.first[leaf + 1]); };
            EXPECT_TRUE(list(again, i) == list(tree.cells, order[i]));
        }
    }
}

// A pane of alpha 1/4 is there for a quarter of the pixels: of leaves and of inner nodes.
TEST_F(PointsTest, blended_panes_are_there_for_their_share_of_pixels) {
    TestScene test;
    scenes::Material& m = test.scene.materials[test.material(vec3(1))];
    m.alpha = scenes::Material::Alpha::blend, m.base_color.a = 0.25f;
    test.quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}, 0);
    test.look({0, 0, 3}, vec3(0));
    for (const auto& [log2_samples, c] : {std::pair{12u, 1.0f}, {16u, 40.0f}}) {
        const Tree tree = grow(test, log2_samples);
        const Picture picture = draw(tree, 128, 128, {.pixels = c});
        EXPECT_NEAR(double(std::ranges::count_if(picture.hits, [](const RayHitRecord& h) { return h.triangle != ~0u; })) / 16384, 0.25, 0.04) << log2_samples;
    }
}

TEST_F(PointsTest, hard_scenes) {
    TestScene nothing;
    nothing.material({1, 1, 1});
    nothing.look({0, 0, 1}, vec3(0));
    for (const RayHitRecord& h : draw(grow(nothing, 8), 8, 8, {}).hits) EXPECT_EQ(h.triangle, ~0u);

    TestScene point;  // nothing but a triangle without area
    point.material({1, 1, 1});
    for (int k = 0; k < 3; ++k) point.vertex({0.1f, 0, 0}, vec3(0));
    point.triangles.triangles.emplace_back(0, 1, 2, 0);
    point.look({0, 0, 1}, vec3(0));
    check(grow(point, 6), 9, 9, 1);

    TestScene edge;  // needles, a plane edge-on through the eye, the eye on a surface
    edge.material({1, 1, 1});
    const uint32_t v = edge.vertex(vec3(0), vec3(0)), a = edge.vertex({1, 0, 0}, vec3(0)), b = edge.vertex({0, 1, 1e-20f}, vec3(0));
    edge.triangles.triangles.emplace_back(v, a, b, 0);
    edge.quad({-3, 0, -3}, {6, 0, 0}, {0, 0, 6}, 0);
    edge.quad({-3, -0.4f, -1}, {6, 0, 0}, {0, 1e-6f, 0}, 0);
    edge.scene.cameras = {{"", mat4(1), 1}};
    check(grow(edge, 10), 33, 33, 1);

    for (const auto& [scale, offset] : {std::pair{1e-6f, 0.0f}, {1e6f, 0.0f}, {1.0f, 1e4f}}) {
        TestScene test = soup();
        for (vec3& p : test.triangles.positions) p = scale * p + vec3(offset);
        test.look(scale * vec3(0.3f, 0.4f, 5) + vec3(offset), vec3(offset), 1.1f);
        SCOPED_TRACE(scale);
        EXPECT_GT(check(grow(test, 10), 40, 30, 2), 0.2);
    }
}

// The pixels that a disc may cover, against discs in doubles.
TEST_F(PointsTest, rectangles_hold_their_discs) {
    size_t tight = 0, tried = 0;
    for (int i = 0; i < 3000; ++i) {
        TestScene test;
        test.look({uniform(), uniform(), uniform()}, {uniform(), uniform(), uniform()}, uniform(0.05f, 2));
        const uint width = 1 + random() % 300, height = 1 + random() % 300;
        const CameraPush camera = camera_push(test.scene.cameras[0], width, height);
        const vec3 d = uniform(0.1f, 3) * normalize(vec3(uniform(), uniform(), uniform()));
        const float r = std::exp(uniform(-6, 0));
        const vec3 n = i % 3 ? normalize(vec3(uniform(), uniform(), uniform())) : vec3(0);
        const PointsRect rect = points_rect(camera, d, r, n, width, height);
        dvec2 low(1e30), high(-1e30);
        bool behind = false;
        for (int k = 0; k < 400; ++k) {
            dvec3 o(uniform(), uniform(), uniform());
            if (n != vec3(0)) o -= glm::dot(o, dvec3(n)) * dvec3(n);
            const dvec3 p = dvec3(d) + double(r) * glm::normalize(o);
            const double z = glm::dot(p, dvec3(camera.forward));
            if (z < 1e-3) { behind = true; continue; }
            const dvec2 s(glm::dot(p, dvec3(camera.right)) / glm::dot(dvec3(camera.right), dvec3(camera.right)) / z,
                          glm::dot(p, dvec3(camera.up)) / glm::dot(dvec3(camera.up), dvec3(camera.up)) / z);
            const dvec2 at((s.x + 1) * 0.5 * width - 0.5, (1 - s.y) * 0.5 * height - 0.5);  // in pixels' indices
            low = glm::min(low, at), high = glm::max(high, at);
            const double x = std::round(at.x), y = std::round(at.y);
            if (std::abs(at.x - x) > 0.01 || std::abs(at.y - y) > 0.01 || x < 0 || y < 0 || x >= width || y >= height) continue;
            ASSERT_TRUE(x >= rect.x0 && x < rect.x1 && y >= rect.y0 && y < rect.y1) << "the disc's rim is on a pixel's middle that is left out";
        }
        if (behind || low.x < 0 || low.y < 0 || high.x >= width || high.y >= height || rect.x0 >= rect.x1) continue;
        ++tried;
        tight += std::abs(rect.x0 - std::ceil(low.x)) <= 1 && std::abs(double(rect.x1) - std::floor(high.x) - 1) <= 1 + 0.1 * (high.x - low.x) &&
                 std::abs(rect.y0 - std::ceil(low.y)) <= 1 + 0.1 * (high.y - low.y);
        for (int axis = 0; axis < 2; ++axis) {
            const double first = std::ceil(low[axis]), last = std::floor(high[axis]);
            if (first > last) continue;
            ASSERT_LE(double(axis ? rect.y0 : rect.x0), first);
            ASSERT_GT(double(axis ? rect.y1 : rect.x1), last);
        }
    }
    EXPECT_GT(tried, 100u);
    EXPECT_GT(tight, tried * 8 / 10);
}

TEST_F(PointsTest, comparator_sees_a_wrong_pixel) {
    const Tree tree = grow(soup(), 9);
    const CameraPush camera = camera_push(tree.scene.scene.cameras[0], 16, 16);
    Picture picture = draw(tree, 16, 16, {});
    const auto expected = points_ref(tree.ref(), picture.groups, camera, 16, 16);
    ASSERT_TRUE(same(expected, picture.pixels));
    picture.pixels[5] += 1;
    EXPECT_FALSE(same(expected, picture.pixels));
    auto hits = points_hits_ref(tree.ref(), expected, camera, 16, 16);
    hits[7].u += 0.25f;
    EXPECT_FALSE(same(words(hits), words(picture.hits)));
}

}  // namespace
}  // namespace myriad::passes
