#include "passes/ism/ism.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "compute/views/view_testing.hpp"
#include "engine/testing.hpp"
#include "passes/brute/brute_ref.hpp"
#include "passes/geometry/test_scene.hpp"
#include "passes/ism/ism_ref.hpp"
#include "passes/kernels.hpp"

namespace myriad::passes {
namespace {

using engine::same;

class IsmTest : public engine::DeviceTest {
protected:
    float uniform(float lo = -1, float hi = 1) { return std::uniform_real_distribution<float>(lo, hi)(random); }
    vec3 point(float scale = 1) { return scale * vec3(uniform(), uniform(), uniform()); }
    std::vector<View> random_views(size_t n, float scale) { return compute::random_views(random, n, scale, {0.7f, pi / 2, pi / 2, 2.5f, pi}); }
    TestScene random_scene() {
        TestScene scene;
        scene.material(vec3(1));
        scene.soup(60, 1, random);
        scene.room(vec3(-2), vec3(2), 0);
        return scene;
    }

    struct Drawn {
        std::vector<IsmPoint> points;
        std::vector<uint> atlas;
        float radius = 0;
    };
    struct Options {
        uint32_t first = 0, limit = 0, exist = ~0u;  // limit 0: all from `first` on
        uint32_t seed = 1, log2_samples = 10;
    };
    static constexpr float extent = 4;
    Drawn draw(const TestScene& from, const std::vector<View>& views, uint map_size, const IsmSettings& settings, Options o) {
        if (!o.limit) o.limit = uint32_t(views.size()) - o.first;
        const UploadedScene scene(device, from);
        sampling = compute::sample_surface(scene.data.world, o.log2_samples, 1);
        const auto on = on_device(views);
        const auto count = on_device(std::vector<uint>{std::min(o.exist, uint(views.size()))});
        engine::Array<uint> atlas(device, "test", "atlas", o.limit * map_texels(map_size));
        IsmPass pass(device, {scene.data.world, sampling, extent}, settings, o.seed);
        engine::Recorder recorder(device);
        pass.place(recorder, scene.geometry);
        pass.record(recorder, on, count, o.first, o.limit, map_size, atlas);
        recorder.submit_and_wait();
        const double points = std::min<double>(settings.points, double(sampling.samples.size()));
        EXPECT_FLOAT_EQ(pass.radius(), points > 0 ? float(settings.cover * std::sqrt(sampling.area / (points * double(pi)))) : 0);
        EXPECT_TRUE(sampling.empty() || same_points(ism_points_ref(scene.data.world, sampling.samples), engine::download(device, pass.points())));
        return {sampling.empty() ? std::vector<IsmPoint>() : engine::download(device, pass.points()), engine::download(device, atlas), pass.radius()};
    }
    static ::testing::AssertionResult same_points(const std::vector<IsmPoint>& a, const std::vector<IsmPoint>& b) {
        const auto words = [](const std::vector<IsmPoint>& p) {
            std::vector<uint> w(4 * p.size());
            std::memcpy(w.data(), p.data(), 16 * p.size());
            return w;
        };
        return same(words(a), words(b));
    }
    // Against the twins. Returns the share of texels that hold something, before and after holes are filled.
    std::pair<double, double> check(const TestScene& scene, const std::vector<View>& views, uint map_size, const IsmSettings& settings) {
        return check(scene, views, map_size, settings, Options());
    }
    std::pair<double, double> check(const TestScene& scene, const std::vector<View>& views, uint map_size, const IsmSettings& settings, const Options& o) {
        const Drawn got = draw(scene, views, map_size, settings, o);
        const uint maps = o.limit ? o.limit : uint(views.size()) - o.first;
        const std::vector<View> exist(views.begin(), views.begin() + long(std::min<size_t>(views.size(), o.exist)));
        const auto splats = ism_splat_ref(got.points, exist, {std::min(settings.points, uint(got.points.size())), got.radius, o.seed, o.first, maps, map_size});
        const auto filled = ism_fill_ref(splats, map_size, 2 * maps, settings.threshold * extent, settings.levels);
        EXPECT_TRUE(same(filled, got.atlas));
        const auto share = [](const std::vector<uint>& atlas) { return 1 - double(std::ranges::count(atlas, atlas_nothing)) / double(atlas.size()); };
        return {share(splats), share(filled)};
    }

