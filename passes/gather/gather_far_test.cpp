// Lights that are infinitely far: sums and lobes, their parallel maps, and rays.
#include <limits>
#include <numbers>

#include "passes/environment/environment.hpp"
#include "passes/gather/gather_testing.hpp"
#include "passes/geometry/test_scene.hpp"

namespace myriad::passes {
namespace {

using engine::same;
using glm::dvec3;

class GatherFarTest : public GatherTest {
protected:
    std::vector<Vpl> random_lights(size_t n) {
        std::vector<Vpl> lights;
        for (size_t i = 0; i < n; ++i) lights.push_back(far_light(direction(), 2.0f * (point() + 1.0f), std::pow(10.0f, uniform(-4, 0))));
        return lights;
    }
    static std::vector<View> views_of(const std::vector<Vpl>& lights, uint size) {
        std::vector<View> views;
        for (const Vpl& light : lights) views.push_back(parallel_view(-far_direction(light), vec3(-1), vec3(1), size));
        return views;
    }
};

TEST_F(GatherFarTest, twin_and_kernel_know_one_light_over_a_plane) {
    HostGBuffer g(4, 1);
    const vec3 up(0, 1, 0), tilted = normalize(vec3(1, 1, 0));
    g.put(0, {0, 0, 0}, up);
    g.put(1, {7, -3, 0}, tilted);          // cosine 1 / sqrt 2, wherever it is
    g.put(2, {0, 0, 2}, -up);              // turned away
    g.put(3, {0, 0, 2}, tilted, -tilted);  // only its shading normal faces the light
    const std::vector<Vpl> lights{far_light(up, vec3(1, 2, 4), 0.01f)};
    const std::vector<dvec3> by_hand{dvec3(1, 2, 4), std::sqrt(0.5) * dvec3(1, 2, 4), dvec3(0), dvec3(0)};
    const std::vector<View> views;
    const auto twin = far_gather_ref(g, lights, 1);
    const auto got = run(g, lights, {.far = &views});
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_LE(length(twin[i].irradiance - by_hand[i]), 1e-4) << i;  // normals are packed
        EXPECT_LE(length(dvec3(got[i]) - by_hand[i]), 1e-4) << i;
    }
}

TEST_F(GatherFarTest, equals_the_twin_with_and_without_gloss) {
    const std::vector<View> views;
    for (uint block : {1u, 2u, 4u})
        for (bool glossy : {false, true}) {
            SCOPED_TRACE(testing::Message() << "block " << block << ", glossy " << glossy);
            HostGBuffer g = random_gbuffer(33, 17);
            if (glossy) polish(g);
            const auto lights = random_lights(100);
            const auto expected = far_gather_ref(g, lights, block);
            const auto got = run(g, lights, {.block = block, .far = &views});
            ASSERT_TRUE(near(expected, got));
            EXPECT_LT(doubt(expected), 1e-3);
            ASSERT_TRUE(same(got, run(g, lights, {.block = block, .parts = {block * block, 5 * block * block}, .far = &views})));
            double light = 0, slack = 0;
            for (const GatherRef& r : expected) light += r.mirrored.x, slack += r.mirrored_slack.x;
            if (glossy) { EXPECT_TRUE(light > 0 && slack < 5e-3 * light) << slack << " of " << light; }
        }
}

// A sky of radiance 1 in a mirror is a sky of radiance 1, though each lobe is narrower than the distance of lights.
TEST_F(GatherFarTest, mirrors_show_the_sky_and_not_its_lights) {
    std::vector<Vpl> sky;
    const int n = 4096;
    const double turn = std::numbers::pi * (3 - std::sqrt(5.0));
    for (int i = 0; i < n; ++i) {
        const double up = 1 - 2 * (i + 0.5) / n, out = std::sqrt(1 - up * up), solid_angle = 4 * std::numbers::pi / n;
        sky.push_back(far_light(vec3(out * std::cos(turn * i), up, out * std::sin(turn * i)), vec3(float(solid_angle)), float(solid_angle)));
    }
    HostGBuffer g(64, 4);
    for (size_t i = 0; i < g.pixels(); ++i) {
        g.put(i, point(), {0, 1, 0});
        g.shine(i, vec3(1), i < 128 ? brdf_least_roughness : 0.3f, normalize(vec3(uniform(), 1, uniform())));
    }
    const std::vector<View> views;
    const auto got = run(g, sky, {.far = &views});
    for (size_t i = 0; i < g.pixels(); ++i) ASSERT_NEAR(got[g.pixels() + i].x, 1, i < 128 ? 0.25 : 0.05) << i;
    double mean = 0;
    for (size_t i = 0; i < 128; ++i) mean += got[g.pixels() + i].x / 128;
    EXPECT_NEAR(mean, 1, 0.05);
}

TEST_F(GatherFarTest, maps_equal_the_twin) {
    for (uint size : {2u, 7u, 32u})
        for (uint block : {1u, 4u}) {
            SCOPED_TRACE(testing::Message() << "size " << size << ", block " << block);
            HostGBuffer g = random_gbuffer(21, 15);
            if (size == 32) polish(g);
            const auto lights = random_lights(90);
            const auto views = views_of(lights, size);
            const auto atlas = random_atlas(lights.size(), size, 4);
            const auto expected = far_gather_ref(g, lights, block, [&](size_t p, size_t i) {
                return parallel_seen_ref(dvec3(g.position(p)), dvec3(g.geometric(p)), views[i], &atlas[i * map_texels(size)], size, 0.5);
            });
            EXPECT_LT(doubt(expected), 0.01);
            const Options whole{.block = block, .atlas = &atlas, .map_size = size, .bias = 0.5f, .far = &views};
            const auto got = run(g, lights, whole);
            EXPECT_TRUE(near(expected, got));
            if (block > 1) continue;  // parts of maps come with all views
            EXPECT_FALSE(near(far_gather_ref(g, lights, block), got)) << "the maps hide something";
        }
}

// Up to 89 degrees from the normal, the plane that a receiver lies on does not hide it.
TEST_F(GatherFarTest, a_plane_does_not_shadow_itself) {
    for (int i = 0; i < 100000; ++i) {
        const uint size = std::array{2u, 8u, 32u, 256u}[random() % 4];
        const vec3 to_light = direction(), x = point();
        vec3 side = cross(to_light, direction());
        if (dot(side, side) < 1e-4f) continue;
        const float angle = 1.5533f * std::sqrt(uniform(0, 1));
        const vec3 n = std::cos(angle) * to_light + std::sin(angle) * normalize(side);
        const View view = parallel_view(-to_light, vec3(-1), vec3(1), size);
        const ParallelQuery q = parallel_query(x, n, view, size, 0.05f);
        const ParallelFrame frame = parallel_frame(view.direction);
        const double texel = parallel_texel(view, size);
        vec4 answers;
        for (int k = 0; k < 4; ++k) {
            const MapTexel t = parallel_map_texel(q, k % 2, k / 2);
            ASSERT_LT(t.index, map_texels(size));
            const dvec3 from = dvec3(view.position) + dvec3(frame.across) * ((t.index % q.columns + 0.5) * texel) + dvec3(frame.down) * ((t.index / q.columns + 0.5) * texel);
            const double depth = dot(dvec3(x) - from, dvec3(n)) / dot(dvec3(view.direction), dvec3(n));
            answers[k] = map_seen(depth > 0 ? float(depth) : std::numeric_limits<float>::infinity(), t);
        }
        ASSERT_EQ(parallel_blend(q, answers), 1.0f) << "size " << size << ", angle " << angle;
    }
}

// With maps of exact depths, what is left of error is their resolution: it falls as maps grow. And rays agree with what they tend to.
TEST_F(GatherFarTest, exact_maps_tend_to_rays_and_rays_to_brute_force) {
    TestScene scene;
    scene.material(vec3(1));
    scene.quad({-1, -1, -1}, {0, 0, 2}, {2, 0, 0}, 0);
    scene.quad({-0.5f, -0.2f, -0.5f}, {0, 0, 1}, {1, 0.3f, 0}, 0);
    scene.quad({0.5f, -0.5f, -1}, {0, 1, 0}, {0, 0, 1.5f}, 0);
    const auto& positions = scene.triangles.positions;
    HostGBuffer g(24, 24);
    for (size_t i = 0; i < g.pixels(); ++i) {
        const uvec4& t = scene.triangles.triangles[random() % scene.triangles.triangles.size()];
        const float u = uniform(0.05f, 0.45f), v = uniform(0.05f, 0.45f);
        const vec3 n = (random() % 2 ? 1.0f : -1.0f) * scene.triangles.normals[t.x];
        g.put(i, (1 - u - v) * positions[t.x] + u * positions[t.y] + v * positions[t.z] + 1e-5f * n, n);
    }
    const auto lights = random_lights(24);
    const auto exact = far_gather_ref(g, lights, 1, [&](size_t p, size_t i) {
        const vec3 from = ray_origin(g.position(p), g.geometric(p), 1);
        return closest_ref(scene.triangles, dvec3(from), dvec3(far_direction(lights[i])), 0, HitRef{}.t) ? seen_not : seen_whole;
    });
    {
        const UploadedScene uploaded(device, scene);
        const GBuffer gbuffer = g.on(device);
        const auto on = on_device(lights);
        const auto count = on_device(std::vector<uint>{uint(lights.size())}), status = on_device(std::vector<uint>{0});
        GatherPass gather(device, GatherVisibility::rays, g.width, g.height, uploaded.bvh.constants(), {.far = true});
        engine::Recorder recorder(device);
        gather.clear(recorder);
        gather.record_rays(recorder, {gbuffer, on, count, 1}, 0, uint32_t(lights.size()), uploaded.bvh, 1, status);
        recorder.submit_and_wait();
        EXPECT_TRUE(near(exact, engine::download(device, gather.irradiance())));
        EXPECT_FALSE(near(far_gather_ref(g, lights, 1), engine::download(device, gather.irradiance()))) << "something is hidden";
    }
    double light = 0, before = 1;
    for (const GatherRef& r : exact) light += r.irradiance.x;
    for (uint size : {8u, 32u, 128u}) {
        const auto views = views_of(lights, size);
        std::vector<uint> atlas(lights.size() * map_texels(size), floatBitsToUint(std::numeric_limits<float>::infinity()));
        for (size_t i = 0; i < lights.size(); ++i) {
            const View& view = views[i];
            const ParallelFrame frame = parallel_frame(view.direction);
            const double texel = parallel_texel(view, size);
            for (uint k = 0; k < parallel_columns(view) * parallel_rows(view, size); ++k) {
                const dvec3 from = dvec3(view.position) + dvec3(frame.across) * ((k % parallel_columns(view) + 0.5) * texel) + dvec3(frame.down) * ((k / parallel_columns(view) + 0.5) * texel);
                atlas[i * map_texels(size) + k] = floatBitsToUint(float(closest_ref(scene.triangles, from, dvec3(view.direction), 0, HitRef{}.t).t));
            }
        }
        const auto got = run(g, lights, {.atlas = &atlas, .map_size = size, .bias = 0.5f, .far = &views});
        double error = 0;
        for (size_t i = 0; i < got.size(); ++i) error += std::abs(got[i].x - exact[i].irradiance.x) / light;
        EXPECT_LT(error, 0.6 * before) << "size " << size;
        before = error;
    }
    EXPECT_LT(before, 0.02);
}

}  // namespace
}  // namespace myriad::passes
