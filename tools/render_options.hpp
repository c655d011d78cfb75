// The options of `myriad render`: what they are, not what they do.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "passes/frame.hpp"
#include "tools/arguments.hpp"
#include "tools/scene_options.hpp"

namespace myriad::tools {

struct RenderOptions : SceneOptions {
    std::optional<uint32_t> environment_lights;  // absent: scenes::default_environment_lights
    std::string exr, png, stats, trace;  // files; empty: not wanted
    std::vector<std::string> layers;     // of the EXR beside the beauty: some of layer_names()
    std::optional<float> exposure;       // absent: auto
    std::optional<float> primary_pixels; // absent: what frame says
    bool gather_distance = false;        // whether it is given; frame says how far
    bool rebuild = false;                // whether it is given; frame says when
    passes::FrameSettings frame;
    engine::DeviceOptions device;
    scenes::Sharing instances = scenes::Sharing::automatic;
    std::filesystem::path cache = engine::default_cache_folder();  // empty: none
    uint32_t repeat = 1;
    std::optional<uint32_t> capture_frame;  // which of the images RenderDoc captures, from 0
    std::optional<std::pair<uint32_t, uint32_t>> frames;  // first and last; frame i is i / fps seconds in
    std::optional<double> fps;           // absent: usual_fps
    static constexpr double usual_fps = 24;

    uint32_t lights_of_environment() const { return environment_lights.value_or(scenes::default_environment_lights); }
    bool moves() const { return time || frames || !animation.empty(); }  // whether a moment is asked for at all
    bool full_floats = false, quiet = false;
};

const Choices<passes::Visibility>& visibilities();
const Choices<passes::PointLighting>& point_lightings();
const Choices<passes::Primary>& primaries();
const Choices<passes::Brdf>& brdfs();
const Choices<bool>& fusions();
const Choices<uint32_t>& coverages();
const Choices<compute::AppendMode>& append_modes();
const Choices<uint32_t>& arities();
// --update: basic, incremental, lazy or lazy:q.
std::string show_update(const passes::MapSettings& maps);
void parse_update(const std::string& option, const std::string& text, passes::MapSettings& maps);
// --gather: all, subset:K, culled:K or tree:K.
std::string show_gather(const passes::FrameSettings& settings);
void parse_gather(const std::string& option, const std::string& text, passes::FrameSettings& settings);
// --tree: bsh, which is 0 levels, or svo:D.
std::string show_tree(const passes::FrameSettings& settings);
uint32_t parse_tree(const std::string& option, const std::string& text);
const Choices<scenes::Sharing>& sharings();
const std::vector<std::string>& layer_names();

// Declares the options on `command`; they hold their values once it was parsed and check_outputs has returned.
std::shared_ptr<RenderOptions> add_render_options(CLI::App& command);

// `path` as frame `number` has it, where several are rendered: its number for a %0Nd in the name of the file, N digits at least; or
// before the ending, four digits at least.
std::string numbered(const std::string& path, std::optional<uint32_t> number);
bool has_number(const std::string& path);  // whether the name of the file has a %0Nd, N from 1 to 9

// InputError where they contradict one another, or one of them would change nothing. Nothing is said of outputs.
void check_choices(const RenderOptions& options);

// check_choices, and InputError unless there is something to write and all of it can be written, each file under its own name.
void check_outputs(const RenderOptions& options);

}  // namespace myriad::tools
