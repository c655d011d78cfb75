#include "passes/compose/compose.hpp"

#include "engine/testing.hpp"
#include "passes/compose/compose_ref.hpp"

namespace myriad::passes {
namespace {

using glm::dvec3;

class ComposeTest : public engine::DeviceTest {
protected:
    struct Result {
        std::vector<vec4> indirect, beauty, direct;
    };
    Result run(const HostGBuffer& host, const std::vector<vec4>* irradiance, const std::vector<vec4>* natural, const std::vector<vec4>* direct,
               const std::vector<vec4>* lamps = nullptr, const std::vector<vec4>* beyond = nullptr) {
        const GBuffer gbuffer = host.on(device);
        engine::Array<vec4> e, n, d, l, b;
        if (irradiance) e = on_device(*irradiance);
        if (natural) n = on_device(*natural);
        if (direct) d = on_device(*direct);
        if (lamps) l = on_device(*lamps);
        if (beyond) b = on_device(*beyond);
        ComposePass compose(device, host.width, host.height, lamps != nullptr);
        engine::Recorder recorder(device);
        compose.record(recorder, gbuffer, irradiance ? &e : nullptr, natural ? &n : nullptr, direct ? &d : nullptr, lamps ? &l : nullptr, beyond ? &b : nullptr);
        recorder.submit_and_wait();
        Result result{engine::download(device, compose.indirect()), engine::download(device, compose.beauty())};
        EXPECT_EQ(compose.all_direct() != nullptr, lamps != nullptr);
        if (lamps) result.direct = engine::download(device, *compose.all_direct());
        return result;
    }
    std::vector<vec4> random_image(size_t n, float scale) {
        std::uniform_real_distribution<float> unit(0, scale);
        std::vector<vec4> image(n);
        for (vec4& v : image) v = {unit(random), unit(random), unit(random), unit(random)};
        return image;
    }
    HostGBuffer random_gbuffer(uint32_t width, uint32_t height) {
        HostGBuffer g(width, height);
        g.albedo = random_image(g.pixels(), 1), g.emitted = random_image(g.pixels(), 5);
        return g;
    }
    static size_t differing(const std::vector<ComposedRef>& expected, const Result& got) {
        const auto off = [](const dvec3& e, const vec4& v) { return !(length(e - dvec3(v)) <= 1e-6 * length(e)); };
        size_t wrong = 0;
        for (size_t i = 0; i < expected.size(); ++i) wrong += off(expected[i].indirect, got.indirect[i]) || off(expected[i].beauty, got.beauty[i]) || (!got.direct.empty() && off(expected[i].direct, got.direct[i]));
        return wrong;
    }
};

TEST_F(ComposeTest, twin_knows_a_furnace) {
    HostGBuffer g(1, 1);
    g.albedo[0] = vec4(0.5f), g.emitted[0] = vec4(1);
    const std::vector<vec4> irradiance{vec4(3.14159265f)}, natural{vec4(2 * 3.14159265f)}, direct{vec4(2)};
    const ComposedRef c = compose_ref(g, &irradiance, &natural, &direct)[0];
    EXPECT_NEAR(c.indirect.x, 1.5, 1e-7);
    EXPECT_NEAR(c.beauty.x, 4.5, 1e-7);
}

TEST_F(ComposeTest, equals_the_twin_with_and_without_each_light) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {9u, 7u}, {64u, 1u}, {65u, 33u}}) {
        const HostGBuffer g = random_gbuffer(width, height);
        const auto irradiance = random_image(g.pixels(), 9), natural = random_image(g.pixels(), 9), direct = random_image(g.pixels(), 3);
        for (int lights = 0; lights < 8; ++lights) {
            const auto *e = lights & 1 ? &irradiance : nullptr, *n = lights & 2 ? &natural : nullptr, *d = lights & 4 ? &direct : nullptr;
            const Result got = run(g, e, n, d);
            EXPECT_EQ(differing(compose_ref(g, e, n, d), got), 0u) << width << "x" << height << ", lights " << lights;
            for (size_t i = 0; i < g.pixels(); ++i) EXPECT_TRUE(got.indirect[i].w == 0 && got.beauty[i].w == 1 && (e || n || got.indirect[i] == vec4(0)));
        }
    }
}

