// A frame's last image, as the files that options ask for.
#pragma once

#include "tools/load_scene.hpp"
#include "tools/render_image.hpp"
#include "tools/render_options.hpp"

namespace myriad::tools {

// The settings that made the frame's last image, of options, under the names of these.
nlohmann::ordered_json image_settings(const RenderOptions& options, const passes::Frame& frame, const LoadedScene& loaded, std::optional<uint32_t> number,
                                      std::optional<double> seconds);

// The picture and the EXR that `options` name, with run.settings in its metadata; adds them to run.files. The exposure that is found for the
// first image is that of all: a film must not flicker.
void write_images(const RenderOptions& options, RunRecord& run, Image& image, passes::Frame& frame, std::optional<uint32_t> number);

}  // namespace myriad::tools
