#include "scenes/scene.hpp"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/error.hpp"
#include "scenes/builtin.hpp"
#include "scenes/gltf.hpp"
#include "scenes/moment.hpp"

namespace myriad::scenes {
namespace {

constexpr glm::vec3 up{0, 1, 0};

}  // namespace

void warn(Scene& scene, size_t count, std::string_view what) {
    if (count) scene.warnings.push_back(std::to_string(count) + " " + std::string(what) + ".");
}

Camera framing_camera(const Triangles& triangles) {
    Camera camera;
    camera.name = "framing";
    const glm::dvec3 centre = (glm::dvec3(triangles.lo) + glm::dvec3(triangles.hi)) * 0.5;
    const glm::dvec3 half = (glm::dvec3(triangles.hi) - glm::dvec3(triangles.lo)) * 0.5;
    const glm::dvec3 back = glm::normalize(glm::dvec3(0.6, 0.45, 1.0));  // a little to the side and above
    const glm::dmat3 axes(glm::inverse(glm::lookAt(back, glm::dvec3(0), glm::dvec3(up))));
    // As near as leaves every corner of the bounds in view, in a square image too, and a little room around.
    double distance = 0;
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 corner = glm::transpose(axes) * (half * glm::dvec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
        distance = std::max(distance, corner.z + 1.05 * std::max(std::abs(corner.x), std::abs(corner.y)) / std::tan(camera.yfov * 0.5));
    }
    if (!(distance > 0)) distance = 1;  // a scene without extent
    camera.to_world = glm::mat4(glm::dmat4(axes));
    camera.to_world[3] = glm::vec4(centre + distance * back, 1);
    return camera;
}

uint32_t find_camera(const Scene& scene, const std::string& name) {
    if (name.empty()) return scene.cameras.empty() ? none : 0;
    for (uint32_t i = 0; i < scene.cameras.size(); ++i)
        if (scene.cameras[i].name == name) return i;
    const bool digits = name.size() <= 9 && std::all_of(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (digits && std::stoul(name) < scene.cameras.size()) return uint32_t(std::stoul(name));
    if (scene.cameras.empty())
        throw InputError(scene.name + ": there is no camera \"" + name + "\", for the scene has none; leave the camera out.");
    std::string known;
    for (size_t i = 0; i < scene.cameras.size(); ++i)
        known += (i ? ", " : "") + std::to_string(i) + " \"" + scene.cameras[i].name + "\"";
    throw InputError(scene.name + ": there is no camera \"" + name + "\"; known: " + known + ".");
}

Camera pick_camera(const Scene& scene, const Triangles& triangles, const std::string& name) {
    const uint32_t index = find_camera(scene, name);
    return index == none ? framing_camera(triangles) : scene.cameras[index];
}

Scene load(const std::string& source, uint32_t seed) {
    constexpr std::string_view prefix = "builtin:";
    if (source.starts_with(prefix)) return load_builtin(source.substr(prefix.size()), seed);
    const auto [path, choice] = split_choice(source);
    return load_gltf(path, choice);
}

}  // namespace myriad::scenes
