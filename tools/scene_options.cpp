#include "tools/scene_options.hpp"

#include <glm/trigonometric.hpp>

#include "scenes/moment.hpp"

namespace myriad::tools {

const Choices<scenes::SkyChoice>& sky_choices() {
    using scenes::SkyChoice;
    static const Choices<SkyChoice> choices = {{"auto", SkyChoice::automatic}, {"on", SkyChoice::on}, {"off", SkyChoice::off}};
    return choices;
}

void add_scene(CLI::App& command, SceneOptions& o) {
    command.add_option("SCENE", o.scene, "a .gltf or .glb file, FILE#NAME or FILE#INDEX for another scene in it than its default, or builtin:NAME[?key=value&...]")->required()->type_name("");
}

void add_camera(CLI::App& command, SceneOptions& o) {
    command.add_option("--camera", o.camera, "of the scene; the first unless given, and one that sees all where there is none")
        ->type_name("NAME|INDEX");
    add_parsed(command, "--eye", "X,Y,Z", "", "where to look from, in place of a camera, with --target; --eye=-1,2,3 where the first is negative",
               [&o](const std::string& text) { o.eye = parse_point("--eye", text); });
    add_parsed(command, "--target", "X,Y,Z", "", "what to look at; +y is up", [&o](const std::string& text) { o.target = parse_point("--target", text); });
    add_parsed(command, "--yfov", "DEGREES", show_number(default_yfov), "vertical angle of view, of --eye", [&o](const std::string& text) {
        o.yfov = parse_number("--yfov", text, 1, 170);
    });
}

scenes::Camera looking(const SceneOptions& o) {
    scenes::Camera camera{.name = "(from " + show_point(*o.eye) + ")", .yfov = glm::radians(o.yfov.value_or(default_yfov))};
    if (!scenes::look(camera, glm::dvec3(*o.eye), glm::dvec3(*o.target), {0, 1, 0}))
        throw InputError("--eye " + show_point(*o.eye) + " --target " + show_point(*o.target) + " look nowhere, or straight up or down; move one of them");
    return camera;
}

void add_moment(CLI::App& command, SceneOptions& o) {
    command.add_option("--animation", o.animation, "of the scene: the clip that plays, or all of them at once; unless given the first, where a time is,\n"
                       "and none where no time is: then the scene is at rest")->type_name("NAME|INDEX|all");
    add_parsed(command, "--time", "S", "", "the moment to render, in seconds; 0 with --animation", [&o](const std::string& text) { o.time = parse_seconds("--time", text); });
    add_choice(command, "--loop", o.loop, {{"on", true}, {"off", false}}, "clips begin again at their ends, or stay there");
    command.add_option("--camera-path", o.camera_path, "the camera's way, in place of the scene's cameras: JSON, see scenes/README.md")->type_name("FILE");
}

void add_sky(CLI::App& command, SceneOptions& o) {
    add_choice(command, "--sky", o.sky, sky_choices(),
               "light from above, of radiance 1, by " + std::to_string(scenes::default_sky_lights) +
                   " directional lights;\nauto: for a scene that has no light and no emission");
}

void add_environment(CLI::App& command, SceneOptions& o) {
    SceneOptions::Environment& e = o.environment;
    command.add_option("--env", e.file, "an environment that surrounds and lights the scene: an equirectangular picture of radiance, .exr or .hdr;\n"
                       "its middle lies along +x, what is right of it towards +z")->type_name("FILE");
    add_parsed(command, "--env-rotation", "DEGREES", "0", "turns it about +y, anticlockwise seen from above", [&e](const std::string& text) {
        e.rotation = parse_number("--env-rotation", text, -36000, 36000);
    });
    add_parsed(command, "--env-strength", "F", "1", "factor on its radiance", [&e](const std::string& text) {
        e.strength = parse_number("--env-strength", text, 1e-9f, 1e9f);
    });
}

void check_scene(const SceneOptions& o, bool frames) {
    if (o.eye.has_value() != o.target.has_value()) throw InputError(std::string(o.eye ? "--eye" : "--target") + " says but half of where to look; give --eye and --target");
    if (o.eye && !(o.camera.empty() && o.camera_path.empty())) throw InputError("--eye is in place of a camera; leave --camera and --camera-path out with it");
    if (o.yfov && !o.eye) throw InputError("--yfov is about --eye, and cameras have their own; give --eye and --target with it");
    if (o.eye) looking(o);
    if (!o.camera_path.empty() && !o.camera.empty()) throw InputError("--camera and --camera-path both say where to look from; give one of them");
    if (!o.camera_path.empty() && !o.time && !frames) throw InputError("--camera-path is a way in time; say which moment with --time, or which with --frames");
    const SceneOptions::Environment& e = o.environment;
    if (e.file.empty())
        for (const auto& [given, name] : {std::pair(e.rotation.has_value(), "--env-rotation"), {e.strength.has_value(), "--env-strength"}})
            if (given) throw InputError(std::string(name) + " is about an environment, and there is none; name one with --env FILE");
    if (!e.file.empty() && o.sky == scenes::SkyChoice::on) throw InputError("--sky on and --env both say what surrounds the scene; give one of them");
}

std::string builtin_scenes() {
    std::string text = "Built-in scenes:";
    for (const std::string& line : scenes::builtin_names()) text += "\n  builtin:" + line;
    return text;
}

}  // namespace myriad::tools
