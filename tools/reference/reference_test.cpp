// Closed cases, whose images are known.
#include <gtest/gtest.h>

#include <numbers>

#include "tools/reference/testing.hpp"

namespace myriad::reference {
namespace {

using glm::dvec3;
using tests::Kit;
constexpr double pi = std::numbers::pi;

// A floor in y = 0 that fills the view, seen from above.
Kit floor_kit(const vec3& albedo, float half = 10) {
    Kit kit;
    kit.material(albedo);
    kit.quad(0, {-half, 0, half}, {2 * half, 0, 0}, {0, 0, -2 * half});
    kit.look({0, 2, 0.5f}, {0, 0, 0});
    return kit;
}

// Each pixel's green of a floor against a formula of the point seen, to a part of the formula's value and five of the image's standard errors.
template <class Expected>
void expect_floor(const tools::Image& image, const Kit& kit, const Settings& s, Expected expected, double part) {
    for (uint32_t y = 0; y < s.height; ++y)
        for (uint32_t x = 0; x < s.width; ++x) {
            const double wanted = expected(seen_on_plane(kit.scene.cameras[0], s, x, y, dvec3(0), dvec3(0, 1, 0)));
            const double error = std::sqrt(double(image.find("variance.G")->values[y * s.width + x]));
            EXPECT_NEAR(image.find("G")->values[y * s.width + x], wanted, part * wanted + 5 * error + 1e-7) << x << "," << y;
        }
}

TEST(Reference, point_light_over_a_floor) {
    Kit kit = floor_kit({0.2f, 0.5f, 0.8f});
    kit.point_light({0.3f, 1, 0.2f}, {1, 3, 1});
    const Settings s = small(2, 3);  // a plane reflects nothing onto itself
    const tools::Image image = image_of(kit.scene, s);
    expect_floor(image, kit, s, [](const dvec3& p) {
        const dvec3 to = dvec3(0.3, 1, 0.2) - p;
        return 0.5 / pi * 3 * to.y / std::pow(glm::length(to), 3);
    }, 1e-5);
    EXPECT_EQ(mean_of(image, "indirect.G").mean, 0);
    EXPECT_EQ(mean_of(image, "direct.G").mean, mean_of(image).mean);
}

TEST(Reference, a_light_with_a_radius_grows_no_more_within_it) {
    Kit kit = floor_kit({0.5f, 0.5f, 0.5f});
    kit.point_light({0, 0.2f, 0}, {1, 1, 1});
    kit.scene.lights[0].radius = 0.5f;
    kit.look({0, 0.1f, 0.001f}, {0, 0, 0});  // within the ball, which is then not seen
    const Settings s = small(1);
    expect_floor(image_of(kit.scene, s), kit, s, [](const dvec3& p) {
        const dvec3 to = dvec3(0, 0.2, 0) - p;
        return 0.5 / pi * to.y / glm::length(to) / std::max(0.25, glm::dot(to, to));
    }, 1e-5);
}

TEST(Reference, a_light_with_a_radius_is_seen_as_a_ball) {
    Kit kit = floor_kit({0, 0, 0});
    kit.point_light({0, 1, 0}, {1, 2, 1});
    kit.scene.lights[0].radius = 0.25f;
    kit.look({0, 2, 0.001f}, {0, 0, 0});
    Settings s = small(1);
    s.width = s.height = 128;
    const tools::Image image = image_of(kit.scene, s);
    double solid_angle = 0;
    const double t = std::tan(0.45);
    for (uint32_t y = 0; y < s.height; ++y)
        for (uint32_t x = 0; x < s.width; ++x) {
            const float g = image.find("G")->values[y * s.width + x];
            if (g == 0) continue;
            EXPECT_NEAR(g, 2 / (pi * 0.0625), 1e-4);
            const double a = (2 * (x + 0.5) / s.width - 1) * t, b = (1 - 2 * (y + 0.5) / s.height) * t;
            solid_angle += 4 * t * t / (s.width * s.height) / std::pow(1 + a * a + b * b, 1.5);
        }
    EXPECT_NEAR(solid_angle, 2 * pi * (1 - std::sqrt(1 - 0.0625)), 0.004);
}

TEST(Reference, spot_and_sun_on_a_floor) {
    Kit kit = floor_kit({0.5f, 0.5f, 0.5f});
    kit.scene.lights.push_back({scenes::Light::Type::spot, "", {0, 1.5f, 0}, {0, -1, 0}, {2, 2, 2}, 0.3f, 0.6f});
    const Settings s = small(1);
    expect_floor(image_of(kit.scene, s), kit, s, [](const dvec3& p) {
        const dvec3 to = dvec3(0, 1.5, 0) - p;
        const double cosine = to.y / glm::length(to), part = std::clamp((cosine - std::cos(0.6)) / (std::cos(0.3) - std::cos(0.6)), 0.0, 1.0);
        return 0.5 / pi * 2 * part * part * cosine / glm::dot(to, to);
    }, 2e-5);
    const vec3 down = glm::normalize(vec3(1, -2, 0.5f));
    kit.scene.lights = {{scenes::Light::Type::directional, "", vec3(0), down, {3, 3, 3}}};
    expect_floor(image_of(kit.scene, s), kit, s, [&](const dvec3&) { return 0.5 / pi * 3 * -double(down.y); }, 1e-5);
}

TEST(Reference, many_lights_are_as_bright_as_their_sum) {
    Kit kit = floor_kit({0.5f, 0.5f, 0.5f});
    Kit one = floor_kit({0.5f, 0.5f, 0.5f});
    one.point_light({0, 1, 0}, vec3(2));
    for (int i = 0; i < 200; ++i) kit.point_light({0, 1, 0}, vec3(i % 4 ? 0.002f : 0.034f));  // 150 and 50 of them: 2 in all
    const Settings s = small(256);
    const tools::Image many = image_of(kit.scene, s), single = image_of(one.scene, s);
    const Estimate e = mean_of(many);
    EXPECT_NEAR(e.mean, mean_of(single).mean, 4 * e.error + 1e-5);
}

// From a point to a rectangle parallel to its surface at height 1, one corner above it.
double corner_factor(double a, double b) {
    return (a / std::hypot(1, a) * std::atan(b / std::hypot(1, a)) + b / std::hypot(1, b) * std::atan(a / std::hypot(1, b))) / (2 * pi);
}

TEST(Reference, two_facing_squares_by_their_form_factor) {
    Kit kit;
    kit.material({0.6f, 0.6f, 0.6f});
    kit.material(vec3(0), vec3(1, 5, 1));
    kit.quad(0, {-0.5f, 0, 0.5f}, {1, 0, 0}, {0, 0, -1});
    kit.quad(1, {-0.5f, 1, 0.5f}, {1, 0, 0}, {0, 0, -1});
    kit.look({0.01f, 0.9f, 0}, {0, 0, 0}, {0, 0, -1});
    kit.scene.cameras[0].yfov = 0.9f;  // sees the lower square alone
    const Settings s = small(1024);
    const tools::Image image = image_of(kit.scene, s);
    const auto expected = [](const dvec3& p) {
        double factor = 0;
        for (const double a : {0.5 - p.x, 0.5 + p.x})
            for (const double b : {0.5 - p.z, 0.5 + p.z}) factor += corner_factor(a, b);
        return 0.6 * 5 * factor;
    };
    expect_floor(image, kit, s, expected, 1e-5);
    EXPECT_LT(mean_of(image).error, 2e-3 * mean_of(image).mean);
    EXPECT_EQ(mean_of(image, "direct.G").mean, 0);  // emitters count as indirect, as of render
}

// Light of E from each wall, seen with B reflections before that to the eye: a geometric series of B + 2 terms.
TEST(Reference, a_room_whose_walls_shine) {
    for (const uint32_t bounces : {0u, 1u, 4u, 12u}) {
        Kit kit;
        kit.material(vec3(0.7f), vec3(2));
        kit.box(0, vec3(-1), vec3(1));
        kit.look({0.2f, 0.1f, 0.3f}, {1, 0.4f, -1});
        const Estimate e = mean_of(image_of(kit.scene, small(64, bounces)));
        const double wanted = 2 * (1 - std::pow(0.7, bounces + 2)) / 0.3;
        EXPECT_NEAR(e.mean, wanted, 4 * e.error + 2e-5 * wanted) << bounces;
        EXPECT_LT(e.error, 0.02 * wanted);
    }
}

scenes::Environment picture(uint32_t height, const std::function<vec3(uint32_t, uint32_t)>& radiance) {
    scenes::Environment e;
    e.name = "test", e.width = 2 * height, e.height = height;
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < e.width; ++x) e.texels.push_back(radiance(x, y));
    return e;
}

// What is white in a world of radiance 1 cannot be told from it: a box without its lid, and light that goes round in it.
TEST(Reference, a_white_furnace) {
    Kit kit;
    kit.material(vec3(1));
    const vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    for (const auto& [corner, a, b] : {std::tuple(vec3(-0.5f), x, z), {vec3(-0.5f), x, y}, {vec3(-0.5f), y, z}, {vec3(-0.5f, -0.5f, 0.5f), x, y}, {vec3(0.5f, -0.5f, -0.5f), y, z}})
        kit.quad(0, corner, a, b);
    kit.look({0.3f, 2, 0.4f}, {0, 0, 0});
    kit.scene.environment = picture(4, [](uint32_t, uint32_t) { return vec3(1); });
    const Estimate e = mean_of(image_of(kit.scene, small(256, 64)));
    EXPECT_NEAR(e.mean, 1, 4 * e.error + 2e-3);  // 64 reflections leave less than that in the box
    EXPECT_LT(e.error, 0.005);
}

TEST(Reference, surroundings_light_a_floor_as_their_integral) {
    Kit kit = floor_kit({0.5f, 0.5f, 0.5f});
    scenes::Environment sky = picture(16, [](uint32_t x, uint32_t y) { return x == 5 && y == 3 ? vec3(40) : vec3(0.1f * float(x % 5) + 0.02f * float(y)); });
    sky.rotation = 0.7;
    kit.scene.environment = sky;
    const double wanted = 0.5 / pi * sky.irradiance(dvec3(0, 1, 0)).g;
    const Estimate e = mean_of(image_of(kit.scene, small(256)));
    EXPECT_NEAR(e.mean, wanted, 4 * e.error + 2e-3 * wanted);  // the integral takes each texel at its middle
    EXPECT_LT(e.error, 0.01 * wanted);
    // Turned upside down, the floor is lit from below.
    for (auto& p : kit.scene.meshes[0].primitives[0].positions) p.y = -p.y;
    kit.look({0, -2, 0.5f}, {0, 0, 0});
    const Estimate below = mean_of(image_of(kit.scene, small(256)));
    EXPECT_NEAR(below.mean, 0.5 / pi * sky.irradiance(dvec3(0, -1, 0)).g, 4 * below.error + 2e-3 * wanted);
}

// A pane between lamp and floor.
Kit pane_kit() {
    Kit kit = floor_kit({0.5f, 0.5f, 0.5f});
    kit.material(vec3(0.5f));
    kit.quad(1, {-5, 3, 5}, {10, 0, 0}, {0, 0, -10});
    kit.point_light({0, 4, 0}, vec3(10));
    return kit;
}

TEST(Reference, blended_panes_let_their_part_through) {
    Kit kit = pane_kit();
    const Settings s = small(512);
    const double dark = mean_of(image_of(kit.scene, s)).mean;
    kit.scene.materials[1].alpha = scenes::Material::Alpha::blend;
    kit.scene.materials[1].base_color.a = 0.25f;
    const Estimate through = mean_of(image_of(kit.scene, s), "direct.G");
    kit.scene.materials[1].base_color.a = 0;
    const double clear = mean_of(image_of(kit.scene, s)).mean;
    EXPECT_EQ(dark, 0);
    EXPECT_NEAR(through.mean, 0.75 * clear, 4 * through.error + 1e-6);
}

TEST(Reference, cut_outs_are_there_or_not) {
    Kit kit = pane_kit();
    const Settings s = small(1);
    kit.scene.materials[1].alpha = scenes::Material::Alpha::mask;
    kit.scene.materials[1].base_color.a = 0.4f;
    kit.scene.materials[1].alpha_cutoff = 0.3f;
    EXPECT_EQ(mean_of(image_of(kit.scene, s)).mean, 0);
    kit.scene.materials[1].alpha_cutoff = 0.5f;
    EXPECT_GT(mean_of(image_of(kit.scene, s)).mean, 0);
    // By a texture: two texels, one of which is not there, the border sharp where the filtered alpha is a half.
    kit.scene.textures.push_back({.name = "halves", .width = 2, .height = 1, .rgba = {255, 255, 255, 0, 255, 255, 255, 255}, .wrap_u = scenes::Texture::Wrap::clamp});
    kit.scene.materials[1].base_color.a = 1;
    kit.scene.materials[1].base_color_texture.texture = 0;
    auto& pane = kit.scene.meshes[0].primitives[1];
    for (const vec3& p : pane.positions) pane.texcoords.push_back({p.x > 0 ? 1 : 0, 0});
    const tools::Image image = image_of(kit.scene, s);
    for (uint32_t i = 0; i < s.width * s.height; ++i) {
        const dvec3 p = seen_on_plane(kit.scene.cameras[0], s, i % s.width, i / s.width, dvec3(0), dvec3(0, 1, 0));
        EXPECT_EQ(image.find("G")->values[i] > 0, p.x < 0) << p.x;
    }
}

TEST(Reference, what_is_single_sided_shines_to_the_front) {
    for (const bool front : {true, false}) {
        Kit kit;
        kit.material(vec3(0), vec3(3));
        kit.scene.materials[0].double_sided = false;
        kit.quad(0, {-5, 0, 5}, {10, 0, 0}, {0, 0, -10});
        kit.look({0, front ? 2.0f : -2.0f, 0.5f}, {0, 0, 0});
        EXPECT_EQ(mean_of(image_of(kit.scene, small(1))).mean, front ? 3 : 0);
    }
}

TEST(Reference, what_is_unlit_is_seen_and_lights_nothing) {
    Kit kit = floor_kit(vec3(0.5f));
    kit.scene.materials[0].unlit = true;
    kit.scene.background = vec3(2);
    const tools::Image image = image_of(kit.scene, small(1, 2));
    EXPECT_EQ(mean_of(image).mean, 0.5);
    EXPECT_EQ(mean_of(image, "indirect.G").mean, 0);
    kit.scene.materials[0].unlit = false;
    EXPECT_EQ(mean_of(image_of(kit.scene, small(1, 2))).mean, 0);  // the background is seen, and lights nothing either
    kit.look({0, 2, 0.5f}, {0, 4, 0});
    EXPECT_EQ(mean_of(image_of(kit.scene, small(1, 2))).mean, 2);
}

// A perfect mirror of metal, or nearly: what it shows is the wall's emission times its colour, at the angle.
TEST(Reference, a_metal_mirror_shows_the_lamp) {
    Kit kit = floor_kit({0.8f, 0.6f, 0.4f});
    kit.scene.materials[0].metallic = 1, kit.scene.materials[0].roughness = 0;
    kit.scene.environment = picture(8, [](uint32_t, uint32_t) { return vec3(1); });
    const Settings s = small(64);
    const tools::Image image = image_of(kit.scene, s);
    expect_floor(image, kit, s, [](const dvec3& p) {
        const dvec3 to = dvec3(0, 2, 0.5) - p;
        return 0.6 + 0.4 * std::pow(1 - to.y / glm::length(to), 5);
    }, 1e-4);
    EXPECT_LT(mean_of(image).error, 1e-3);
    Settings plain = s;
    plain.model = Model::diffuse;
    EXPECT_EQ(mean_of(image_of(kit.scene, plain)).mean, 0);
}

TEST(Reference, smooth_metal_in_a_furnace_gains_nothing) {
    for (const float roughness : {0.1f, 0.5f, 1.0f}) {
        Kit kit = floor_kit(vec3(1));
        kit.scene.materials[0].metallic = 1, kit.scene.materials[0].roughness = roughness;
        kit.scene.environment = picture(8, [](uint32_t, uint32_t) { return vec3(1); });
        const Estimate e = mean_of(image_of(kit.scene, small(64)));
        EXPECT_LE(e.mean, 1 + 4 * e.error) << roughness;
        EXPECT_GE(e.mean, roughness < 0.2f ? 0.97 : 0.3) << roughness;
    }
}

// A room with a box, a lamp, and one emissive face.
Kit busy_room() {
    Kit kit = Kit::room();
    kit.scene.materials[1].emissive = vec3(0.3f, 0.1f, 0);
    kit.scene.materials[0].roughness = 0.4f;
    return kit;
}

TEST(Reference, the_same_bits_on_any_number_of_threads) {
    Kit kit = busy_room();
    Settings s = small(4, 2);
    s.width = 33;
    s.threads = 1;
    const tools::Image one = image_of(kit.scene, s);
    s.threads = 2;
    const tools::Image two = image_of(kit.scene, s);
    for (size_t k = 0; k < one.channels.size(); ++k) EXPECT_EQ(one.channels[k].values, two.channels[k].values) << one.channels[k].name;
    s.seed = 2;
    EXPECT_NE(image_of(kit.scene, s).find("R")->values, one.find("R")->values);
}

TEST(Reference, interrupted_and_resumed_is_the_same_to_the_bit) {
    Kit kit = busy_room();
    Settings s = small(7, 2);
    const tools::Image whole = image_of(kit.scene, s);
    const scenes::Triangles triangles = scenes::flatten(kit.scene, scenes::Sharing::never);
    s.samples = 3;
    Film first(s.width, s.height);
    Reference(kit.scene, kit.scene.lights, triangles, kit.scene.cameras[0], s).add_to(first);
    Film second(first.image(true));
    EXPECT_EQ(second.samples(), 3u);
    s.samples = 7;
    Reference(kit.scene, kit.scene.lights, triangles, kit.scene.cameras[0], s).add_to(second);
    const tools::Image image = second.image(true);
    for (size_t k = 0; k < image.channels.size(); ++k) EXPECT_EQ(image.channels[k].values, whole.channels[k].values) << image.channels[k].name;
}

TEST(Reference, ends_when_time_is_up_or_when_told) {
    Kit kit = busy_room();
    Settings s = small(1000);
    s.time_limit = 0;
    EXPECT_EQ(film_of(kit.scene, s).samples(), 1u);
    s.time_limit = std::numeric_limits<double>::infinity();
    s.after_pass = [](const Film& film, double) { return film.samples() < 5; };
    EXPECT_EQ(film_of(kit.scene, s).samples(), 5u);
}

}  // namespace
}  // namespace myriad::reference
