// Lights that shine alike in all directions: sums and lobes, maps that see all around, and rays.
#include <limits>
#include <numbers>

#include "passes/gather/gather_testing.hpp"
#include "passes/geometry/test_scene.hpp"

namespace myriad::passes {
namespace {

using engine::same;
using glm::dvec3;

class GatherOmniTest : public GatherTest {
protected:
    std::vector<Vpl> random_lights(size_t n, float most_radius = 0.3f) {
        std::vector<Vpl> lights;
        for (size_t i = 0; i < n; ++i) lights.push_back(omni_light(point(1.5f), 2.0f * (point() + 1.0f), uniform(0.01f, most_radius)));
        return lights;
    }
    // By rays, over a scene that reaches as far as `reach`.
    std::vector<vec4> trace(const HostGBuffer& g, const TestScene& scene, const std::vector<Vpl>& lights, uint block, uint32_t part, float reach) {
        const UploadedScene uploaded(device, scene);
        const GBuffer gbuffer = g.on(device);
        const auto on = on_device(lights);
        const auto count = on_device(std::vector<uint>{uint(lights.size())}), status = on_device(std::vector<uint>{0});
        GatherPass gather(device, GatherVisibility::rays, g.width, g.height, uploaded.bvh.constants(), {.glossy = gbuffer.glossy(), .omni = true});
        engine::Recorder recorder(device);
        gather.clear(recorder);
        for (uint32_t first = 0; first < lights.size(); first += part) gather.record_rays(recorder, {gbuffer, on, count, block}, first, part, uploaded.bvh, reach, status);
        recorder.submit_and_wait();
        EXPECT_EQ(engine::download(device, status)[0], 0u);
        return engine::download(device, gather.irradiance());
    }
    // A floor, a slope over it and a wall, and receivers on them, on either side.
    static TestScene yard() {
        TestScene scene;
        scene.material(vec3(1));
        scene.quad({-1, -1, -1}, {0, 0, 2}, {2, 0, 0}, 0);
        scene.quad({-0.5f, -0.2f, -0.5f}, {0, 0, 1}, {1, 0.3f, 0}, 0);
        scene.quad({0.5f, -0.5f, -1}, {0, 1, 0}, {0, 0, 1.5f}, 0);
        return scene;
    }
    HostGBuffer on_surfaces(const TestScene& scene) {
        const auto& positions = scene.triangles.positions;
        HostGBuffer g(24, 24);
        for (size_t i = 0; i < g.pixels(); ++i) {
            const uvec4& t = scene.triangles.triangles[random() % scene.triangles.triangles.size()];
            const float u = uniform(0.05f, 0.45f), v = uniform(0.05f, 0.45f);
            g.put(i, (1 - u - v) * positions[t.x] + u * positions[t.y] + v * positions[t.z], (random() % 2 ? 1.0f : -1.0f) * scene.triangles.normals[t.x]);
        }
        return g;
    }
};

TEST_F(GatherOmniTest, twin_and_kernel_know_one_light_by_hand) {
    HostGBuffer g(8, 1);
    const vec3 up(0, 1, 0), tilted = normalize(vec3(1, 1, 0));
    g.put(0, {0, 0, 0}, up);               // 2 m below it: intensity / 4
    g.put(1, {2, 0, 0}, up);               // d^2 = 8, cosine 1 / sqrt 2
    g.put(2, {0, 4, 0}, -up);              // above it: it shines there as well
    g.put(3, {0, 0, 0}, -up);              // turned away
    g.put(4, {0, 0, 0}, tilted, -tilted);  // only its shading normal faces the light
    g.put(5, {0, 1.9f, 0}, up);            // within its radius: as on the ball
    g.put(6, {0, 2, 0}, up);               // in the light itself
    const std::vector<Vpl> lights{omni_light({0, 2, 0}, vec3(1, 2, 4), 0.5f)};
    const double by_hand[] = {0.25, std::sqrt(0.5) / 8, 0.25, 0, 0, 4, 0, 0};
    const auto twin = omni_gather_ref(g, lights, 1);
    const auto got = run(g, lights, {.omni = true});
    for (size_t i = 0; i < 8; ++i) {
        const dvec3 expected = by_hand[i] * dvec3(1, 2, 4);
        EXPECT_LE(length(twin[i].irradiance - expected), 1e-4 * (1 + length(expected))) << i;  // normals are packed
        EXPECT_LE(length(dvec3(got[i]) - expected), 1e-4 * (1 + length(expected))) << i;
    }
}

TEST_F(GatherOmniTest, equals_the_twin_with_and_without_gloss) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {33u, 17u}, {64u, 3u}})
        for (uint block : {1u, 2u, 4u})
            for (bool glossy : {false, true}) {
                SCOPED_TRACE(testing::Message() << width << "x" << height << ", block " << block << ", glossy " << glossy);
                HostGBuffer g = random_gbuffer(width, height);
                if (glossy) polish(g);
                for (size_t n : {size_t(0), size_t(1), size_t(block * block), size_t(100)}) {
                    const auto lights = random_lights(n);
                    const auto expected = omni_gather_ref(g, lights, block);
                    const auto got = run(g, lights, {.block = block, .omni = true});
                    ASSERT_TRUE(near(expected, got)) << n;
                    if (n < 100 || width < 33) continue;
                    EXPECT_LT(doubt(expected), 1e-3);
                    ASSERT_TRUE(same(got, run(g, lights, {.block = block, .parts = {block * block, 5 * block * block}, .omni = true})));
                    double light = 0, slack = 0;
                    for (const GatherRef& r : expected) light += r.mirrored.x, slack += r.mirrored_slack.x;
                    if (glossy) { EXPECT_TRUE(light > 0 && slack < 1e-2 * light) << slack << " of " << light; }
                }
            }
}

