// The hard cases of spec, section 4, through the whole frame: finite images, no validation messages, and where the case has an
// answer, one that the maps and exact rays agree upon.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/testing.hpp"
#include "passes/frame.hpp"
#include "tests/scene_kit.hpp"
#include "tools/render_image.hpp"
#include "tools/render_options.hpp"

namespace myriad::tests {
namespace {

using passes::FrameSettings, passes::Visibility;
using tools::Image;

class HardCases : public engine::DeviceTest {
protected:
    static FrameSettings small(Visibility visibility = Visibility::manylods) {
        FrameSettings s;
        s.width = 33, s.height = 17;
        s.vpls = 96, s.subset = 24, s.bounces = 2;
        s.log2_samples = 10;
        s.visibility = visibility;
        s.maps.map_size = 16;
        return s;
    }
    float uniform(float lo = -1, float hi = 1) { return std::uniform_real_distribution<float>(lo, hi)(random); }
    vec3 point(float scale = 1) { return scale * vec3(uniform(), uniform(), uniform()); }

    Image render(engine::Device& on, const Kit& kit, const FrameSettings& settings) {
        scenes::Scene scene = kit.scene;
        const scenes::Triangles triangles = scenes::flatten(scene);
        passes::Frame frame(on, scene, triangles, settings);
        frame.render(scenes::pick_camera(scene, triangles, ""));
        batches = frame.counters().maps ? frame.counters().maps->batches : 0;
        return tools::read_image(on, frame, tools::layer_names());
    }
    Image render(const Kit& kit, const FrameSettings& settings) { return render(device, kit, settings); }

    static double mean(const Image& image, const char* layer = "") {
        double sum = 0;
        const Image::Rgb c = *image.rgb(layer);
        for (size_t i = 0; i < image.pixels(); ++i) sum += (double(c.r[i]) + c.g[i] + c.b[i]) / 3;
        return sum / double(image.pixels());
    }
    static void expect_finite(const Image& image) {
        for (const Image::Channel& c : image.channels) {
            const auto bad = std::ranges::find_if(c.values, [](float v) { return !std::isfinite(v); });
            EXPECT_TRUE(bad == c.values.end()) << c.name << " of pixel " << bad - c.values.begin() << " is " << *bad;
        }
        for (const char* name : {"R", "G", "B", "direct.R", "indirect.G"})
            EXPECT_GE(*std::ranges::min_element(image.find(name)->values), 0) << name;
    }
    static ::testing::AssertionResult identical(const Image& a, const Image& b) {
        if (a.channels.size() != b.channels.size()) return ::testing::AssertionFailure() << "other channels";
        for (size_t i = 0; i < a.channels.size(); ++i)
            if (auto equal = engine::same(a.channels[i].values, b.channels[i].values); !equal) return equal << " in " << a.channels[i].name;
        return ::testing::AssertionSuccess();
    }

    // Finite by all kinds of visibility. Returns the images: maps, rays, none, maps of all triangles, imperfect ones, shared ones.
    std::vector<Image> all(const Kit& kit) {
        std::vector<Image> images;
        for (Visibility v : {Visibility::manylods, Visibility::rays, Visibility::none, Visibility::brute, Visibility::ism, Visibility::megaviews}) {
            SCOPED_TRACE(testing::Message() << "visibility " << int(v));
            images.push_back(render(kit, small(v)));
            expect_finite(images.back());
        }
        return images;
    }
    // For cases with an answer: light that arrives by the maps is about what exact rays let through, and that is some, but not all.
    void expect_agreement(const std::vector<Image>& images, double tolerance = 0.1) {
        const double maps = mean(images[0], "indirect"), rays = mean(images[1], "indirect"), none = mean(images[2], "indirect");
        EXPECT_GT(rays, 0);
        EXPECT_GE(none, rays * 0.999);
        EXPECT_NEAR(maps / rays, 1, tolerance) << "maps " << maps << ", rays " << rays << ", none " << none;
        EXPECT_NEAR(mean(images[3], "indirect") / rays, 1, tolerance) << "maps of all triangles";
        EXPECT_NEAR(mean(images[5], "indirect") / rays, 1, tolerance) << "shared maps";
        EXPECT_LT(std::abs(maps - rays), std::max(none - rays, 0.1 * rays)) << "maps must be worth more than no visibility";
    }

