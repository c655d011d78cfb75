// The options that say what is looked at: a scene, its surroundings, its moment and the camera. Commands that make images share them.
#pragma once

#include <optional>
#include <string>

#include "scenes/sky.hpp"
#include "tools/arguments.hpp"

namespace myriad::tools {

struct SceneOptions {
    std::string scene, camera;
    std::optional<glm::vec3> eye, target;  // in place of the scene's cameras; both or none
    std::optional<float> yfov;             // degrees, with these
    scenes::SkyChoice sky = scenes::SkyChoice::automatic;
    struct Environment {
        std::string file;                // empty: none
        std::optional<float> rotation;   // degrees
        std::optional<float> strength;
    } environment;
    std::string animation, camera_path;  // empty: none
    bool loop = true;
    std::optional<double> time;          // seconds; absent: the scene is at rest
};

const Choices<scenes::SkyChoice>& sky_choices();

// Each declares some of them on `command`.
void add_scene(CLI::App& command, SceneOptions& options);
void add_camera(CLI::App& command, SceneOptions& options);
void add_moment(CLI::App& command, SceneOptions& options);
void add_sky(CLI::App& command, SceneOptions& options);
void add_environment(CLI::App& command, SceneOptions& options);
constexpr float default_yfov = 45;
scenes::Camera looking(const SceneOptions& options);  // from eye to target; InputError
// InputError where they contradict one another. `frames`: moments are named by other options.
void check_scene(const SceneOptions& options, bool frames = false);
// A line each of the built-in scenes, for a command's footer.
std::string builtin_scenes();

}  // namespace myriad::tools
