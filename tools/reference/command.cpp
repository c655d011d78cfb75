// `myriad reference SCENE -o ref.exr`: what `myriad render` is measured against.
#include <CLI/CLI.hpp>

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>

#include "scenes/moment.hpp"
#include "tools/commands.hpp"
#include "tools/exr.hpp"
#include "tools/load_scene.hpp"
#include "tools/message.hpp"
#include "tools/output_file.hpp"
#include "tools/progress.hpp"
#include "tools/reference/reference.hpp"
#include "tools/reference/resume.hpp"
#include "tools/revision.hpp"

namespace myriad::tools {
namespace {

using reference::Film;
using reference::Model;
using reference::Pixel;
using reference::Settings;

struct ReferenceOptions : SceneOptions {
    std::string output;
    Settings settings;
    std::optional<float> time_limit;
    float vpl_bound = 0;  // 0: none
    uint32_t save_seconds = 60;   // between images that are written on the way; 0: none is
    bool resume = false, sums = true, quiet = false;
};

const Choices<Model>& models() {
    static const Choices<Model> choices = {{"gltf", Model::gltf}, {"diffuse", Model::diffuse}};
    return choices;
}

const Choices<Pixel>& pixels() {
    static const Choices<Pixel> choices = {{"centre", Pixel::centre}, {"box", Pixel::box}};
    return choices;
}

constexpr uint32_t most_samples = 1u << 30;

const char* const footer =
    "Layers: direct and indirect as render's; variance: of each pixel's mean, from its samples. An interrupted run leaves the image that was\n"
    "written last, and --resume goes on from there: the same bits as without the interruption, on any number of threads (MYRIAD_THREADS).\n"
    "Exit status: 0 done; 2 bad usage or bad input; 3 out of memory.\n\n";

std::shared_ptr<ReferenceOptions> add_options(CLI::App& command) {
    auto shared = std::make_shared<ReferenceOptions>();
    ReferenceOptions& o = *shared;
    Settings& s = o.settings;
    add_scene(command, o);
    command.add_option("-o,--output", o.output, "image: .exr, linear radiance in 32-bit floats")->required()->type_name("FILE.exr");
    add_parsed(command, "--size", "WxH", std::to_string(s.width) + "x" + std::to_string(s.height), "pixels",
               [&s](const std::string& text) { std::tie(s.width, s.height) = parse_size("--size", text); });
    add_camera(command, o);
    add_moment(command, o);
    add_sky(command, o);
    add_environment(command, o);
    add_whole(command, "--bounces", s.bounces, 0, 64, "reflections of light before what the camera sees, diffuse and glossy");
    add_choice(command, "--brdf", s.model, models(), "how surfaces reflect: as glTF's metallic-roughness materials say, or their diffuse part alone, metals\nblack");
    add_choice(command, "--pixel", s.pixel, pixels(), "where rays go through a pixel: its middle, as render's do, or anywhere in it");
    add_number(command, "--vpl-bound", o.vpl_bound, 1e-30f, 1e30f, "bound of the geometry term between what is seen and what lights it, 1/m^2: the same error as render's --vpl-bound,\nto compare with; unless given, there is none");
    add_whole(command, "--spp", s.samples, 1, most_samples, "samples a pixel, with those that --resume finds");
    add_parsed(command, "--time-limit", "S", "", "seconds of sampling: it ends with the pass of one sample a pixel that goes beyond",
               [&o](const std::string& text) { o.time_limit = parse_number("--time-limit", text, 0, 1e9f); });
    add_whole(command, "--seed", s.seed, 0, ~0u, "of the samples");
    command.add_flag("--resume", o.resume, "go on from the samples of the output file, if there is one");
    add_choice(command, "--sums", o.sums, {{"on", true}, {"off", false}}, "keep in the file what --resume needs, 24 channels");
    add_whole(command, "--save", o.save_seconds, 0, 1u << 30, "seconds after which the image is written on the way; 0: only at the end");
    command.add_flag("-q,--quiet", o.quiet, "no line of results and no progress");
    command.footer(footer + builtin_scenes());
    return shared;
}

void check(const ReferenceOptions& o) {
    if (!o.output.ends_with(".exr")) throw InputError("-o '" + o.output + "': unknown format; name an .exr file");
    check_scene(o);
    require_writable(o.output);
}

// What the scene is like at the moment.
struct Staged {
    std::vector<scenes::Light> lights;
    scenes::Camera camera;
};

Staged stage(LoadedScene& loaded, std::optional<double> seconds) {
    Staged staged{loaded.scene.lights, {}};
    std::vector<scenes::Camera> cameras = loaded.scene.cameras;
    if (loaded.triangles.motion.plays()) {
        scenes::Moment moment = scenes::moment_at(loaded.scene, loaded.triangles.motion, *seconds);
        scenes::deform(loaded.triangles, moment);
        staged.lights = std::move(moment.lights), cameras = std::move(moment.cameras);
    }
    staged.camera = loaded.camera_at(seconds, cameras);
    return staged;
}

std::map<std::string, std::string> metadata(const ReferenceOptions& o, const LoadedScene& loaded, const Staged& staged, std::optional<double> seconds) {
    const Settings& s = o.settings;
    nlohmann::ordered_json settings = {{"technique", "reference"}, {"bounces", s.bounces}, {"seed", s.seed}, {"brdf", choice_name(models(), s.model)},
                                       {"pixel", choice_name(pixels(), s.pixel)}};
    if (o.vpl_bound > 0) settings["vpl_bound"] = show_number(o.vpl_bound);
    add_scene_settings(settings, o, loaded, seconds);
    std::map<std::string, std::string> metadata = {{"scene", loaded.scene.name},
                                                   {"camera", loaded.camera_name()},
                                                   {"scene_digest", reference::scene_digest(loaded.scene, staged.lights, loaded.triangles, staged.camera)},
                                                   {"git_revision", git_revision}};
    for (const auto& [key, value] : settings.items()) metadata[key] = value.is_string() ? value.get<std::string>() : value.dump();
    return metadata;
}

void render_reference(const ReferenceOptions& o) {
    check(o);
    Progress progress(o.quiet);
    progress.show("loading " + o.scene, 0);
    std::optional<double> seconds = o.time;
    if (!o.animation.empty() && !seconds) seconds = 0;
    std::vector<double> moments;
    if (seconds) moments.push_back(*seconds);
    LoadedScene loaded = load_scene(o, scenes::Sharing::never, moments, 0, o.settings.seed, progress);
    const Staged staged = stage(loaded, seconds);
    const std::map<std::string, std::string> about = metadata(o, loaded, staged, seconds);
    Film film(o.settings.width, o.settings.height);
    if (o.resume && std::filesystem::exists(o.output)) film = reference::resumed(read_exr(o.output), film, about);

    progress.show("building", 0);
    Settings settings = o.settings;
    if (o.vpl_bound > 0) settings.bound = o.vpl_bound;
    if (o.time_limit) settings.time_limit = double(*o.time_limit);
    const auto write = [&] {
        Image image = film.image(o.sums);
        for (const auto& [key, value] : about) image.metadata[key] = value;
        write_exr(o.output, image, ExrColour::full);
    };
    double sampled = 0, saved = 0;
    const uint32_t before = film.samples();
    settings.after_pass = [&](const Film& f, double now) {
        sampled = now;
        progress.show("sampling", std::max(double(f.samples()) / settings.samples, now / settings.time_limit));
        if (o.save_seconds > 0 && now - saved >= o.save_seconds && f.samples() < settings.samples) write(), saved = now;
        return true;
    };
    reference::Reference(loaded.scene, staged.lights, loaded.triangles, staged.camera, settings).add_to(film);
    progress.show("writing", 0);
    write();
    progress.clear();
    if (film.dropped()) say("warning", std::to_string(film.dropped()) + " samples were no number and count as black; look for extreme values in the scene's lights and materials.");
    if (!o.quiet) {
        const uint32_t added = film.samples() - before;
        const double rate = sampled > 0 ? double(added) * settings.width * settings.height / sampled : 0;
        std::printf("%u samples a pixel, %u of them new in %.2f s: %.3g paths a second\n", film.samples(), added, sampled, rate);
    }
}

}  // namespace

void add_reference(CLI::App& app) {
    CLI::App* command = app.add_subcommand("reference", "Render a reference by path tracing on the CPU");
    const std::shared_ptr<ReferenceOptions> options = add_options(*command);
    command->callback([options] { render_reference(*options); });
}

}  // namespace myriad::tools
