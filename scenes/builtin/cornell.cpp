// The Cornell box, in metres: 5.5 m wide and high, open towards the camera at +Z. Measures and colours are those of
// Cornell's data sheet, rounded; the panel hangs a little below the ceiling, so that no two faces share a plane.
#include "scenes/builtin.hpp"
#include "scenes/builtin/kit.hpp"

#include <glm/gtc/matrix_transform.hpp>

namespace myriad::scenes {
namespace {

using glm::vec3;

constexpr float size = 5.5f, wall = 0.1f;

// A wall is a slab with its inner face on the box: light that is thicker than nothing cannot leak around edges.
Primitive slab(vec3 lo, vec3 hi, uint32_t material, float cell) {
    Primitive p;
    p.material = material;
    kit::box(p, lo, hi, cell);
    return p;
}

}  // namespace

Scene make_cornell(const BuiltinOptions& options, uint32_t) {
    Scene scene;
    const uint32_t white = kit::add_material(scene, "white", {0.74f, 0.73f, 0.69f}, 1);
    const uint32_t red = kit::add_material(scene, "red", {0.61f, 0.06f, 0.06f}, 1);
    const uint32_t green = kit::add_material(scene, "green", {0.12f, 0.46f, 0.10f}, 1);
    const float cell = size / options.number("cells"), s = size, h = size / 2, w = wall;

    // The slabs run into each other, each end at another depth: closed corners, and no two faces in one plane.
    const float in = w / 2, e = 0.01f;
    std::vector<Primitive> walls;
    walls.push_back(slab({-h - w - e, -w, -h - w - e}, {h + w + e, 0, h}, white, cell));
    walls.push_back(slab({-h - w - e, s, -h - w - e}, {h + w + e, s + w, h}, white, cell));
    walls.push_back(slab({-h - in, -in, -h - w}, {h + in, s + in, -h}, white, cell));
    walls.push_back(slab({-h - w, -in, -h - in}, {-h, s + in, h - e}, red, cell));
    walls.push_back(slab({h, -in, -h - in}, {h + w, s + in, h - e}, green, cell));
    kit::add_instance(scene, kit::add_mesh(scene, "walls", std::move(walls)));

    const auto block = [&](const char* name, vec3 extent, vec3 at, float degrees) {
        Primitive p = slab({-extent.x / 2, 0, -extent.z / 2}, {extent.x / 2, extent.y, extent.z / 2}, white, cell);
        const glm::mat4 turned = glm::rotate(glm::mat4(1), glm::radians(degrees), vec3(0, 1, 0));
        kit::add_instance(scene, kit::add_mesh(scene, name, {std::move(p)}), glm::translate(glm::mat4(1), at) * turned);
    };
    // A hair above the floor: their undersides must not share its plane.
    block("short block", {1.65f, 1.65f, 1.65f}, {0.93f, 0.002f, 1.05f}, -17);
    block("tall block", {1.65f, 3.30f, 1.65f}, {-0.92f, 0.002f, -0.78f}, 17);

    if (options.word("light") == "panel") {
        const uint32_t lamp = kit::add_material(scene, "lamp", {0.78f, 0.78f, 0.78f}, 1);
        scene.materials[lamp].emissive = {42, 31, 18};
        Primitive panel;
        panel.material = lamp;
        kit::quad(panel, {-0.65f, s - 0.01f, -0.53f}, {1.3f, 0, 0}, {0, 0, 1.06f}, 4, 4);  // faces down
        kit::add_instance(scene, kit::add_mesh(scene, "panel", {std::move(panel)}));
    } else {
        // The panel's power, from a point where the panel was.
        scene.lights.push_back({Light::Type::point, "lamp", {0, s - 0.5f, 0}, {0, -1, 0}, {14.5f, 10.7f, 6.2f}});
    }
    kit::add_camera(scene, "front", {0, h, h + 8.0f}, {0, h, 0}, 39.3f);
    return scene;
}

}  // namespace myriad::scenes
