#include "passes/brute/brute.hpp"

#include <algorithm>
#include <functional>

#include "compute/raytrace/ray_query.hpp"
#include "compute/views/view_testing.hpp"
#include "engine/testing.hpp"
#include "passes/brute/brute_ref.hpp"
#include "passes/geometry/test_scene.hpp"

namespace myriad::passes {
namespace {

using compute::view, engine::same;

class BruteTest : public engine::DeviceTest {
protected:
    float uniform(float lo = -1, float hi = 1) { return std::uniform_real_distribution<float>(lo, hi)(random); }
    vec3 point(float scale = 1) { return scale * vec3(uniform(), uniform(), uniform()); }
    std::vector<View> random_views(size_t n, float scale) { return compute::random_views(random, n, scale, {0.7f, pi / 2, pi / 2, 2.5f, pi}); }
    static void triangle(TestScene& s, const vec3& a, const vec3& b, const vec3& c) {
        const uint i = s.vertex(a, {0, 1, 0}, {0, 0});
        s.vertex(b, {0, 1, 0}, {1, 0}), s.vertex(c, {0, 1, 0}, {0, 1});
        s.triangles.triangles.emplace_back(i, i + 1, i + 2, 0);
    }
    // Triangles from a thousandth of the view to around it.
    TestScene random_scene() {
        TestScene scene;
        scene.material(vec3(1));
        scene.soup(60, 1, random);
        scene.quad(vec3(-1), {2, 0, 0}, {0, 0.3f, 2}, 0);
        for (int i = 0; i < 200; ++i) {
            const vec3 at = point(1.5f);
            const float scale = std::exp(uniform(-6, -1));
            triangle(scene, at + point(scale), at + point(scale), at + point(scale));
        }
        return scene;
    }

