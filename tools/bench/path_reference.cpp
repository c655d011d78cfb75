#include "tools/bench/path_reference.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>

#include "tools/exr.hpp"
#include "tools/reference/resume.hpp"
#include "tools/render_options.hpp"

namespace myriad::tools {

reference::Settings path_settings(const passes::FrameSettings& frame, uint32_t seed) {
    reference::Settings settings;
    settings.width = frame.width, settings.height = frame.height;
    settings.bounces = frame.bounces;
    settings.seed = seed;
    settings.model = frame.brdf == passes::Brdf::gltf ? reference::Model::gltf : reference::Model::diffuse;
    settings.samples = 1u << 30;
    return settings;
}

PathReference path_reference(const BenchOptions& options, const std::string& name, const scenes::Scene& scene, const scenes::Triangles& flat, const scenes::Camera& camera,
                             const passes::FrameSettings& frame) {
    const uint32_t seed = options.seed + 0x10000;
    const std::map<std::string, std::string> about = {{"scene_digest", reference::scene_digest(scene, scene.lights, flat, camera)}, {"bounces", std::to_string(frame.bounces)},
                                                      {"seed", std::to_string(seed)}, {"brdf", choice_name(brdfs(), frame.brdf)}};
    std::string file = name + "-" + options.camera + "-" + std::to_string(frame.width) + "x" + std::to_string(frame.height) + "-" + std::to_string(frame.bounces);
    std::ranges::replace_if(file, [](char c) { return !std::isalnum(uint8_t(c)) && c != '-' && c != '.' && c != '_'; }, '_');
    const std::string path = options.references.empty() ? "" : options.references + "/" + file + ".exr";
    reference::Film film(frame.width, frame.height);
    if (!path.empty() && std::filesystem::exists(path)) {
        film = reference::resumed(read_exr(path), film, about);
    } else {
        reference::Settings settings = path_settings(frame, seed);
        settings.time_limit = options.reference_seconds;
        reference::Reference(scene, scene.lights, flat, camera, settings).add_to(film);
        if (!path.empty()) {
            Image image = film.image(true);
            image.metadata.insert(about.begin(), about.end());
            write_exr(path, image, ExrColour::full);
        }
    }
    PathReference made{film.image(false), film.samples()};
    const Image::Rgb light = *made.image.rgb(), variance = *made.image.rgb("variance");
    for (const auto& [r, v] : {std::pair(light.r, variance.r), {light.g, variance.g}, {light.b, variance.b}})
        for (size_t i = 0; i < r.size(); ++i) made.noise += double(v[i]) / (double(r[i]) * double(r[i]) + 0.01) / (3 * double(r.size()));
    std::printf("reference: %u paths a pixel, noise of relMSE %.3g\n", made.samples, made.noise);
    return made;
}

}  // namespace myriad::tools
