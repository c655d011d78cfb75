// What the viewer is asked to show: a scene, and options of `myriad render` as text. All that is known of an option (its values, its default, its
// help, what it contradicts) is asked of the options themselves.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tools/render_options.hpp"

namespace myriad::tools::view {

using Texts = std::map<std::string, std::string>;  // "--vpls" to "1024"; absent: the default

// One of the values that an option can have, as its help spells it: "all", "subset:K", "lazy[:q]", "E".
struct Alternative {
    enum class Kind { word, with_number, with_or_without, free } kind = Kind::word;
    std::string word;  // before the colon; of `free`: what it is called
    bool operator==(const Alternative&) const = default;
};

struct OptionKind {
    std::string name, help, type, fallback;
    std::vector<Alternative> alternatives;
    bool flag() const { return alternatives.size() == 2 && alternatives[0].word == "on" && alternatives[1].word == "off"; }
};

// All that are about the image, by name.
const std::map<std::string, OptionKind>& option_kinds();
// Null: there is no such.
const OptionKind* find_option(const std::string& name);

struct Group {
    const char* title;
    std::vector<std::string> options;
};
const std::vector<Group>& groups();  // what a panel shows

// The options, all checked, as `render` would have them. Throws InputError.
std::shared_ptr<RenderOptions> read(const std::string& scene, const Texts& texts);

// What of a scene decides which options it needs.
struct Needs {
    bool clips = false, point_lights = false, instances = false;
};
// Whether another value of the option would change anything.
bool offered(const OptionKind& option, const std::string& scene, const Texts& texts, const Needs& needs);

// "myriad render …", to be pasted into a shell. Outputs come behind.
std::vector<std::string> render_arguments(const std::string& scene, const Texts& texts, uint32_t width, uint32_t height);
std::string shell_line(const std::vector<std::string>& arguments);

}  // namespace myriad::tools::view
