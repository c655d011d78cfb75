#include "tools/view/remembered.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "tools/output_file.hpp"

namespace myriad::tools::view {

using nlohmann::ordered_json;

std::filesystem::path config_file() {
    if (const char* config = std::getenv("XDG_CONFIG_HOME"); config && *config) return std::filesystem::path(config) / "myriad" / "view.json";
    if (const char* home = std::getenv("HOME"); home && *home) return std::filesystem::path(home) / ".config" / "myriad" / "view.json";
    return {};
}

Remembered recall(const std::filesystem::path& file) {
    Remembered kept;
    std::ifstream in(file);
    const auto json = ordered_json::parse(in, nullptr, false);
    if (!json.is_object()) return kept;
    const auto take = [&](const char* key, auto& value) {
        try {
            value = json.at(key).get<std::decay_t<decltype(value)>>();
        } catch (const ordered_json::exception&) {
        }
    };
    take("recent", kept.recent), take("options", kept.texts), take("orbits", kept.orbits), take("divisor", kept.divisor);
    take("width", kept.width), take("height", kept.height);
    kept.width = std::clamp(kept.width, 320, 16384), kept.height = std::clamp(kept.height, 200, 16384);
    try {
        for (const auto& [name, text] : kept.texts)
            if (!find_option(name)) throw InputError(name);
        read("builtin:cornell", kept.texts);
    } catch (const InputError&) {  // of another version, or edited
        kept.texts.clear();
    }
    return kept;
}

void remember(const std::filesystem::path& file, const Remembered& kept) {
    if (file.empty()) return;
    std::error_code ignored;  // write_text says what is wrong
    std::filesystem::create_directories(file.parent_path(), ignored);
    const ordered_json json = {{"recent", kept.recent}, {"options", kept.texts}, {"orbits", kept.orbits}, {"divisor", kept.divisor}, {"width", kept.width}, {"height", kept.height}};
    write_text(file, json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n");
}

}  // namespace myriad::tools::view
