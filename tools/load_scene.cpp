#include "tools/load_scene.hpp"

#include "tools/environment_file.hpp"
#include "tools/message.hpp"
#include "tools/stats.hpp"

namespace myriad::tools {

std::string LoadedScene::camera_name() const {
    if (look) return look->name;
    if (path) return path->at(0).name;
    return camera == scenes::none ? "(all in view)" : scene.cameras[camera].name;
}

scenes::Camera LoadedScene::camera_at(std::optional<double> seconds, std::span<const scenes::Camera> cameras) const {
    if (look) return *look;
    if (path) return path->at(*seconds);
    return camera == scenes::none ? scenes::framing_camera(triangles) : cameras[camera];
}

LoadedScene load_scene(const SceneOptions& options, scenes::Sharing sharing, std::span<const double> moments, uint32_t environment_lights, uint32_t seed,
                       Progress& progress) {
    LoadedScene loaded;
    if (options.eye) loaded.look = looking(options);
    if (!options.camera_path.empty()) loaded.path.emplace(options.camera_path);
    if (loaded.path)
        for (const double seconds : moments) loaded.path->at(seconds);  // refused now, not after an hour
    loaded.scene = scenes::load(options.scene);
    if (const auto& e = options.environment; !e.file.empty()) {
        const double rotation = glm::radians(double(e.rotation.value_or(0)));
        scenes::apply_environment(loaded.scene, read_environment(e.file, e.strength.value_or(1), rotation, loaded.scene.warnings), environment_lights, seed);
    } else {
        scenes::apply_sky(loaded.scene, options.sky);
    }
    scenes::Playback playback{.loop = options.loop};
    if (!options.animation.empty()) playback = scenes::pick_clips(loaded.scene, options.animation, options.loop);
    else if (!moments.empty() && !loaded.scene.clips.empty()) playback.clips = {0};
    if (!moments.empty() && playback.clips.empty() && !loaded.path)
        throw InputError(options.scene + ": the scene has no animation, so all moments are the same; leave --time and --frames out, or give a --camera-path");
    loaded.triangles = scenes::flatten(loaded.scene, sharing, playback);
    if (!loaded.path) loaded.camera = scenes::find_camera(loaded.scene, options.camera);
    progress.clear();
    for (const std::string& warning : loaded.scene.warnings) say("warning", warning);
    return loaded;
}

void add_scene_settings(nlohmann::ordered_json& settings, const SceneOptions& options, const LoadedScene& loaded, std::optional<double> seconds) {
    const SceneOptions::Environment& e = options.environment;
    if (e.file.empty()) {
        settings["sky"] = choice_name(sky_choices(), options.sky);
    } else {
        settings["env"] = e.file;
        settings["env_rotation"] = shortest(e.rotation.value_or(0)), settings["env_strength"] = shortest(e.strength.value_or(1));
    }
    if (seconds) settings["seconds"] = *seconds;
    if (const auto& clips = loaded.triangles.motion.playback.clips; !clips.empty()) {
        std::string names;
        for (const uint32_t clip : clips) names += (names.empty() ? "" : ", ") + loaded.scene.clips[clip].name;
        settings["animation"] = names, settings["loop"] = options.loop;
    }
}

}  // namespace myriad::tools