TEST_F(ComposeTest, lamps_are_direct_light) {
    for (bool glossy : {false, true}) {
        HostGBuffer g = random_gbuffer(33, 9);
        if (glossy)
            for (size_t i = 0; i < g.pixels(); ++i) g.shine(i, vec3(0.5f), 0.5f, {0, 0, 1});
        const auto irradiance = random_image(g.pixels() * (glossy ? 2 : 1), 9), lamps = random_image(irradiance.size(), 9), direct = random_image(g.pixels(), 3);
        for (const auto* d : {static_cast<const std::vector<vec4>*>(nullptr), &direct})
            for (const auto* e : {static_cast<const std::vector<vec4>*>(nullptr), &irradiance})
                EXPECT_EQ(differing(compose_ref(g, e, nullptr, d, &lamps), run(g, e, nullptr, d, &lamps)), 0u) << glossy;
    }
}

TEST_F(ComposeTest, what_the_bound_cuts_off_is_indirect_light) {
    HostGBuffer g = random_gbuffer(17, 9);
    const auto irradiance = random_image(2 * g.pixels(), 9), beyond = random_image(g.pixels(), 9);
    for (const bool glossy : {false, true}) {
        if (glossy) g.shine(3, vec3(0.5f), 0.5f, {0, 0, 1});
        for (const auto* e : {static_cast<const std::vector<vec4>*>(nullptr), &irradiance})
            EXPECT_EQ(differing(compose_ref(g, e, nullptr, nullptr, nullptr, &beyond), run(g, e, nullptr, nullptr, nullptr, &beyond)), 0u) << glossy;
    }
}

TEST_F(ComposeTest, lobes_add_what_they_reflect) {
    HostGBuffer g = random_gbuffer(13, 5);
    g.shine(0, vec3(1), 0.5f, vec3(0, 0, 1));
    const auto both = random_image(2 * g.pixels(), 9), of_sky = random_image(2 * g.pixels(), 9);
    const Result got = run(g, &both, nullptr, nullptr);
    EXPECT_EQ(differing(compose_ref(g, &both, nullptr, nullptr), got), 0u);
    EXPECT_EQ(differing(compose_ref(g, nullptr, &of_sky, nullptr), run(g, nullptr, &of_sky, nullptr)), 0u);
    EXPECT_EQ(differing(compose_ref(g, &both, &of_sky, nullptr), run(g, &both, &of_sky, nullptr)), 0u);
    for (size_t i = 0; i < g.pixels(); ++i) EXPECT_GT(got.indirect[i].x, both[g.pixels() + i].x);
    EXPECT_EQ(differing(compose_ref(g, nullptr, nullptr, nullptr), run(g, nullptr, nullptr, nullptr)), 0u);
}

TEST_F(ComposeTest, nothing_lit_is_black_but_for_what_shines) {
    HostGBuffer g = random_gbuffer(8, 8);
    const Result shining = run(g, nullptr, nullptr, nullptr);
    for (size_t i = 0; i < g.pixels(); ++i) EXPECT_EQ(vec3(shining.beauty[i]), vec3(g.emitted[i]));
    g.emitted.assign(g.pixels(), vec4(0));
    for (const vec4& v : run(g, nullptr, nullptr, nullptr).beauty) EXPECT_EQ(v, vec4(0, 0, 0, 1));
}

TEST_F(ComposeTest, comparator_sees_a_wrong_pixel) {
    const HostGBuffer g = random_gbuffer(8, 8);
    const auto irradiance = random_image(g.pixels(), 9);
    const auto expected = compose_ref(g, &irradiance, nullptr, nullptr);
    Result got = run(g, &irradiance, nullptr, nullptr);
    ASSERT_EQ(differing(expected, got), 0u);
    got.indirect[7] *= 1.001f;
    EXPECT_EQ(differing(expected, got), 1u);
}

}  // namespace
}  // namespace myriad::passes
