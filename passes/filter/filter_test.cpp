#include "passes/filter/filter.hpp"

#include "engine/testing.hpp"
#include "passes/filter/filter_ref.hpp"

namespace myriad::passes {
namespace {

using glm::dvec3;
constexpr uint blocks[] = {1, 2, 3, 4, 5, 8, 16};

class FilterTest : public engine::DeviceTest {
protected:
    static constexpr float angle = 0.01f;  // of a pixel
    float uniform(float lo = -1, float hi = 1) { return std::uniform_real_distribution<float>(lo, hi)(random); }
    vec3 direction() { return normalize(vec3(uniform(), uniform(), uniform()) + vec3(0, 0, 1e-3f)); }

    std::vector<vec4> run(const HostGBuffer& host, const std::vector<vec4>& irradiance, uint block) {
        const GBuffer gbuffer = host.on(device);
        const auto on = on_device(irradiance);
        FilterPass filter(device, host.width, host.height, gbuffer.glossy());
        engine::Recorder recorder(device);
        filter.record(recorder, gbuffer, on, block, angle);
        recorder.submit_and_wait();
        return engine::download(device, filter.filtered());
    }

    // What a pinhole at the origin sees along +z of the plane { p : (p - at) . n = 0 }, for the pixels that `where` accepts.
    template <class Where>
    static void plane(HostGBuffer& g, const vec3& at, const vec3& n, Where where) {
        for (uint y = 0; y < g.height; ++y)
            for (uint x = 0; x < g.width; ++x) {
                const vec3 ray((float(x) + 0.5f - 0.5f * float(g.width)) * angle, (0.5f * float(g.height) - float(y) - 0.5f) * angle, 1);
                const float depth = dot(at, n) / dot(ray, n);
                if (where(x, y) && depth > 0) g.put(y * g.width + x, depth * ray, dot(n, ray) < 0 ? n : -n, dot(n, ray) < 0 ? n : -n, depth);
            }
    }
    static constexpr auto everywhere = [](uint, uint) { return true; };

