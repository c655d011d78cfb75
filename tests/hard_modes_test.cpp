// The hard cases of spec, section 4, each in every way that an image is made: cuts from the roots, carried and lazy ones, maps of all triangles,
// imperfect maps, rays, no visibility, compensated bounds, a camera that sees points, natural illumination. Where cuts
// are carried a case plays two frames, between which its lights move. hard_cases_test.cpp has more of the same by all kinds of visibility.
//
// Everywhere: finite numbers, nothing negative, no validation messages. Cuts are those of a recursion on the host, partition each view's leaves
// (spec, section 3), in a tree that keeps all its invariants; carried cuts make the images of basic ones to the bit, and so do lazy ones
// where the scene has stood still for a while.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "compute/bsh/bsh_ref.hpp"
#include "compute/manylods/manylods_ref.hpp"
#include "engine/testing.hpp"
#include "passes/frame.hpp"
#include "passes/geometry/geometry_ref.hpp"
#include "scenes/moment.hpp"
#include "tests/scene_kit.hpp"
#include "tools/render_image.hpp"
#include "tools/render_options.hpp"

namespace myriad::tests {
namespace {

using passes::CutUpdate, passes::FrameSettings, passes::Primary, passes::Visibility;
using tools::Image;

struct HardCase {
    const char* name;
    std::function<Kit()> kit;
    enum Maps {
        known,     // hard_cases_test has it by all kinds of visibility
        compared,  // with rays: about as much light arrives
        wild,      // too coarse for what there is: finite is all that can be asked for
    } maps = known;
};

// The same numbers for every case.
struct Dice {
    std::mt19937 random{7};
    float operator()(float lo = -1, float hi = 1) { return std::uniform_real_distribution<float>(lo, hi)(random); }
    vec3 point(float scale = 1) { return scale * vec3((*this)(), (*this)(), (*this)()); }
};

Kit alone(const vec3& a, const vec3& b, const vec3& c) {
    Kit kit;
    kit.material(vec3(0.8f));
    kit.triangle(0, a, b, c);
    kit.point_light({0, 1, 1}, vec3(5));
    kit.look({0, 0.5f, 2}, {0, 0, 0});
    return kit;
}

Kit degenerate() {
    Kit kit = Kit::room();
    Dice dice;
    for (int i = 0; i < 20; ++i) {
        const vec3 a = dice.point(0.8f), b = dice.point(0.8f);
        kit.triangle(1, a, a, a);
        kit.triangle(1, a, a, b);
        kit.triangle(1, a, b, 0.5f * (a + b) + dice.point(1e-7f));
    }
    return kit;
}

Kit not_numbers() {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity(), tiny = 1e-40f;
    Kit kit = Kit::room();
    kit.triangle(1, vec3(nan), vec3(0), vec3(0, 1, 0));
    kit.triangle(1, vec3(0, -infinity, 0), vec3(0), vec3(0, 1, 0));
    kit.triangle(1, vec3(tiny), vec3(-tiny, tiny, 0), vec3(0, -tiny, tiny));  // of no area in floats
    kit.triangle(1, vec3(0.5f, tiny, -tiny), vec3(-0.5f, 0, tiny), vec3(tiny, 0.5f, 0));
    return kit;
}

Kit edge_on() {
    Kit kit = Kit::room();
    kit.quad(1, {-0.9f, 0.1f, -0.9f}, {1.8f, 0, 0}, {0, 0, 1.8f});
    kit.scene.lights[0].position = {-0.9f, 0.1f, 0.95f};  // light and camera in its plane
    kit.look({0, 0.1f, 0.95f}, {0, 0.1f, -1});
    return kit;
}

Kit seen_from(const vec3& eye, const vec3& at) {
    Kit kit = Kit::room();
    kit.look(eye, at);
    return kit;
}

// All light meets one point of the floor, so all first views are in one place. (compute/manylods has a test of 10^6 of them.)
Kit one_place() {
    Kit kit = Kit::room();
    kit.scene.lights = {{scenes::Light::Type::spot, "", {0.7f, -0.9999f, 0.7f}, {0, -1, 0}, vec3(1e6f), 0, 1e-3f}};
    return kit;
}

// Walls all around a point in the middle of everything: views look along each axis, either way, and surfaces cross their maps' poles and equators.
Kit axes() {
    Kit kit;
    kit.material(vec3(0.7f));
    kit.box(0, vec3(-1), vec3(1));
    for (int a = 0; a < 3; ++a) {
        vec3 u(0), v(0);
        u[a] = 0.25f, v[(a + 1) % 3] = 0.25f;
        kit.quad(0, -0.5f * (u + v), u, v);
    }
    for (int a = 0; a < 6; ++a) {
        vec3 d(0);
        d[a / 2] = a % 2 ? 1.0f : -1.0f;
        kit.scene.lights.push_back({scenes::Light::Type::spot, "", 0.5f * d, d, vec3(3), 0, 0.5f});
    }
    kit.scene.lights.push_back({scenes::Light::Type::directional, "", vec3(0), {1, 0, 0}, vec3(1)});
    kit.look({0, 0, 0.99f}, {0, 0, 0});
    return kit;
}

// A floor that the lit wall stands on, both seen from a millionth above the floor; and slopes that hardly rise.
Kit grazing() {
    Kit kit = Kit::room();
    for (const float slope : {1e-2f, 1e-4f, 1e-6f}) kit.quad(1, {-0.9f, -1 + slope, 0.3f}, {1.8f, 0, 0}, {0, slope, 0.3f});
    kit.scene.lights[0].position = {-0.3f, -1 + 1e-4f, 0.3f};
    kit.look({0, -1 + 1e-6f, 0.95f}, {0, -1, -1});
    return kit;
}

// Surfaces twice in one place, others a hair apart, and things that stand on the floor.
Kit touching() {
    Kit kit = Kit::room();
    kit.box(1, {-0.8f, -1, -0.8f}, {-0.4f, 0, -0.4f});
    for (const float gap : {0.0f, 0.0f, 1e-7f, 1e-5f, 1e-3f}) kit.quad(0, {-0.9f, -1 + gap, 0.2f}, {1.8f, 0, 0}, {0, 0, 0.7f});
    kit.triangle(1, {0, -1, 0.5f}, {0.1f, -1, 0.5f}, {0, 0.5f, 0.5f});
    return kit;
}

// A ground plane and a ball of hair a million times smaller, whose camera is as near.
Kit ratio() {
    Kit kit;
    Dice dice;
    kit.material(vec3(0.7f));
    kit.material({0.2f, 0.7f, 0.2f});
    kit.quad(0, {-1e3f, 0, -1e3f}, {2e3f, 0, 0}, {0, 0, 2e3f});
    for (int i = 0; i < 200; ++i) {
        const vec3 a = 1e-3f * (vec3(0, 0.5f, 0) + dice.point(0.5f));
        kit.triangle(1, a, a + dice.point(3e-4f), a + dice.point(1e-6f));
    }
    kit.point_light(vec3(1e-3f, 2e-3f, 1e-3f), vec3(1e-5f));
    kit.look(1e-3f * vec3(0, 1, 2), 1e-3f * vec3(0, 0.3f, 0));
    return kit;
}

Kit dark() {
    Kit kit = Kit::room();
    kit.scene.lights.clear();
    return kit;
}

const std::vector<HardCase>& hard_cases() {
    static const std::vector<HardCase> cases = {
        {"zero_area_and_needles", degenerate},
        {"one_triangle", [] { return alone({-1, 0, 0}, {1, 0, 0}, {0, 0.5f, -1}); }},
        {"coincident_samples", [] { return alone(vec3(0.1f), vec3(0.1f), vec3(0.1f)); }},
        {"plane_edge_on", edge_on},
        {"camera_on_the_floor", [] { return seen_from({0, -1, 0.5f}, {0, 0, 0}); }},
        {"all_views_in_one_place", one_place, HardCase::compared},
        {"scaled_1e-6", [] { return Kit::room(1e-6f); }},
        {"scaled_1e+6", [] { return Kit::room(1e6f); }},
        {"scaled_to_the_farthest", [] { return Kit::room(0.9f * scenes::farthest); }, HardCase::compared},
        {"a_million_sizes_away", [] { return Kit::room(1, {1e6f, 1e6f, -1e6f}); }},
        {"axes_and_equators", axes, HardCase::compared},
        {"grazing_receivers", grazing, HardCase::compared},
        {"vpls_touch_receivers", touching, HardCase::wild},
        {"one_to_a_million", ratio, HardCase::wild},
        {"no_numbers_and_denormals", not_numbers, HardCase::compared},
        {"empty", [] { return Kit(); }},
        {"empty_with_light", [] { Kit kit; kit.point_light(vec3(0), vec3(1)); return kit; }},
        {"dark", dark},
    };
    return cases;
}

// All cases on one device, since kernels are compiled once a device, which takes longer than all else here.
class HardModes : public engine::DeviceTest {
protected:

