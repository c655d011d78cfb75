// The options of `myriad render`: what they are, not what they do.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "passes/frame.hpp"
#include "scenes/sky.hpp"
#include "tools/arguments.hpp"

namespace myriad::tools {

struct RenderOptions {
    std::string scene, camera;
    scenes::SkyChoice sky = scenes::SkyChoice::automatic;
    std::string exr, png, stats, trace;  // files; empty: not wanted
    std::vector<std::string> layers;     // of the EXR beside the beauty: some of layer_names()
    std::optional<float> exposure;       // absent: auto
    passes::FrameSettings frame;
    engine::DeviceOptions device;
    scenes::Sharing instances = scenes::Sharing::automatic;
    std::filesystem::path cache = engine::default_cache_folder();  // empty: none
    uint32_t repeat = 1;
    bool full_floats = false, quiet = false;
};

const Choices<passes::Visibility>& visibilities();
const Choices<compute::AppendMode>& append_modes();
const Choices<scenes::SkyChoice>& sky_choices();
const Choices<scenes::Sharing>& sharings();
const std::vector<std::string>& layer_names();

// Declares the options on `command`; they hold their values once it was parsed and check_outputs has returned.
std::shared_ptr<RenderOptions> add_render_options(CLI::App& command);

// InputError unless there is something to write and all of it can be written, each file under its own name.
void check_outputs(const RenderOptions& options);

}  // namespace myriad::tools
