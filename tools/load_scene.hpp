// A scene as the options say: loaded, lit, in triangles, with its camera.
#pragma once

#include <nlohmann/json.hpp>

#include <optional>
#include <span>
#include <string>

#include "scenes/camera_path.hpp"
#include "scenes/moment.hpp"
#include "tools/progress.hpp"
#include "tools/scene_options.hpp"

namespace myriad::tools {

struct LoadedScene {
    scenes::Scene scene;
    scenes::Triangles triangles;
    uint32_t camera = scenes::none;  // of scene.cameras; none: one that sees all
    std::optional<scenes::CameraPath> path;
    std::optional<scenes::Camera> look;  // where options say so themselves

    std::string camera_name() const;
    // `cameras`: the scene's, at the moment.
    scenes::Camera camera_at(std::optional<double> seconds, std::span<const scenes::Camera> cameras) const;
};

// `moments` (seconds) are those that will be asked for; none: the scene stays at rest. An environment is stood for by so many lights, drawn by
// `seed`; 0: by its picture alone. Warnings are said. Throws InputError.
LoadedScene load_scene(const SceneOptions& options, scenes::Sharing sharing, std::span<const double> moments, uint32_t environment_lights, uint32_t seed,
                       Progress& progress);

// What that was, under the names of the options.
void add_scene_settings(nlohmann::ordered_json& settings, const SceneOptions& options, const LoadedScene& loaded, std::optional<double> seconds);

}  // namespace myriad::tools
