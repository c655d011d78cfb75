// Exact visibility, against every triangle in doubles.
#include "passes/gather/gather_testing.hpp"
#include "passes/geometry/test_scene.hpp"

namespace myriad::passes {
namespace {

using glm::dvec3;

class GatherRaysTest : public GatherTest {
protected:
    static constexpr uint32_t width = 20, height = 14;

    // Receivers on a soup's triangles, VPLs in the air between them.
    void make(size_t triangles, bool holed = false) {
        scene.material(vec3(1));
        for (int i = 0; i < 3 && holed; ++i) scene.textured(random).alpha = scenes::Material::Alpha::mask;
        scene.soup(triangles, 2, random);
        if (holed) scene.decorate(random);
        for (size_t i = 0; i < g.pixels(); ++i) {
            const uvec4& t = scene.triangles.triangles[random() % triangles];
            const float u = uniform(0.1f, 0.45f), v = uniform(0.1f, 0.45f);
            const auto& p = scene.triangles.positions;
            const vec3 side = random() % 2 ? vec3(1) : vec3(-1);
            if (random() % 8) g.put(i, (1 - u - v) * p[t.x] + u * p[t.y] + v * p[t.z], side * normalize(cross(p[t.y] - p[t.x], p[t.z] - p[t.x])));
        }
        for (const vec3& p : scene.triangles.positions) reach = std::max({reach, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    }
    std::vector<GatherRef> twin(const std::vector<Vpl>& vpls, uint block) const {
        return gather_ref(g, vpls, block, 2, [&](size_t pixel, size_t i) {
            return ray_seen_ref(dvec3(ray_origin(g.position(pixel), g.geometric(pixel), reach)), dvec3(vpls[i].position), scene.triangles,
                                there_ref(scene.scene, scene.triangles));
        });
    }
    std::vector<vec4> trace(const std::vector<Vpl>& vpls, uint block, uint32_t part) {
        const UploadedScene uploaded(device, scene);
        const compute::Bvh& bvh = uploaded.bvh;
        const GBuffer gbuffer = g.on(device);
        const auto on = on_device(vpls);
        const auto count = on_device(std::vector<uint>{uint(vpls.size())}), status = on_device(std::vector<uint>{0});
        GatherPass gather(device, GatherVisibility::rays, width, height, bvh.constants(), {.glossy = gbuffer.glossy()});
        const GatherInputs in{gbuffer, on, count, block, 2};
        engine::Recorder recorder(device);
        gather.clear(recorder);
        for (uint32_t first = 0; first < vpls.size(); first += part) gather.record_rays(recorder, in, first, part, bvh, reach, status);
        recorder.submit_and_wait();
        EXPECT_EQ(engine::download(device, status)[0], 0u);
        return engine::download(device, gather.irradiance());
    }

    TestScene scene;
    HostGBuffer g{width, height};
    float reach = 0;
};

TEST_F(GatherRaysTest, equals_brute_force) {
    make(40);
    const auto vpls = random_vpls(120);
    for (uint block : {1u, 2u, 4u}) {
        const auto expected = twin(vpls, block);
        EXPECT_LT(doubt(expected), 0.02);
        EXPECT_TRUE(near(expected, trace(vpls, block, 1 << 20))) << block;
    }
    // The scene does hide something, and not everything.
    double seen = 0, all = 0;
    const auto free = gather_ref(g, vpls, 1, 2), hidden = twin(vpls, 1);
    for (size_t i = 0; i < free.size(); ++i) seen += hidden[i].irradiance.x, all += free[i].irradiance.x;
    EXPECT_TRUE(seen > 0.1 * all && seen < 0.9 * all) << seen / all;
}

TEST_F(GatherRaysTest, glossy_receivers_equal_brute_force) {
    make(40);
    polish(g);
    const auto vpls = random_vpls(120);
    for (uint block : {1u, 2u}) EXPECT_TRUE(near(twin(vpls, block), trace(vpls, block, 64)));
}

TEST_F(GatherRaysTest, light_falls_through_holes) {
    make(40, true);
    const auto vpls = random_vpls(120);
    const auto expected = twin(vpls, 2);
    EXPECT_LT(doubt(expected), 0.02);
    EXPECT_TRUE(near(expected, trace(vpls, 2, 1 << 20)));
    double holed = 0, solid = 0;
    for (const GatherRef& r : twin(vpls, 1)) holed += r.irradiance.x;
    for (scenes::Material& m : scene.scene.materials) m.alpha = scenes::Material::Alpha::opaque;
    for (const GatherRef& r : twin(vpls, 1)) solid += r.irradiance.x;
    EXPECT_GT(holed, 1.05 * solid);
}

// More VPLs a set than one dispatch takes (64), so the pass splits by itself; and split by the caller.
TEST_F(GatherRaysTest, splitting_changes_no_bit) {
    make(10);
    const auto vpls = random_vpls(300);
    const auto whole = trace(vpls, 2, 1 << 20);
    EXPECT_TRUE(near(twin(vpls, 2), whole));
    EXPECT_TRUE(engine::same(whole, trace(vpls, 2, 4)));
    EXPECT_TRUE(engine::same(whole, trace(vpls, 2, 264)));
}

TEST_F(GatherRaysTest, walls_hide_all_and_air_hides_nothing) {
    scene.material(vec3(1));
    scene.quad({-9, 1, -9}, {18, 0, 0}, {0, 0, 18}, 0);
    reach = 9;
    for (size_t i = 0; i < g.pixels(); ++i) g.put(i, {uniform(), i % 2 ? 0.5f : 1.5f, uniform()}, {0, 1, 0});
    const std::vector<Vpl> vpls(3, vpl({0, 2, 0}, {0, -1, 0}, vec3(1)));
    const auto free = gather_ref(g, vpls, 1, 2);
    const auto got = trace(vpls, 1, 3);
    for (size_t i = 0; i < got.size(); ++i)
        EXPECT_NEAR(got[i].x, i % 2 ? 0 : free[i].irradiance.x, i % 2 ? 0 : 1e-5);
}

TEST_F(GatherRaysTest, vpl_at_its_receiver_is_finite) {
    make(5);
    std::vector<Vpl> vpls;
    for (size_t i = 0; i < 60; ++i) {
        const vec3 x = g.position(i), n = g.geometric(i);
        for (const vec3& at : {x, ray_origin(x, n, reach), x + 1e-7f * n}) vpls.push_back(vpl(at, i % 2 ? n : -n, vec3(1e30f)));
    }
    for (const vec4& e : trace(vpls, 1, 1 << 20)) ASSERT_TRUE(e.x >= 0 && e.x <= gather_most);
}

TEST_F(GatherRaysTest, comparator_sees_a_missing_shadow) {
    make(40);
    const auto vpls = random_vpls(30);
    EXPECT_FALSE(near(gather_ref(g, vpls, 1, 2), trace(vpls, 1, 30)));
}

}  // namespace
}  // namespace myriad::passes