    template <class Check>
    static void each(Check check) {
        for (const HardCase& c : hard_cases()) {
            SCOPED_TRACE(c.name);
            check(c, c.kit());
        }
    }

    static FrameSettings small(Visibility visibility = Visibility::manylods) {
        FrameSettings s;
        s.width = 24, s.height = 16;
        s.vpls = 48, s.subset = 12, s.bounces = 2;
        s.log2_samples = 9;
        s.visibility = visibility;
        s.maps.map_size = 16;
        return s;
    }

    struct Played {
        std::vector<Image> images;
        std::vector<passes::FrameCounters> counters;
    };
    // As many frames; lights move after the first. `look` is called with each.
    Played play(const Kit& kit, const FrameSettings& settings, int frames = 1, const std::function<void(const passes::Frame&)>& look = {}) {
        scenes::Scene scene = kit.scene;
        const scenes::Triangles triangles = scenes::flatten(scene);
        const float size = glm::length(triangles.hi - triangles.lo);
        const scenes::Camera camera = scenes::pick_camera(scene, triangles, "");
        passes::Frame frame(device, scene, triangles, settings);
        scenes::Moment moment = scenes::moment_at(scene, triangles.motion, 0);
        Played played;
        for (int f = 0; f < frames; ++f) {
            if (f == 1)
                for (scenes::Light& light : moment.lights)
                    if (light.type != scenes::Light::Type::directional) light.position += 0.01f * size * vec3(1, -0.5f, 0.3f);
            frame.move_to(moment);
            frame.render(camera);
            if (look) look(frame);
            played.images.push_back(tools::read_image(device, frame, tools::layer_names()));
            played.counters.push_back(frame.counters());
            expect_finite(played.images.back());
        }
        return played;
    }