    uint32_t batches = 0;
};

TEST_F(HardCases, a_room_at_any_scale) {
    const double expected = mean(render(Kit::room(), small(Visibility::rays)));
    for (float scale : {1.0f, 1e-6f, 1e6f}) {
        SCOPED_TRACE(scale);
        const auto images = all(Kit::room(scale));
        expect_agreement(images);
        EXPECT_NEAR(mean(images[1]) / expected, 1, 0.05);
    }
}

TEST_F(HardCases, a_million_away) {
    expect_agreement(all(Kit::room(1e4f, vec3(1e6f, -1e6f, 1e6f))));
    all(Kit::room(1, vec3(1e6f, 1e6f, -1e6f)));  // coordinates are good to 1/16: finite is all that can be asked for
}

TEST_F(HardCases, degenerate_triangles) {
    Kit kit = Kit::room();
    for (int i = 0; i < 50; ++i) {
        const vec3 a = point(0.8f), b = point(0.8f);
        kit.triangle(1, a, a, a);
        kit.triangle(1, a, a, b);
        kit.triangle(1, a, b, 0.5f * (a + b));                  // about collinear
        kit.triangle(1, a, b, 0.5f * (a + b) + point(1e-7f));   // needles
        kit.triangle(0, vec3(0.3f), vec3(0.3f), vec3(0.3f));
    }
    expect_agreement(all(kit));
}

TEST_F(HardCases, hardly_any_geometry) {
    const auto alone = [&](const char* name, const vec3& a, const vec3& b, const vec3& c) {
        SCOPED_TRACE(name);
        Kit kit;
        kit.material(vec3(0.8f));
        kit.triangle(0, a, b, c);
        kit.point_light({0, 1, 1}, vec3(5));
        kit.look({0, 0.5f, 2}, {0, 0, 0});
        const auto images = all(kit);
        for (const Image& image : images) EXPECT_EQ(mean(image, "indirect"), 0) << "one triangle cannot light itself";
        return mean(images[0], "direct");
    };
    EXPECT_GT(alone("one triangle", {-1, 0, 0}, {1, 0, 0}, {0, 0.5f, -1}), 0);
    EXPECT_EQ(alone("coincident", vec3(0.1f), vec3(0.1f), vec3(0.1f)), 0);
    EXPECT_EQ(alone("a needle", vec3(0), vec3(1), vec3(1, 1, 1 + 1e-7f)), 0);
}

TEST_F(HardCases, nothing_at_all) {
    Kit kit;
    for (bool light : {false, true}) {
        if (light) kit.point_light(vec3(0), vec3(1));
        for (const Image& image : all(kit)) EXPECT_EQ(mean(image), 0);
    }
    Kit dark = Kit::room();
    dark.scene.lights.clear();
    for (const Image& image : all(dark)) {
        EXPECT_EQ(mean(image), 0);
        EXPECT_GT(mean(image, "albedo"), 0.1);
    }
}

TEST_F(HardCases, vertices_that_are_no_numbers) {
    Kit kit = Kit::room();
    const Image clean = render(kit, small());
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    kit.triangle(1, vec3(nan), vec3(0), vec3(0, 1, 0));
    kit.triangle(1, vec3(0, infinity, 0), vec3(0), vec3(0, 1, 0));
    scenes::Scene scene = kit.scene;
    scenes::flatten(scene);
    EXPECT_FALSE(scene.warnings.empty());
    EXPECT_TRUE(identical(clean, render(kit, small())));
}

TEST_F(HardCases, a_plane_edge_on) {
    Kit kit = Kit::room();
    kit.quad(1, {-0.9f, 0.1f, -0.9f}, {1.8f, 0, 0}, {0, 0, 1.8f});
    kit.look({0, 0.1f, 0.95f}, {0, 0.1f, -1});  // in the plane
    expect_agreement(all(kit));
    kit.look({0, 0.1f, 0}, {1, 0.1f, 0});       // and on it
    all(kit);
}

TEST_F(HardCases, cameras_in_and_on_things) {
    Kit kit = Kit::room();
    for (const auto& [from, at] : {std::pair{vec3(0.1f, -0.5f, -0.1f), vec3(0, -0.5f, -1)}, {vec3(0.5f, -0.5f, 0), vec3(1, -0.5f, 0)},
                                   {vec3(0, -1, 0.5f), vec3(0, 0, 0)}, {vec3(1, 1, 1), vec3(0)}, {vec3(-0.3f, 0.6f, 0.3f), vec3(0)}}) {
        kit.look(from, at);
        all(kit);
    }
}

TEST_F(HardCases, one_to_a_million) {
    Kit kit;
    kit.material(vec3(0.7f));
    kit.material({0.2f, 0.7f, 0.2f});
    kit.quad(0, {-1e3f, 0, -1e3f}, {2e3f, 0, 0}, {0, 0, 2e3f});
    for (int i = 0; i < 500; ++i) {
        const vec3 a = vec3(0, 0.5f, 0) + point(0.5f);
        kit.triangle(1, a, a + point(0.3f), a + point(1e-3f));
    }
    kit.point_light({1, 2, 1}, vec3(10));
    kit.look({0, 1, 2}, {0, 0.3f, 0});
    all(kit);
}

TEST_F(HardCases, lights_in_odd_places_and_numbers) {
    const auto light = [&](const char* name, const vec3& at) {
        SCOPED_TRACE(name);
        Kit kit = Kit::room();
        kit.scene.lights[0].position = at;
        all(kit);
    };
    light("on a wall", {-1, 0.3f, 0.2f});
    light("in a corner", {1, 1, 1});
    light("in the box", {0, -0.5f, 0});
    light("at the eye", {0.1f, 0.2f, 0.95f});
    light("outside", {5, 5, 5});

    Kit one = Kit::room(), many = Kit::room();
    many.scene.lights.assign(200, one.scene.lights[0]);
    for (auto& l : many.scene.lights) l.intensity /= 200.0f;
    EXPECT_NEAR(mean(all(many)[1]) / mean(render(one, small(Visibility::rays))), 1, 0.1);

    using enum scenes::Light::Type;
    Kit odd = Kit::room();
    odd.scene.lights = {{spot, "", {0, 0.9f, 0}, {0, -1, 0}, vec3(5), 0, 0}, {spot, "", {0, 0.9f, 0}, {0, -1, 0}, vec3(5), 0.5f, 0.5f},
                        {spot, "", {0, 0.9f, 0}, {0, -1, 0}, vec3(5), 1.5707963f, 1.5707963f}, {directional, "", vec3(0), {1, 0, 0}, vec3(1)},
                        {point, "", {0, 0.5f, 0}, {0, -1, 0}, vec3(0)}};
    all(odd);
}

TEST_F(HardCases, intensities_huge_and_tiny) {
    const Image unit = render(Kit::room(), small());
    for (float factor : {1e-30f, 1e-10f, 1e10f, 1e30f, 1e38f}) {
        SCOPED_TRACE(factor);
        Kit kit = Kit::room();
        kit.scene.lights[0].intensity = vec3(factor);
        const auto images = all(kit);
        if (factor > 1e-20f && factor < 1e20f) { EXPECT_NEAR(mean(images[0]) / mean(unit) * 3 / factor, 1, 0.05); }
    }
    Kit mixed = Kit::room();
    mixed.point_light({0.5f, 0.5f, 0.5f}, vec3(1e-30f));
    mixed.point_light({-0.5f, 0.5f, 0.5f}, vec3(1e30f));
    all(mixed);
}

TEST_F(HardCases, emitters) {
    Kit kit = Kit::room();
    kit.scene.lights.clear();
    const uint32_t lamp = kit.material(vec3(0), vec3(20));
    kit.quad(lamp, {-0.3f, 0.99f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f});
    kit.triangle(lamp, vec3(0.5f), vec3(0.5f), vec3(0.6f));  // without area: no light
    expect_agreement(all(kit));
    Kit touching = Kit::room();
    touching.scene.lights.clear();
    touching.material(vec3(0.5f), vec3(20));
    touching.quad(2, {-0.3f, -1, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f});  // in the floor's plane
    all(touching);
    Kit point_like = Kit::room();
    point_like.scene.lights.clear();
    point_like.material(vec3(0), vec3(1e12f));
    point_like.triangle(2, {0, 0.5f, 0}, {1e-6f, 0.5f, 0}, {0, 0.5f, 1e-6f});
    all(point_like);
}

// ---- The same image, whatever way it is made ----

TEST_F(HardCases, the_same_bits_again_and_in_both_append_modes) {
    for (const Kit& kit : {Kit::room(), Kit::room(1e-6f)}) {
        FrameSettings settings = small();
        const Image first = render(kit, settings);
        EXPECT_TRUE(identical(first, render(kit, settings)));
        settings.maps.append = compute::AppendMode::atomic;
        EXPECT_TRUE(identical(first, render(kit, settings)));
        settings.visibility = Visibility::megaviews;
        const Image shared = render(kit, settings);
        EXPECT_TRUE(identical(shared, render(kit, settings)));
        settings.maps.append = compute::AppendMode::scan;
        EXPECT_TRUE(identical(shared, render(kit, settings)));
        settings.octree_levels = 6;
        const Image voxels = render(kit, settings);
        EXPECT_FALSE(identical(shared, voxels)) << "the octree was not drawn";
        EXPECT_TRUE(identical(voxels, render(kit, settings)));
        settings.octree_levels = 0;
        settings.visibility = Visibility::manylods;
        settings.seed = 2;
        EXPECT_FALSE(identical(first, render(kit, settings))) << "another seed must change it, or nothing was compared";
    }
}

// Without a filter each pixel shows its own set of VPLs, which other maps leave as it is: the noise of shared maps is that of maps for each view.
TEST_F(HardCases, shared_maps_leave_each_pixel_its_set) {
    FrameSettings settings = small();
    settings.vpls = 512, settings.filter = false, settings.maps.epsilon = 0.5f;
    const Image maps = render(Kit::room(), settings);
    settings.visibility = Visibility::megaviews;
    const Image shared = render(Kit::room(), settings);
    settings.maps.asks = true;
    const Image asked = render(Kit::room(), settings);
    settings.maps.asks = false, settings.subset = 0;
    const Image all = render(Kit::room(), settings);
    const auto apart = [](const Image& a, const Image& b) {
        double sum = 0, whole = 0;
        const auto &x = a.find("indirect.G")->values, &y = b.find("indirect.G")->values;
        for (size_t i = 0; i < x.size(); ++i) sum += std::abs(double(x[i]) - y[i]), whole += x[i];
        return sum / whole;
    };
    EXPECT_LT(apart(maps, shared), 0.1 * apart(maps, all)) << "sets' own noise is " << apart(maps, all);
    EXPECT_LT(apart(shared, asked), 1e-4) << "the same depths, wherever they are looked up";  // on lavapipe the same bits
}

// Against exact rays the octree's maps are as good as those of samples: measured, 7 levels against 2^14 samples, 0.75 to 0.78 times their error.
TEST_F(HardCases, an_octree_is_as_good_as_samples) {
    for (const Kit& kit : {Kit::room(), Kit::room(1e-6f), Kit::room(1e6f), Kit::room(1, {1e3f, -1e3f, 1e3f})}) {
        FrameSettings settings = small(Visibility::rays);
        settings.vpls = 256, settings.maps.map_size = 32, settings.log2_samples = 14;
        const Image rays = render(kit, settings);
        const auto error = [&](const Image& image) {
            double sum = 0;
            const auto &x = rays.find("indirect.G")->values, &y = image.find("indirect.G")->values;
            double mean = 0;
            for (const float v : x) mean += double(v) / double(x.size());
            for (size_t i = 0; i < x.size(); ++i) sum += (double(x[i]) - y[i]) * (double(x[i]) - y[i]) / (mean * mean * double(x.size()));
            return sum;
        };
        settings.visibility = Visibility::megaviews;
        const double samples = error(render(kit, settings));
        settings.octree_levels = 7;
        const double voxels = error(render(kit, settings));
        RecordProperty("error_of_samples", std::to_string(samples)), RecordProperty("error_of_octree", std::to_string(voxels));
        EXPECT_LT(voxels, 1.25 * samples) << "samples' is " << samples;
        EXPECT_GT(voxels, 0);
    }
}

TEST_F(HardCases, little_memory_gives_the_same_image_in_batches) {
    using passes::GatherMethod;
    for (const auto& [visibility, gather, octree_levels] :
         {std::tuple(Visibility::manylods, GatherMethod::subset, 0u), {Visibility::megaviews, GatherMethod::subset, 0u}, {Visibility::manylods, GatherMethod::tree, 0u},
          {Visibility::megaviews, GatherMethod::culled, 0u}, {Visibility::megaviews, GatherMethod::subset, 4u}}) {
        SCOPED_TRACE(testing::Message() << "visibility " << int(visibility) << ", gather " << int(gather) << ", " << octree_levels << " levels");
        const Kit kit = Kit::room();
        FrameSettings settings = small(visibility);
        settings.gather = gather;
        settings.vpls = 512;
        settings.maps.map_size = 32;
        settings.octree_levels = octree_levels;
        settings.maps.asks = octree_levels > 0;  // both at once, to save time
        const Image ample = render(kit, settings);
        ASSERT_EQ(batches, 1u);
        const uint64_t least = [&] {  // what is needed without maps
            FrameSettings without = settings;
            without.visibility = Visibility::none, without.octree_levels = 0;
            engine::Device probe({.select = "", .validation = false, .memory_limit = 0});
            render(probe, kit, without);
            uint64_t bytes = 0;
            for (const auto& [kind, use] : probe.memory()) bytes += use.peak;
            return bytes;
        }();
        uint32_t split = 0;
        const uint64_t most = visibility == Visibility::megaviews ? 3072u << 10 : 1024u << 10;
        for (uint64_t extra : gather == GatherMethod::subset ? std::vector{most / 2, most} : std::vector{most}) {
            engine::Device little({.select = "", .validation = true, .memory_limit = least + extra});
            try {
                EXPECT_TRUE(identical(ample, render(little, kit, settings))) << extra;
                split += batches > 1;
            } catch (const OutOfMemory& e) {
                EXPECT_LT(extra, most) << e.what();
            }
            EXPECT_EQ(little.validation_messages(), 0u);
        }
        EXPECT_GT(split, 0u);
    }
}

// Picked lights bring what all do, whatever tells who sees whom; each pixel within what few picks scatter, so it is the mean that is compared.
TEST_F(HardCases, picked_lights_bring_what_all_bring) {
    using passes::GatherMethod;
    const Kit kit = Kit::room();
    for (const Visibility visibility : {Visibility::manylods, Visibility::megaviews, Visibility::brute, Visibility::ism, Visibility::rays, Visibility::none}) {
        FrameSettings settings = small(visibility);
        settings.width = 48, settings.height = 32, settings.subset = 0, settings.filter = false;
        const double all = mean(render(kit, settings), "indirect");
        settings.subset = 48;
        for (const GatherMethod gather : {GatherMethod::culled, GatherMethod::tree}) {
            settings.gather = gather;
            const Image picked = render(kit, settings);
            expect_finite(picked);
            EXPECT_NEAR(mean(picked, "indirect") / all, 1, 0.05) << "visibility " << int(visibility) << ", gather " << int(gather);
        }
        settings.gather = GatherMethod::tree, settings.subset = 96;  // as many as there are: all
        EXPECT_EQ(mean(render(kit, settings), "indirect"), all);
    }
}

TEST_F(HardCases, picked_lights_where_there_are_none) {
    FrameSettings settings = small();
    settings.gather = passes::GatherMethod::tree;
    Kit dark = Kit::room();
    dark.scene.lights.clear();
    expect_finite(render(dark, settings));
    settings.vpls = uint32_t(compute::ViewTree::most_views) + 1;
    EXPECT_THROW(render(Kit::room(), settings), InputError);
}

TEST_F(HardCases, the_comparison_sees_a_bit) {
    const Image image = render(Kit::room(), small());
    Image wrong = image;
    wrong.channels[1].values[7] = std::nextafter(wrong.channels[1].values[7], 1e9f);
    EXPECT_TRUE(identical(image, image));
    EXPECT_FALSE(identical(image, wrong));
}

}  // namespace
}  // namespace myriad::tests