    struct Options {
        uint32_t first = 0, limit = 0, exist = ~0u;  // limit 0: all from `first` on
        uint32_t own_texels = 16;
    };
    std::vector<uint> draw(const UploadedScene& scene, const std::vector<View>& views, uint map_size, Options o) {
        if (!o.limit) o.limit = uint32_t(views.size()) - o.first;
        const auto on = on_device(views);
        const auto count = on_device(std::vector<uint>{std::min(o.exist, uint(views.size()))});
        engine::Array<uint> atlas(device, "test", "atlas", o.limit * map_texels(map_size));
        BrutePass pass(device, scene.data.world, o.own_texels);
        engine::Recorder recorder(device);
        pass.record(recorder, scene.geometry, on, count, o.first, o.limit, map_size, atlas);
        recorder.submit_and_wait();
        return engine::download(device, atlas);
    }
    // Against the twin, however the work is shared. Returns the share of texels that hold something.
    double check(const TestScene& scene, const std::vector<View>& views, uint map_size) {
        const UploadedScene uploaded(device, scene);
        const auto expected = brute_ref(uploaded.data.world, views, 0, uint(views.size()), map_size);
        for (uint32_t own : {0u, 5u, 16u, 1u << 20}) EXPECT_TRUE(same(expected, draw(uploaded, views, map_size, {.own_texels = own}))) << own;
        return 1 - double(std::ranges::count(expected, atlas_nothing)) / double(expected.size());
    }
};

TEST_F(BruteTest, equals_the_twin_in_maps_of_every_size) {
    const TestScene scene = random_scene();
    for (uint size : {2u, 3u, 16u, 31u, 64u}) {
        SCOPED_TRACE(size);
        EXPECT_GT(check(scene, random_views(size > 16 ? 20 : 80, 1.5f), size), 0.2);
    }
}

// More views than a slice, few triangles; then no triangle, no view.
TEST_F(BruteTest, slices_of_views) {
    TestScene scene;
    scene.material(vec3(1));
    scene.soup(3, 1, random);
    for (size_t n : {63u, 64u, 65u, 200u}) EXPECT_GT(check(scene, random_views(n, 1), 8), 0.05);
    const auto views = random_views(3, 1);
    EXPECT_EQ(check(TestScene(), views, 8), 0);
    EXPECT_TRUE(same(std::vector<uint>(3 * map_texels(8), atlas_nothing), draw(UploadedScene(device, scene), views, 8, {.exist = 0})));
}

// Views in corners, on edges, in the plane, straight above the middle at all distances; the directions of the axis and the equator.
TEST_F(BruteTest, views_around_a_triangle) {
    for (int axis = 0; axis < 3; ++axis)
        for (int turn = 0; turn < 4; ++turn) {
            TestScene scene;
            scene.material(vec3(1));
            vec3 a = point(), b = point(), c = point();
            if (turn < 3) a = vec3(0), b = vec3(0), c = vec3(0), b[axis] = 1, c[(axis + 1) % 3] = turn ? -1.0f : 1.0f;
            if (turn == 2) b[axis] = 1e-3f;
            triangle(scene, a, b, c);
            const vec3 middle = (a + b + c) / 3.0f, n = glm::normalize(glm::cross(b - a, c - a));
            std::vector<View> views;
            for (const vec3& at : {a, b, c, 0.5f * (a + b), 0.25f * a + 0.75f * c, middle, 2.0f * b - a, 3.0f * middle - 2.0f * a})
                for (const float off : {0.0f, 1e-6f, -1e-6f, 1e-3f, 0.1f, -0.1f, 1.0f, -1.0f, 30.0f})
                    views.push_back(view(at + off * n, off > 0 ? -n : n, off == 0 || off == 30 ? pi : pi / 2));
            EXPECT_GT(check(scene, views, 16), 0.02);
        }
}

TEST_F(BruteTest, hard_scenes) {
    const auto run = [&](const char* name, const std::function<void(TestScene&)>& fill, float scale, bool seen = true) {
        SCOPED_TRACE(name);
        TestScene scene;
        scene.material(vec3(1));
        fill(scene);
        EXPECT_TRUE(check(scene, random_views(24, scale), 16) > 0 || !seen);
    };
    run("coincident", [](TestScene& s) { triangle(s, vec3(0.3f), vec3(0.3f), vec3(0.3f)); }, 1, false);
    run("in line", [](TestScene& s) { triangle(s, vec3(-1), vec3(0.25f), vec3(1)); }, 1, false);
    run("needle", [](TestScene& s) { triangle(s, vec3(-1), vec3(1), vec3(1, 1, 1 + 1e-6f)); }, 1, false);
    for (float scale : {1e-6f, 1e6f})
        run("scaled", [&](TestScene& s) { for (int i = 0; i < 30; ++i) triangle(s, point(scale), point(scale), point(scale)); }, scale);
    run("one to a million", [&](TestScene& s) {
        s.quad({-1e3f, -1, -1e3f}, {2e3f, 0, 0}, {0, 0, 2e3f}, 0);
        for (int i = 0; i < 30; ++i) triangle(s, point(1e-3f), point(1e-3f), point(1e-3f));
    }, 1);
}

// Cut-outs at the very point, blended surfaces whole or not at all in a view.
TEST_F(BruteTest, surfaces_that_are_there_in_part) {
    using Alpha = scenes::Material::Alpha;
    TestScene scene;
    scene.textured(random).alpha = Alpha::mask;
    scene.textured(random, scenes::Texture::Wrap::mirror, scenes::Texture::Wrap::clamp).alpha = Alpha::blend;
    scene.scene.materials[scene.material(vec3(1))].base_color.a = 0.4f;
    scene.scene.materials.back().alpha = Alpha::blend;
    scene.material(vec3(1));
    scene.soup(100, 1, random);
    scene.decorate(random);
    const auto views = random_views(60, 1);
    EXPECT_GT(check(scene, views, 16), 0.2);
    TestScene solid = scene;
    for (auto& m : solid.scene.materials) m.alpha = Alpha::opaque;
    EXPECT_FALSE(same(draw(UploadedScene(device, scene), views, 16, {}), draw(UploadedScene(device, solid), views, 16, {})));
}

TEST_F(BruteTest, instances_share_triangles) {
    TestScene scene = random_scene();
    const uint32_t all = uint32_t(scene.triangles.triangles.size()), half = all / 2;
    const mat4 turned(vec4(0.7f, 0.1f, 0, 0), vec4(0, 0.6f, 0.3f, 0), vec4(0.1f, 0, 0.8f, 0), vec4(0.3f, -0.2f, 0.1f, 1));
    const mat4 mirrored(vec4(-0.5f, 0, 0, 0), vec4(0, 0.5f, 0, 0), vec4(0, 0.2f, 0.5f, 0), vec4(-0.2f, 0.4f, 0, 1));
    scene.triangles.placements = {{mat4(1), true, 0, half, all - half}, {turned, false, all - half, 0, half}, {mirrored, false, all, 0, half}};
    const auto views = random_views(40, 1);
    EXPECT_GT(check(scene, views, 16), 0.2);

    const UploadedScene shared(device, scene);
    TestScene flat;
    flat.material(vec3(1));
    shared.data.world.for_each([&](uint32_t, uint32_t, const Corners& c) { triangle(flat, c.p0, c.p1, c.p2); });
    EXPECT_TRUE(same(draw(shared, views, 16, {}), draw(UploadedScene(device, flat), views, 16, {})));
}

TEST_F(BruteTest, ranges_of_views) {
    const TestScene scene = random_scene();
    const UploadedScene on(device, scene);
    const auto views = random_views(100, 1);
    const auto all = draw(on, views, 8, {});
    const auto part = [&](size_t first, size_t count) { return std::vector<uint>(&all[first * map_texels(8)], &all[first * map_texels(8)] + count * map_texels(8)); };
    EXPECT_TRUE(same(part(70, 30), draw(on, views, 8, {.first = 70})));
    EXPECT_TRUE(same(part(3, 66), draw(on, views, 8, {.first = 3, .limit = 66})));
    auto some = part(50, 50);
    std::fill(some.begin() + 27 * map_texels(8), some.end(), atlas_nothing);
    EXPECT_TRUE(same(some, draw(on, views, 8, {.first = 50, .exist = 77})));
}

TEST_F(BruteTest, the_comparator_sees_a_bit_and_a_triangle) {
    TestScene scene = random_scene();
    const UploadedScene on(device, scene);
    const auto views = random_views(4, 1);
    auto expected = brute_ref(on.data.world, views, 0, 4, 16);
    const auto got = draw(on, views, 16, {});
    EXPECT_TRUE(same(expected, got));
    expected[100] ^= 1;
    EXPECT_FALSE(same(expected, got));
    scene.triangles.triangles.erase(scene.triangles.triangles.begin() + 60);  // one of the quad's
    EXPECT_FALSE(same(brute_ref(UploadedScene(device, scene).data.world, views, 0, 4, 16), got));
}

// ---- What the maps are for: exact rays ----

class BruteRaysTest : public BruteTest {
protected:
    struct Differences {
        size_t seen = 0, far = 0, other = 0;   // far: another depth by more than rounding; other: one of them sees nothing
    };
    // Texels in the frustum that a look-up may ask, against rays through their middles.
    Differences compare(const UploadedScene& scene, const std::vector<View>& views, uint size, const std::vector<uint>& atlas) {
        std::vector<Ray> rays;
        std::vector<uint> depths;
        for (size_t v = 0; v < views.size(); ++v)
            for (uint half : {half_front, half_back})
                for (uint y = 0; y < size; ++y)
                    for (uint x = 0; x < size; ++x) {
                        const vec2 uv = texel_middle(x, y, size);
                        const vec3 w = unproject(half, uv);
                        if (glm::length(uv) > brute_rim(size) || dot(w, views[v].direction) < views[v].cos_phi) continue;
                        rays.push_back({views[v].position, 0, w, 1e30f});
                        depths.push_back(atlas[v * map_texels(size) + texel_index(half, x, y, size)]);
                    }
        const auto on = on_device(rays);
        const auto status = on_device(std::vector<uint>{0});
        engine::Array<RayHitRecord> hits(device, "test", "hits", rays.size());
        engine::Recorder recorder(device);
        compute::RayQuery(device, scene.bvh).closest(recorder, scene.bvh, on, hits, status);
        recorder.submit_and_wait();
        const auto exact = engine::download(device, hits);
        Differences d;
        for (size_t i = 0; i < rays.size(); ++i) {
            const bool hit = exact[i].triangle != ~0u, drawn = depths[i] != atlas_nothing;
            d.seen += hit;
            if (hit != drawn) ++d.other;
            else if (hit && !(std::abs(uintBitsToFloat(depths[i]) - exact[i].t) <= 1e-5f * exact[i].t)) ++d.far;
        }
        return d;
    }
};

TEST_F(BruteRaysTest, maps_hold_what_rays_find) {
    const auto run = [&](const char* name, const TestScene& scene, float scale) {
        const UploadedScene on(device, scene);
        const auto views = random_views(60, scale);
        const auto atlas = draw(on, views, 32, {});
        const Differences d = compare(on, views, 32, atlas);
        SCOPED_TRACE(testing::Message() << name << ": of " << d.seen << " texels " << d.other << " see something or nothing, " << d.far << " another depth");
        EXPECT_GT(d.seen, 10000u);
        EXPECT_LE(d.far + d.other, d.seen / 5000);  // rays along an edge
        auto shifted = atlas;                       // and the comparator sees a texel's shift
        std::rotate(shifted.begin(), shifted.begin() + 1, shifted.end());
        const Differences wrong = compare(on, views, 32, shifted);
        EXPECT_GT(wrong.far + wrong.other, d.seen / 10);
    };
    TestScene room = random_scene();
    room.room(vec3(-2), vec3(2), 0);
    run("a room", room, 1.9f);
    run("in the open", random_scene(), 1);
    TestScene holes;
    holes.textured(random).alpha = scenes::Material::Alpha::mask;
    holes.soup(100, 1, random);
    run("cut-outs", holes, 1);
}

// What the classic rasteriser of paraboloid maps makes of the same scene: corners are projected, edges are straight in the map, depth is
// interpolated along them (Brabec et al. 2002). Triangles that reach over the equator are left out of its account.
TEST_F(BruteRaysTest, straight_edges_would_be_wrong) {
    for (const auto& [cells, least] : {std::pair{2u, 0.1}, {16u, 0.0015}}) {
        TestScene scene;
        scene.material(vec3(1));
        for (uint i = 0; i < cells; ++i)
            for (uint j = 0; j < cells; ++j) {
                const float c = 4.0f / float(cells);
                scene.quad({1.5f, -2 + float(i) * c, -2 + float(j) * c}, {0, c, 0}, {0, 0, c}, 0);
            }
        const uint size = 32;
        const UploadedScene on(device, scene);
        const std::vector<View> views(1, view(vec3(0.1f, 0.2f, -0.1f), {1, 0, 0}, pi / 2));
        const auto exact = draw(on, views, size, {});
        const Differences d = compare(on, views, size, exact);
        EXPECT_EQ(d.far + d.other, 0u);
        std::vector<float> classic(map_texels(size), 1e30f);
        on.data.world.for_each([&](uint32_t, uint32_t, const Corners& p) {
            const vec3 from = views[0].position;
            const vec3 d[] = {p.p0 - from, p.p1 - from, p.p2 - from};
            const vec2 a = project(d[0]), b = project(d[1]), c = project(d[2]);
            const auto edge = [](const vec2& p, const vec2& q, const vec2& x) { return (q.x - p.x) * (x.y - p.y) - (q.y - p.y) * (x.x - p.x); };
            for (uint y = 0; y < size; ++y)
                for (uint x = 0; x < size; ++x) {
                    const vec2 m = texel_middle(x, y, size);
                    const float area = edge(a, b, c), u = edge(b, c, m) / area, v = edge(c, a, m) / area, w = edge(a, b, m) / area;
                    if (!(std::min({u, v, w}) >= 0)) continue;
                    float& texel = classic[texel_index(half_front, x, y, size)];
                    texel = std::min(texel, u * glm::length(d[0]) + v * glm::length(d[1]) + w * glm::length(d[2]));
                }
        });
        size_t wrong = 0;
        for (size_t i = 0; i < classic.size() / 2; ++i) {
            const float depth = uintBitsToFloat(exact[i]);
            wrong += (depth < 1e30f) != (classic[i] < 1e30f) || (depth < 1e30f && std::abs(depth - classic[i]) > 0.01f * depth);
        }
        RecordProperty("texels_wrong_" + std::to_string(cells), std::to_string(wrong) + " of " + std::to_string(d.seen));
        EXPECT_GT(double(wrong), least * double(d.seen)) << cells << " cells: " << wrong << " of " << d.seen;
    }
}

}  // namespace
}  // namespace myriad::passes
