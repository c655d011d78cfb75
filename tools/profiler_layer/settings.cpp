#include "tools/profiler_layer/settings.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

namespace myriad::profiler {
namespace {

constexpr const char* prefix = "myriad_profiler.";

std::string trimmed(const std::string& text) {
    const char* blanks = " \t\r\n\"";
    const size_t first = text.find_first_not_of(blanks);
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    for (size_t at = 0; at <= text.size();) {
        const size_t end = std::min(text.find(separator, at), text.size());
        if (const std::string part = trimmed(text.substr(at, end - at)); !part.empty()) parts.push_back(part);
        at = end + 1;
    }
    return parts;
}

bool read_number(const std::string& text, uint64_t& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && !text.empty();
}

// Each of these returns what it would have understood, or nothing when it did.
using Refusal = std::string;

Refusal set_output(Settings& settings, const std::string& value) {
    if (value.empty()) return "the name of a file";
    settings.output = value;
    return {};
}

Refusal set_frames(Settings& settings, const std::string& value) {
    const Refusal refusal = "all, a frame as in 5, a range as in 5-9, or all from one as in 5-";
    uint64_t first = 0, last = Settings{}.last_frame;
    if (value != "all") {
        const size_t dash = value.find('-');
        if (!read_number(value.substr(0, dash), first)) return refusal;
        if (dash == std::string::npos) last = first;
        else if (dash + 1 < value.size() && !read_number(value.substr(dash + 1), last)) return refusal;
        if (last < first) return refusal;
    }
    settings.first_frame = first, settings.last_frame = last;
    return {};
}

template <class Value>
Refusal set_choice(Value& chosen, const std::string& value, const std::vector<std::pair<std::string, Value>>& choices) {
    std::string names;
    for (const auto& [name, choice] : choices) {
        if (name == value) {
            chosen = choice;
            return {};
        }
        names += (names.empty() ? "" : ", ") + name;
    }
    return "one of " + names;
}

Refusal set_granularity(Settings& settings, const std::string& value) {
    return set_choice<Granularity>(settings.granularity, value,
                                   {{"frame", Granularity::frame}, {"pass", Granularity::pass}, {"dispatch", Granularity::dispatch}});
}

Refusal set_boundary(Settings& settings, const std::string& value) {
    return set_choice<Boundary>(settings.boundary, value, {{"auto", Boundary::automatic}, {"present", Boundary::present},
                                                           {"submit", Boundary::submit}, {"label", Boundary::label}});
}

Refusal set_label(Settings& settings, const std::string& value) {
    settings.frame_label = value;
    return {};
}

Refusal set_counters(Settings& settings, const std::string& value) {
    const std::vector<std::string> names = split(value, ',');
    const auto asked = [&](const char* name) { return std::ranges::count(names, name) > 0; };
    for (const std::string& name : names)
        if (name != "submits" && name != "commands" && name != "memory" && name != "none") return "any of submits, commands, memory, or none";
    settings.count_submits = asked("submits"), settings.count_commands = asked("commands"), settings.count_memory = asked("memory");
    return {};
}

struct Key {
    const char* name;
    const char* variable;
    Refusal (*set)(Settings&, const std::string&);
};

constexpr Key keys[] = {
    {"output_file", "MYRIAD_PROFILER_OUTPUT_FILE", set_output},
    {"frames", "MYRIAD_PROFILER_FRAMES", set_frames},
    {"granularity", "MYRIAD_PROFILER_GRANULARITY", set_granularity},
    {"frame_boundary", "MYRIAD_PROFILER_FRAME_BOUNDARY", set_boundary},
    {"frame_label", "MYRIAD_PROFILER_FRAME_LABEL", set_label},
    {"counters", "MYRIAD_PROFILER_COUNTERS", set_counters},
};

void apply(LoadedSettings& loaded, const Key& key, const std::string& value, const std::string& place) {
    if (const Refusal expected = key.set(loaded.settings, value); !expected.empty())
        loaded.problems.push_back(place + ": \"" + value + "\" is not understood and passed over; write " + expected);
}

}  // namespace

std::string Settings::summary() const {
    const std::filesystem::path path = output;
    return (path.extension() == ".json" ? path.parent_path() / path.stem() : path).string() + ".csv";
}

LoadedSettings read_settings(const std::string& text, const std::string& path, const Variables& variable) {
    LoadedSettings loaded;
    size_t number = 0;
    for (size_t at = 0; at < text.size(); ++number) {
        const size_t end = std::min(text.find('\n', at), text.size());
        const std::string line = trimmed(text.substr(at, end - at));
        at = end + 1;
        if (!line.starts_with(prefix)) continue;  // a comment, or another layer's
        const std::string place = path + ", line " + std::to_string(number + 1);
        const size_t equals = line.find('=');
        const std::string name = trimmed(line.substr(0, equals));
        const Key* key = std::ranges::find_if(keys, [&](const Key& k) { return prefix + std::string(k.name) == name; });
        if (equals == std::string::npos) loaded.problems.push_back(place + ": there is no value; write \"" + name + " = …\"");
        else if (key == std::end(keys)) loaded.problems.push_back(place + ": there is no setting \"" + name + "\"; see tools/profiler_layer/README.md");
        else apply(loaded, *key, trimmed(line.substr(equals + 1)), place + ", " + name);
    }
    for (const Key& key : keys)
        if (const char* value = variable(key.variable)) apply(loaded, key, trimmed(value), key.variable);
    if ((loaded.settings.boundary == Boundary::label) == loaded.settings.frame_label.empty())
        loaded.problems.push_back(loaded.settings.frame_label.empty()
                                      ? "frame_boundary is \"label\" without a frame_label, so that all is one frame; set frame_label too"
                                      : "frame_label changes nothing; set frame_boundary to \"label\" too");
    return loaded;
}

std::string settings_path(const Variables& variable) {
    const auto value = [&](const char* name) -> std::string { return variable(name) ? variable(name) : ""; };
    namespace fs = std::filesystem;
    std::error_code ignored;
    fs::path data = value("XDG_DATA_HOME");
    if (data.empty() && !value("HOME").empty()) data = fs::path(value("HOME")) / ".local/share";
    if (const fs::path file = data / "vulkan/settings.d/vk_layer_settings.txt"; !data.empty() && fs::is_regular_file(file, ignored)) return file;
    const fs::path given = value("VK_LAYER_SETTINGS_PATH");
    if (fs::is_directory(given, ignored)) return given / "vk_layer_settings.txt";
    return fs::exists(given, ignored) ? given.string() : "vk_layer_settings.txt";
}

LoadedSettings load_settings() {
    const Variables variable = [](const char* name) { return std::getenv(name); };
    const std::string path = settings_path(variable);
    std::ifstream file(path);
    return read_settings({std::istreambuf_iterator<char>(file), {}}, path, variable);
}

}  // namespace myriad::profiler