    std::vector<vec4> random_image(const HostGBuffer& g) {
        std::vector<vec4> image(g.pixels());
        for (vec4& v : image) v = {uniform(0, 9), uniform(0, 9), uniform(0, 9), 0};
        return image;
    }
    static bool reaches(const HostGBuffer& g, size_t i) { return g.hit(i) && g.positions[i].w < 40; }
    // A value for each of the k x k sets, as the gather interleaves them.
    std::vector<vec4> pattern(const HostGBuffer& g, uint k, vec3& mean) {
        std::vector<vec4> sets(k * k), image;
        dvec3 sum(0);
        for (vec4& v : sets) sum += dvec3(v = {uniform(0, 1), std::pow(10.0f, uniform(-3, 3)), float(random() % 2), 0});
        for (size_t i = 0; i < g.pixels(); ++i) image.push_back(sets[i % g.width % k + i / g.width % k * k]);
        mean = vec3(sum / double(k * k));
        return image;
    }
    static size_t differing(const std::vector<dvec3>& expected, const std::vector<vec4>& got) {
        size_t wrong = 0;
        for (size_t i = 0; i < got.size(); ++i) wrong += !(length(expected[i] - dvec3(got[i])) <= 3e-5 * length(expected[i]) + 1e-12);
        return wrong;
    }
};

TEST_F(FilterTest, every_set_has_the_same_taps) {
    for (uint k = 1; k <= 16; ++k) {
        std::vector<double> of_set(k, 0);
        const int reach = filter_reach(k);
        for (int d = -reach; d <= reach; ++d) of_set[size_t(d + 16 * int(k)) % k] += filter_tap(d, k);
        for (double w : of_set) EXPECT_EQ(w, 1) << "block " << k;
    }
}

TEST_F(FilterTest, constant_light_stays_constant_on_a_plane) {
    for (uint k : blocks)
        for (int i = 0; i < 3; ++i) {
            HostGBuffer g(37, 23);
            plane(g, {0, 0, 3}, i == 0 ? vec3(0, 0, -1) : direction(), everywhere);
            const float level = i == 0 ? 1 : i == 1 ? 1e-20f : 1e20f;
            const auto got = run(g, std::vector<vec4>(g.pixels(), vec4(vec3(1, 2, 4) * level, 7)), k);
            for (size_t p = 0; p < got.size(); ++p)
                for (int c = 0; c < 3; ++c) ASSERT_NEAR(got[p][c], g.hit(p) ? level * float(1 << c) : 0, 5e-6f * level * float(1 << c)) << k;
        }
}

TEST_F(FilterTest, interleaved_sets_vanish_on_planes) {
    for (uint k : blocks)
        for (float slope : {0.0f, 1.0f, 5.0f}) {
            HostGBuffer g(48, 40);
            plane(g, {0, 0, 10}, normalize(vec3(slope * uniform(), slope * 0.5f, -1)), everywhere);
            // Shading normals that differ from the plane's, as interpolated ones do, do not make steps of it.
            for (uvec2& n : g.normals) n.x = pack_direction(normalize(vec3(0.5f, 0.2f, -1)));
            vec3 mean;
            const auto got = run(g, pattern(g, k, mean), k);
            const uint reach = uint(filter_reach(k));
            size_t inside = 0;
            for (uint y = reach; y + reach < g.height; ++y)
                for (uint x = reach; x + reach < g.width; ++x) {
                    // The packed normal is off by 4e-5, so what lies hundreds of windows away, towards the horizon, seems off the plane.
                    bool whole = true;
                    for (uint dy = 0; dy <= 2 * reach; ++dy)
                        for (uint dx = 0; dx <= 2 * reach; ++dx) whole = whole && reaches(g, (y + dy - reach) * g.width + x + dx - reach);
                    if (!whole) continue;
                    ++inside;
                    const vec3 e(got[y * g.width + x]);
                    for (int c = 0; c < 3; ++c) ASSERT_NEAR(e[c], mean[c], 2e-3f * std::max(mean[c], 1.0f)) << "block " << k << " at " << x << " " << y << ", slope " << slope;
                }
            EXPECT_GT(inside, 100u);
        }
}

// Two surfaces, dark left and bright right, and what of the bright one leaks.
TEST_F(FilterTest, no_leak_over_steps_and_creases) {
    for (uint k : blocks) {
        const auto left = [](uint x, uint) { return x < 20; };
        const auto right = [](uint x, uint) { return x >= 20; };
        const float depth = 2, window = depth * angle * float(k);
        const auto check = [&](const HostGBuffer& g, const char* what, float slack = 0) {
            std::vector<vec4> image;
            for (size_t i = 0; i < g.pixels(); ++i) image.push_back(vec4(i % g.width < 20 ? 1.0f : 1000.0f));
            const auto got = run(g, image, k);
            for (size_t i = 0; i < g.pixels(); ++i)
                ASSERT_NEAR(got[i].x, g.hit(i) ? image[i].x : 0, slack + 1e-6f * image[i].x) << what << ", block " << k << ", x " << i % g.width;
        };
        HostGBuffer step(40, 20), crease(40, 20), turned(40, 20);
        plane(step, {0, 0, depth}, {0, 0, -1}, left);
        plane(step, {0, 0, depth + 1.2f * window}, {0, 0, -1}, right);
        check(step, "a step of 1.2 windows");
        plane(crease, {0, 0, depth}, {0, 0, -1}, left);
        plane(crease, {-0.05f, 0, 0}, {1, 0, 0}, right);
        check(crease, "a crease");
        const vec3 n = normalize(vec3(1, 1, -2)), m = normalize(cross(n, vec3(0.3f, 0.1f, 1)));  // normals that packing rounds
        plane(turned, {0, 0, depth}, n, left);
        plane(turned, {0, 0, depth}, m, right);
        check(turned, "a turned crease", 1e-6f);
    }
}

TEST_F(FilterTest, misses_neither_give_nor_get) {
    HostGBuffer g(16, 16);
    plane(g, {0, 0, 1}, {0, 0, -1}, [](uint x, uint y) { return (x * 7 + y * 3) % 5 != 0; });
    std::vector<vec4> image;
    for (size_t i = 0; i < g.pixels(); ++i) image.push_back(vec4(g.hit(i) ? 1.0f : std::numeric_limits<float>::quiet_NaN()));
    const auto got = run(g, image, 4);
    for (size_t i = 0; i < g.pixels(); ++i) EXPECT_NEAR(got[i].x, g.hit(i) ? 1 : 0, 1e-6f);
    for (const vec4& v : run(HostGBuffer(5, 5), image, 4)) EXPECT_EQ(v, vec4(0));
}

TEST_F(FilterTest, one_set_needs_no_filter) {
    HostGBuffer g(13, 9);
    plane(g, {0, 0, 1}, {0, 0, -1}, everywhere);
    const auto image = random_image(g);
    EXPECT_EQ(differing(filter_ref(g, image, 1, angle), image), 0u);
    EXPECT_EQ(differing(filter_ref(g, image, 1, angle), run(g, image, 1)), 0u);
}

TEST_F(FilterTest, equals_the_twin_on_rough_ground) {
    const std::pair<uint32_t, uint32_t> sizes[] = {{1, 1}, {3, 50}, {41, 2}, {33, 27}};
    for (uint k : blocks)
        for (const auto& [width, height] : sizes) {
            HostGBuffer g(width, height);
            plane(g, {0, 0, 4}, normalize(vec3(0.3f, 0.4f, -1)), [&](uint, uint) { return random() % 10 != 0; });
            for (size_t i = 0; i < g.pixels(); ++i)
                if (g.hit(i)) g.put(i, g.position(i) + 0.02f * direction(), normalize(g.shading(i) + 0.3f * direction()), g.geometric(i), g.positions[i].w);
            const auto image = random_image(g);
            ASSERT_EQ(differing(filter_ref(g, image, k, angle), run(g, image, k)), 0u) << width << "x" << height << ", block " << k;
        }
}

TEST_F(FilterTest, lobes_equal_the_twin) {
    for (uint k : {1u, 2u, 4u}) {
        HostGBuffer g(33, 27);
        plane(g, {0, 0, 4}, normalize(vec3(0.3f, 0.4f, -1)), [&](uint, uint) { return random() % 10 != 0; });
        for (size_t i = 0; i < g.pixels(); ++i)
            g.shine(i, vec3(uniform(0, 1), 0.04f, 0), !g.hit(i) || random() % 5 == 0 ? 0 : uniform(0.1f, 0.5f), normalize(vec3(0.1f, 0.2f, -1)));
        auto image = random_image(g), mirrored = random_image(g);
        image.insert(image.end(), mirrored.begin(), mirrored.end());
        const auto got = run(g, image, k);
        ASSERT_EQ(got.size(), image.size());
        ASSERT_EQ(differing(filter_ref(g, image, k, angle), got), 0u) << "block " << k;
    }
}

// A chequerboard of reflectances and one of matte and glossy keep their edges, while the sets' pattern vanishes.
TEST_F(FilterTest, materials_stay_sharp_in_lobes) {
    HostGBuffer g(48, 40);
    plane(g, {0, 0, 10}, {0, 0, -1}, everywhere);
    const auto squares = [&](size_t i) { return (i % g.width / 3 + i / g.width / 3) % 2 == 1; };
    const vec3 view = normalize(vec3(0, 1, -1));
    for (size_t i = 0; i < g.pixels(); ++i) g.shine(i, squares(i) ? vec3(0.9f, 0.5f, 0.04f) : vec3(0.04f), i % g.width < 24 ? 0.3f : squares(i) ? 0.3f : 0, view);
    vec3 mean;
    std::vector<vec4> light = pattern(g, 4, mean), image(g.pixels(), vec4(0));
    const auto reflected = [&](size_t i, const vec3& l) { return is_matte(g.gloss[i]) ? vec3(0) : l * glossy_albedo(lobe_of(g.gloss[i], g.shading(i))); };
    for (size_t i = 0; i < g.pixels(); ++i) image.push_back(vec4(reflected(i, vec3(light[i])), 0));
    const auto got = run(g, image, 4);
    for (uint y = 2; y + 2 < g.height; ++y)
        for (uint x = 2; x < 22; ++x) {
            const vec3 e = reflected(y * g.width + x, mean), v(got[g.pixels() + y * g.width + x]);
            for (int c = 0; c < 3; ++c) ASSERT_NEAR(v[c], e[c], 3e-3f * e[c]) << x << " " << y;
        }
    for (size_t i = 0; i < g.pixels(); ++i) ASSERT_EQ(got[g.pixels() + i] == vec4(0), is_matte(g.gloss[i])) << i;
}

TEST_F(FilterTest, comparator_sees_a_wrong_pixel) {
    HostGBuffer g(16, 16);
    plane(g, {0, 0, 4}, {0, 0, -1}, everywhere);
    const auto image = random_image(g);
    const auto expected = filter_ref(g, image, 4, angle);
    auto got = run(g, image, 4);
    ASSERT_EQ(differing(expected, got), 0u);
    got[77].z *= 1.001f;
    EXPECT_EQ(differing(expected, got), 1u);
}

}  // namespace
}  // namespace myriad::passes