// The light that a closed wall around it gets is all that it sends: 4 pi times its intensity.
TEST_F(GatherOmniTest, a_cube_around_a_light_gets_all_of_its_light) {
    constexpr uint32_t side = 96;
    HostGBuffer g(side, 6 * side);
    for (uint32_t y = 0; y < g.height; ++y)
        for (uint32_t x = 0; x < side; ++x) {
            const uint32_t face = y / side;
            vec3 at(0), n(0);
            n[face / 2] = face % 2 ? 1.0f : -1.0f;
            at = -n;
            at[(face / 2 + 1) % 3] = (float(x) + 0.5f) * 2 / side - 1, at[(face / 2 + 2) % 3] = (float(y % side) + 0.5f) * 2 / side - 1;
            g.put(y * side + x, at, n);
        }
    const auto got = run(g, {omni_light({0.2f, -0.3f, 0.1f}, vec3(1, 2, 3), 0.05f)}, {.omni = true});
    dvec3 power(0);
    for (const vec4& e : got) power += dvec3(e) * (4.0 / (side * side));
    EXPECT_LT(length(power - 4 * std::numbers::pi * dvec3(1, 2, 3)), 0.01);
}

TEST_F(GatherOmniTest, maps_equal_the_twin) {
    for (uint size : {2u, 7u, 32u})
        for (uint block : {1u, 4u}) {
            SCOPED_TRACE(testing::Message() << "size " << size << ", block " << block);
            HostGBuffer g = random_gbuffer(21, 15);
            if (size == 32) polish(g);
            const auto lights = random_lights(90);
            const auto atlas = random_atlas(lights.size(), size, 4);
            const auto expected = omni_gather_ref(g, lights, block, [&](size_t p, size_t i) {
                return map_seen_ref(dvec3(g.position(p)), dvec3(g.geometric(p)), dvec3(lights[i].position), &atlas[i * map_texels(size)], size, 0.5);
            });
            EXPECT_LT(doubt(expected), 0.02);
            const Options whole{.block = block, .atlas = &atlas, .map_size = size, .bias = 0.5f, .omni = true};
            const auto got = run(g, lights, whole);
            EXPECT_TRUE(near(expected, got));
            Options parts = whole;
            parts.parts = {16, 48};
            EXPECT_TRUE(same(got, run(g, lights, parts)));
            EXPECT_FALSE(near(omni_gather_ref(g, lights, block), got)) << "the maps hide something";
        }
}