    compute::SurfaceSampling sampling;
};

TEST_F(IsmTest, equals_the_twins) {
    const TestScene scene = random_scene();
    for (uint size : {2u, 3u, 16u, 31u, 32u})
        for (uint levels : {0u, 1u, 3u, 9u}) {
            SCOPED_TRACE(testing::Message() << size << " texels, " << levels << " levels");
            const auto [before, after] = check(scene, random_views(7, 1.5f), size, {.points = 200, .cover = 1, .levels = levels});
            EXPECT_GT(before, 0.1);
            EXPECT_TRUE(levels ? after > before : after == before);
        }
}

TEST_F(IsmTest, points_from_one_to_more_than_there_are) {
    const TestScene scene = random_scene();
    for (uint points : {1u, 63u, 511u, 512u, 513u, 1024u, 5000u}) check(scene, random_views(5, 1), 16, {.points = points});
    EXPECT_EQ(check({}, random_views(3, 1), 8, {}).second, 0);
}

TEST_F(IsmTest, ranges_of_views_and_seeds) {
    const TestScene scene = random_scene();
    const auto views = random_views(40, 1);
    const auto all = draw(scene, views, 16, {.points = 100}, {});
    const auto part = draw(scene, views, 16, {.points = 100}, {.first = 30});
    EXPECT_TRUE(same({all.atlas.begin() + 30 * map_texels(16), all.atlas.end()}, part.atlas)) << "a view's subset does not depend on its batch";
    check(scene, views, 16, {.points = 100}, {.first = 3, .limit = 20, .exist = 12});
    EXPECT_TRUE(same(all.atlas, draw(scene, views, 16, {.points = 100}, {}).atlas));
    EXPECT_FALSE(same(all.atlas, draw(scene, views, 16, {.points = 100}, {.seed = 2}).atlas));
}

TEST_F(IsmTest, surfaces_that_are_there_in_part_and_instances) {
    TestScene scene = random_scene();
    scene.textured(random).alpha = scenes::Material::Alpha::blend;
    scene.textured(random).alpha = scenes::Material::Alpha::mask;
    scene.soup(60, 1, random);
    scene.decorate(random);
    check(scene, random_views(30, 1), 16, {.points = 300});
    const uint32_t n = uint32_t(scene.triangles.triangles.size());
    const mat4 mirrored(vec4(-0.5f, 0, 0, 0), vec4(0, 0.5f, 0, 0), vec4(0, 0.2f, 0.5f, 0), vec4(-0.2f, 0.4f, 0, 1));
    scene.triangles.placements = {{mat4(1), true, 0, 60, n - 60}, {mirrored, false, n - 60, 0, 60}, {0.7f * mat4(1), false, n, 0, 60}};
    check(scene, random_views(30, 1), 16, {.points = 300});
}

// Views on points and in their planes; scenes of all sizes; nothing but a point.
TEST_F(IsmTest, hard_cases) {
    const TestScene scene = random_scene();
    std::vector<View> views;
    const auto drawn = draw(scene, random_views(1, 1), 8, {}, {});
    for (size_t i = 0; i < 1024; i += 100) {
        const IsmPoint& p = drawn.points[i];
        const vec3 n = bsh_cone_axis(p.code);
        for (const float off : {0.0f, 1e-5f, 0.03f}) views.push_back({p.position + off * n, 0, n, 1});
    }
    check(scene, views, 16, {.points = 1024, .cover = 1});
    for (const float scale : {1e-6f, 1e6f}) {
        TestScene scaled = scene;
        for (vec3& p : scaled.triangles.positions) p *= scale;
        check(scaled, random_views(8, scale), 16, {.points = 200});
    }
    TestScene one;
    one.material(vec3(1));
    for (int i = 0; i < 3; ++i) one.vertex(vec3(0.3f), {0, 1, 0});
    one.triangles.triangles.emplace_back(0, 1, 2, 0);
    check(one, random_views(5, 1), 8, {.points = 10});
}

// Every sample is as likely as any other, no subset is another's, and each lies evenly.
TEST_F(IsmTest, subsets_are_uniform_and_differ) {
    const uint samples = 1 << 12, subset = 300, views = 4000;
    std::vector<uint> times(samples);
    for (uint v = 0; v < views; ++v) {
        uint last = 0;
        std::set<uint> chosen;
        for (uint i = 0; i < subset; ++i) {
            const uint at = ism_chosen(v, i, subset, samples, 5);
            ASSERT_LT(at, samples);
            ASSERT_GE(at, last);
            ASSERT_LE(std::abs(double(at) - (i + 0.5) * samples / subset), 0.5 * samples / subset + 1);
            last = at, ++times[at], chosen.insert(at);
        }
        ASSERT_GE(chosen.size(), subset - 20) << "hardly any twice";
    }
    const double expected = double(views) * subset / samples;
    double chi2 = 0;
    for (const uint t : times) chi2 += (t - expected) * (t - expected) / expected;
    EXPECT_LT(chi2, samples + 5 * std::sqrt(2.0 * samples));
}

// Against the truth. Discs lie in the planes of a closed room's walls, so a texel that one covers has its wall's depth. Of independent points
// discs of a cover of 1.75 would leave exp(-1.75^2) = 0.047 of the walls bare, and these lie more evenly; small ones cover their own area at most.
TEST_F(IsmTest, discs_give_the_depth_of_walls) {
    TestScene room;
    room.material(vec3(1));
    room.room(vec3(-2), vec3(2), 0);
    const uint size = 32;
    const auto views = random_views(20, 1.5f);
    const GeometryData data = geometry_data(room.scene, room.triangles);
    const auto truth = brute_ref(data.world, views, 0, uint(views.size()), size);
    const auto right = [&](float cover) {  // the share of texels in the frustum
        const auto got = draw(room, views, size, {.points = 8192, .cover = cover, .levels = 0}, {.log2_samples = 14}).atlas;
        size_t seen = 0, near = 0;
        for (size_t v = 0; v < views.size(); ++v)
            for (uint half : {half_front, half_back})
                for (uint y = 0; y < size; ++y)
                    for (uint x = 0; x < size; ++x) {
                        const vec2 uv = texel_middle(x, y, size);
                        if (glm::length(uv) > 1 || dot(unproject(half, uv), views[v].direction) < views[v].cos_phi) continue;
                        const size_t at = v * map_texels(size) + texel_index(half, x, y, size);
                        const float expected = uintBitsToFloat(truth[at]), found = uintBitsToFloat(got[at]);
                        ++seen, near += expected < 7 && std::abs(found - expected) <= 0.01f * expected;  // 7: the room is closed
                    }
        EXPECT_GT(seen, 5000u);
        return double(near) / double(seen);
    };
    EXPECT_GT(right(1.75f), 0.95);
    EXPECT_LT(right(0.3f), 0.15);
}

// A hole in a wall is filled with the wall's depth; of two walls the nearer one's; nothing stays nothing.
TEST_F(IsmTest, holes_get_the_nearest_surface) {
    const uint size = 8;
    std::vector<uint> map(2 * size * size, floatBitsToUint(2.0f));
    for (uint y = 0; y < size; ++y) map[y * size] = floatBitsToUint(1.0f);
    map[3 * size + 4] = map[size] = atlas_nothing;
    const auto filled = ism_fill_ref(map, size, 2, 0.1f, 2);
    EXPECT_EQ(uintBitsToFloat(filled[3 * size + 4]), 2);
    EXPECT_EQ(uintBitsToFloat(filled[size]), 1);
    const std::vector<uint> nothing(2 * size * size, atlas_nothing);
    EXPECT_TRUE(same(nothing, ism_fill_ref(nothing, size, 2, 0.1f, 3)));
    auto other = filled;
    other[5] ^= 1;
    EXPECT_FALSE(same(filled, other)) << "the comparator sees a bit";
}

}  // namespace
}  // namespace myriad::passes
