#include "scenes/scene.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/error.hpp"
#include "scenes/builtin.hpp"
#include "scenes/gltf.hpp"

namespace myriad::scenes {
namespace {

constexpr glm::vec3 up{0, 1, 0};

}  // namespace

Camera framing_camera(const Triangles& triangles) {
    Camera camera;
    camera.name = "framing";
    const glm::dvec3 centre = (glm::dvec3(triangles.lo) + glm::dvec3(triangles.hi)) * 0.5;
    const double radius = glm::length(glm::dvec3(triangles.hi) - glm::dvec3(triangles.lo)) * 0.5;
    // Far enough that the bounding sphere fits the vertical angle, a little to the side and above. A scene without
    // extent is seen from one metre.
    const double distance = radius > 0 ? 1.05 * radius / std::sin(camera.yfov * 0.5) : 1.0;
    const glm::dvec3 eye = centre + distance * glm::normalize(glm::dvec3(0.6, 0.45, 1.0));
    camera.to_world = glm::mat4(glm::inverse(glm::lookAt(eye, centre, glm::dvec3(up))));
    return camera;
}

Camera pick_camera(const Scene& scene, const Triangles& triangles, const std::string& name) {
    if (name.empty()) return scene.cameras.empty() ? framing_camera(triangles) : scene.cameras[0];
    for (const auto& camera : scene.cameras)
        if (camera.name == name) return camera;
    const bool digits = name.size() <= 9 && std::all_of(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (digits && std::stoul(name) < scene.cameras.size()) return scene.cameras[std::stoul(name)];
    if (scene.cameras.empty())
        throw InputError(scene.name + ": there is no camera \"" + name + "\", for the scene has none; leave the camera out.");
    std::string known;
    for (size_t i = 0; i < scene.cameras.size(); ++i)
        known += (i ? ", " : "") + std::to_string(i) + " \"" + scene.cameras[i].name + "\"";
    throw InputError(scene.name + ": there is no camera \"" + name + "\"; known: " + known + ".");
}

Scene load(const std::string& source, uint32_t seed) {
    constexpr std::string_view prefix = "builtin:";
    if (source.starts_with(prefix)) return load_builtin(source.substr(prefix.size()), seed);
    // "file.glb#scene"; a file whose own name has a # is taken as it is.
    std::error_code error;
    const size_t hash = source.rfind('#');
    const bool chosen = hash != std::string::npos && !std::filesystem::exists(source, error) && std::filesystem::exists(source.substr(0, hash), error);
    return chosen ? load_gltf(source.substr(0, hash), source.substr(hash + 1)) : load_gltf(source);
}

}  // namespace myriad::scenes