// With maps of exact depths, on both sides of what they see, what is left of error is their resolution. And rays agree with what they tend to.
TEST_F(GatherOmniTest, exact_maps_tend_to_rays_and_rays_to_brute_force) {
    const TestScene scene = yard();
    const HostGBuffer g = on_surfaces(scene);
    const auto lights = random_lights(40, 0.05f);
    const auto exact = omni_gather_ref(g, lights, 1, [&](size_t p, size_t i) {
        return ray_seen_ref(dvec3(ray_origin(g.position(p), g.geometric(p), 1)), dvec3(lights[i].position), scene.triangles);
    });
    const auto traced = trace(g, scene, lights, 1, 64, 1);
    EXPECT_TRUE(near(exact, traced));
    EXPECT_TRUE(same(traced, trace(g, scene, lights, 1, 7, 1)));
    EXPECT_FALSE(near(omni_gather_ref(g, lights, 1), traced)) << "something is hidden";
    double light = 0, before = 1;
    for (const GatherRef& r : exact) light += r.irradiance.x;
    for (uint size : {8u, 32u, 128u}) {
        const auto atlas = exact_atlas(lights, scene.triangles, size);
        const auto got = run(g, lights, {.atlas = &atlas, .map_size = size, .bias = 0.5f, .omni = true});
        double error = 0;
        for (size_t i = 0; i < got.size(); ++i) error += std::abs(double(got[i].x) - exact[i].irradiance.x) / light;
        EXPECT_LT(error, 0.6 * before) << "size " << size;
        before = error;
    }
    EXPECT_LT(before, 0.02);
}

// On a surface, at receivers, in one place, without radius, and very bright: finite, and by maps as well.
TEST_F(GatherOmniTest, hard_places_stay_finite) {
    const TestScene scene = yard();
    HostGBuffer g = on_surfaces(scene);
    polish(g);
    std::vector<Vpl> lights;
    for (size_t i = 0; i < 40; ++i) {
        const vec3 x = g.position(i), n = g.geometric(i);
        for (const vec3& at : {x, ray_origin(x, n, 1), x + 1e-7f * n, x - 1e-7f * n})
            for (float radius : {0.0f, 1e-20f, 1.0f, 1e20f}) lights.push_back(omni_light(at, vec3(i % 2 ? 1e30f : 1.0f, 0, 1e-30f), radius));
    }
    for (int i = 0; i < 64; ++i) lights.push_back(omni_light(vec3(0, 0.5f, 0), vec3(1), 0.01f));
    std::vector<uint> atlas(lights.size() * map_texels(4));
    for (uint& texel : atlas) texel = floatBitsToUint(random() % 2 ? std::numeric_limits<float>::infinity() : uniform(0, 1));
    for (const auto& image : {trace(g, scene, lights, 1, 1 << 20, 1), run(g, lights, {.omni = true}), run(g, lights, {.atlas = &atlas, .map_size = 4, .bias = 0.5f, .omni = true})})
        for (const vec4& e : image)
            for (int c = 0; c < 3; ++c) ASSERT_TRUE(e[c] >= 0 && e[c] <= gather_most) << e[c];
}

// A lamp that touches a surface is not hidden by it, as in passes/direct.
TEST_F(GatherOmniTest, a_light_on_the_floor_lights_what_is_above_it) {
    TestScene scene;
    scene.material(vec3(1));
    scene.quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 0);
    HostGBuffer g(16, 16);
    for (size_t i = 0; i < g.pixels(); ++i) g.put(i, {uniform(), 1, uniform()}, {0, -1, 0});
    const std::vector<Vpl> lights{omni_light({0.3f, 0, 0.1f}, vec3(1), 0.02f)};
    EXPECT_TRUE(near(omni_gather_ref(g, lights, 1), trace(g, scene, lights, 1, 1, 1)));
}

TEST_F(GatherOmniTest, comparator_sees_a_light_with_a_back) {
    const HostGBuffer g = random_gbuffer(33, 17);
    const auto lights = random_lights(30);
    EXPECT_FALSE(near(omni_gather_ref(g, lights, 1), run(g, lights, {})));
}

}  // namespace
}  // namespace myriad::passes
