// What the layer is asked to do, and from where it heard it. From weak to strong: the defaults, `vk_layer_settings.txt` (which
// vkconfig writes), environment variables.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace myriad::profiler {

// How finely time is told apart: whole command buffers; also labelled regions and render passes; also each dispatch, draw and copy.
enum class Granularity { frame, pass, dispatch };

// What ends a frame. `automatic`: presenting where the program can present, else each submission.
enum class Boundary { automatic, present, submit, label };

struct Settings {
    std::string output = "myriad_profile.json";  // the trace; the summary lies beside it, as .csv
    uint64_t first_frame = 0, last_frame = std::numeric_limits<uint64_t>::max();
    Granularity granularity = Granularity::pass;
    Boundary boundary = Boundary::automatic;
    std::string frame_label;                     // the region that begins a frame, where labels are the boundary
    bool count_submits = true, count_commands = true, count_memory = true;

    bool covers(uint64_t frame) const { return first_frame <= frame && frame <= last_frame; }
    std::string summary() const;                 // the path of the summary
};

// A setting that could not be followed is told, and its default stays.
struct LoadedSettings {
    Settings settings;
    std::vector<std::string> problems;  // a sentence each
};

using Variables = std::function<const char*(const char*)>;  // getenv, or a test's

// `text` is a settings file's content and `path` its name in messages.
LoadedSettings read_settings(const std::string& text, const std::string& path, const Variables& variable);
// Where Khronos' layers look too, in their order: vkconfig's file, $VK_LAYER_SETTINGS_PATH (a file or its folder), the working folder.
std::string settings_path(const Variables& variable);
LoadedSettings load_settings();

}  // namespace myriad::profiler