    static void expect_finite(const Image& image) {
        for (const Image::Channel& c : image.channels) {
            const auto bad = std::ranges::find_if(c.values, [](float v) { return !std::isfinite(v); });
            EXPECT_TRUE(bad == c.values.end()) << c.name << " of pixel " << bad - c.values.begin() << " is " << *bad;
        }
        for (const char* name : {"R", "G", "B", "direct.R", "indirect.G"}) EXPECT_GE(*std::ranges::min_element(image.find(name)->values), 0) << name;
    }
    static void expect_identical(const Image& a, const Image& b) {
        ASSERT_EQ(a.channels.size(), b.channels.size());
        for (size_t c = 0; c < a.channels.size(); ++c) EXPECT_TRUE(engine::same(a.channels[c].values, b.channels[c].values)) << a.channels[c].name;
    }
    static double mean(const Image& image, const char* layer) {
        double sum = 0;
        const Image::Rgb c = *image.rgb(layer);
        for (size_t i = 0; i < image.pixels(); ++i) sum += (double(c.r[i]) + c.g[i] + c.b[i]) / 3;
        return sum / double(image.pixels());
    }

    // The tree's invariants, and the partition of its leaves by the cut of each of the frame's views; and that the device's cut is that one.
    void check_cut(const passes::Frame& frame) {
        if (!frame.tree() || frame.tree()->empty() || !frame.vpls()) return;
        const compute::HostTree host(device, *frame.tree());
        const uint count = engine::download(device, frame.vpls()->count())[0];
        const auto views = count ? engine::download(device, frame.vpls()->views(), count) : std::vector<View>{};
        const compute::CutRef expected = compute::cut_ref(host, views, frame.settings().maps.epsilon, frame.settings().maps.map_size);
        EXPECT_EQ(compute::partition_violation(host, expected.cut, count), "");
        EXPECT_EQ(frame.counters().maps->cut, expected.cut.size());
        EXPECT_EQ(frame.counters().maps->node_views, expected.tested);
    }
    void check_tree(const Kit& kit) {
        scenes::Scene scene = kit.scene;
        const scenes::Triangles triangles = scenes::flatten(scene);
        const passes::GeometryData data = passes::geometry_data(scene, triangles);
        const passes::Geometry geometry(device, triangles, data);
        compute::Bsh tree(device, data.world, small().log2_samples, 1);
        if (tree.empty()) return;
        engine::Recorder recorder(device);
        tree.refit(recorder, geometry.positions(), geometry.triangles(), geometry.instances(), geometry.opacity());
        recorder.submit_and_wait();
        EXPECT_EQ(compute::bsh_check(compute::bsh_download(device, tree),
                                     {engine::download(device, tree.samples()), triangles.positions, triangles.triangles, tree.sample_radius(),
                                      tree.sample_share()}), "");
    }
};

TEST_F(HardModes, cuts) {
    each([&](const HardCase&, const Kit& kit) {
        check_tree(kit);
        FrameSettings s = small();
        const Played basic = play(kit, s, 2, [&](const passes::Frame& frame) { check_cut(frame); });
        s.maps.update = CutUpdate::incremental;
        const Played carried = play(kit, s, 2);
        for (int f : {0, 1}) {
            expect_identical(basic.images[f], carried.images[f]);
            if (basic.counters[f].maps) { EXPECT_EQ(carried.counters[f].maps->cut, basic.counters[f].maps->cut) << f; }
        }
        s.maps.update = CutUpdate::lazy;
        const Played lazy = play(kit, s, 6);  // a tree of 512 leaves is no deeper than what is left after the move
        expect_identical(basic.images[1], lazy.images.back());
        if (lazy.counters.back().maps) { EXPECT_EQ(lazy.counters.back().maps->invalid, 0u); }
    });
}

TEST_F(HardModes, visibility) {
    each([&](const HardCase& c, const Kit& kit) {
        if (c.maps == HardCase::known) return;
        std::vector<double> light;
        for (const Visibility v : {Visibility::rays, Visibility::none, Visibility::manylods, Visibility::brute, Visibility::ism, Visibility::megaviews}) {
            SCOPED_TRACE(testing::Message() << "visibility " << int(v));
            light.push_back(mean(play(kit, small(v)).images[0], "indirect"));
        }
        EXPECT_GE(light[1], light[0] * 0.999);
        if (c.maps != HardCase::compared) return;
        EXPECT_GT(light[0], 0);
        EXPECT_NEAR(light[2] / light[0], 1, 0.25) << "maps";
        EXPECT_NEAR(light[3] / light[0], 1, 0.25) << "maps of all triangles";
        EXPECT_NEAR(light[5] / light[0], 1, 0.25) << "shared maps";
    });
}

// What the bound cuts off is light, and nothing but light.
TEST_F(HardModes, compensated) {
    each([&](const HardCase&, const Kit& kit) {
        FrameSettings s = small(Visibility::rays);
        s.bounces = 2;
        const double bounded = mean(play(kit, s).images[0], "indirect");
        s.compensate = 2;
        EXPECT_GE(mean(play(kit, s).images[0], "indirect"), bounded * 0.999);
    });
}

TEST_F(HardModes, a_compensated_bound_is_that_of_few_vpls) {
    scenes::Scene scene = Kit::room().scene;
    const scenes::Triangles triangles = scenes::flatten(scene);
    const auto bound = [&](uint32_t vpls, uint32_t compensate) {
        FrameSettings s = small(Visibility::rays);
        s.vpls = vpls, s.compensate = compensate;
        return passes::Frame(device, scene, triangles, s).vpl_bound();
    };
    EXPECT_EQ(bound(4 * passes::compensated_vpls, 1), bound(passes::compensated_vpls, 0));
    EXPECT_EQ(bound(64, 1), bound(64, 0));
    EXPECT_GT(bound(4 * passes::compensated_vpls, 0), bound(passes::compensated_vpls, 0));
}

TEST_F(HardModes, points) {
    each([&](const HardCase&, const Kit& kit) {
        FrameSettings s = small();
        s.primary = Primary::points;
        play(kit, s);
    });
}

TEST_F(HardModes, natural_light) {
    scenes::Environment sky;
    sky.name = "test.exr", sky.width = 16, sky.height = 8;
    for (uint32_t i = 0; i < 128; ++i) sky.texels.push_back(i == 20 ? vec3(50) : vec3(0.1f, 0.2f, 0.4f));
    each([&](const HardCase&, Kit kit) {
        scenes::apply_environment(kit.scene, sky, 16, 1);
        FrameSettings s = small();
        const Played basic = play(kit, s, 2);
        s.maps.update = CutUpdate::incremental;
        const Played carried = play(kit, s, 2);
        for (int f : {0, 1}) expect_identical(basic.images[f], carried.images[f]);
    });
}

}  // namespace
}  // namespace myriad::tests
