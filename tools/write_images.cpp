#include "tools/write_images.hpp"

#include "tools/exposure.hpp"
#include "tools/exr.hpp"
#include "tools/png.hpp"

namespace myriad::tools {

nlohmann::ordered_json image_settings(const RenderOptions& options, const passes::Frame& frame, const LoadedScene& loaded, std::optional<uint32_t> number,
                                      std::optional<double> seconds) {
    const bool environment = !options.environment.file.empty();
    nlohmann::ordered_json settings = settings_json(frame.settings(), frame.vpl_bound(), environment || frame.point_lights());
    if (environment) settings["env_lights"] = options.lights_of_environment();
    if (number) settings["frame"] = *number;
    add_scene_settings(settings, options, loaded, seconds);
    return settings;
}

void write_images(const RenderOptions& options, RunRecord& run, Image& image, passes::Frame& frame, std::optional<uint32_t> number) {
    if (!options.png.empty()) {
        if (!run.exposure) run.exposure = options.exposure ? *options.exposure : auto_exposure(*image.rgb());
        const std::string path = numbered(options.png, number);
        write_png(path, to_picture(frame.tonemapped(static_cast<float>(*run.exposure)), image.width, image.height));
        run.files.push_back(path);
    }
    if (!options.exr.empty()) {
        const std::string path = numbered(options.exr, number);
        image.metadata = image_metadata(run);
        write_exr(path, image, options.full_floats ? ExrColour::full : ExrColour::half);
        run.files.push_back(path);
    }
}

}  // namespace myriad::tools
