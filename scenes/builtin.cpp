#include "scenes/builtin.hpp"

#include <algorithm>
#include <charconv>

#include "engine/error.hpp"

namespace myriad::scenes {
namespace {

// All of `text` as a number, or nothing: "2x" is a typing error, not 2.
std::optional<float> to_number(const std::string& text) {
    float value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

std::string joined(const std::vector<std::string>& words) {
    std::string out;
    for (const auto& word : words) out += (out.empty() ? "" : ", ") + word;
    return out;
}

std::string show(float value) {
    std::string text = std::to_string(value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
}

void check(const std::string& scene, const BuiltinOption& option, const std::string& value) {
    const std::string place = "builtin:" + scene + ": option \"" + option.key + "\" ";
    if (to_number(option.fallback)) {
        const auto number = to_number(value);
        if (!number || !(*number >= option.least && *number <= option.most))
            throw InputError(place + "is \"" + value + "\"; give a number from " + show(option.least) + " to " +
                             show(option.most) + ".");
    } else if (std::find(option.choices.begin(), option.choices.end(), value) == option.choices.end()) {
        throw InputError(place + "is \"" + value + "\"; give one of: " + joined(option.choices) + ".");
    }
}

}  // namespace

BuiltinOptions::BuiltinOptions(const std::string& scene, const std::vector<BuiltinOption>& known, const std::string& query) {
    for (const auto& option : known) values_[option.key] = option.fallback;
    for (size_t at = 0; at < query.size();) {
        const size_t end = std::min(query.find('&', at), query.size());
        const std::string item = query.substr(at, end - at);
        const size_t equals = item.find('=');
        const std::string key = item.substr(0, equals);
        const auto option = std::find_if(known.begin(), known.end(), [&](const auto& o) { return o.key == key; });
        if (option == known.end()) {
            std::vector<std::string> keys;
            for (const auto& o : known) keys.push_back(o.key);
            throw InputError("builtin:" + scene + ": unknown option \"" + key + "\"; known: " + joined(keys) + ".");
        }
        const std::string value = equals == std::string::npos ? "" : item.substr(equals + 1);
        check(scene, *option, value);
        values_[key] = value;
        at = end + 1;
    }
}

float BuiltinOptions::number(const std::string& key) const { return *to_number(values_.at(key)); }

const std::vector<Builtin>& builtins() {
    static const std::vector<Builtin> all = {
        {"atrium", "a sunlit two-storey court with arcades, galleries and curtains (the default scene)",
         {{"detail", "1", {}, 0.25f, 4}}, make_atrium},
        {"cathedral", "a gothic nave with coloured sun and stained glass",
         {{"detail", "1", {}, 0.25f, 4}}, make_cathedral},
        {"cornell", "the Cornell box, lit by its ceiling panel or by a point light",
         {{"light", "panel", {"panel", "point"}}, {"cells", "8", {}, 1, 256}}, make_cornell},
        {"hairball", "a ball of hair in a photographer's booth, 168 triangles a strand",
         {{"strands", "5000", {}, 1, 50000}, {"thickness", "1", {}, 0.25f, 4}}, make_hairball},
        {"particles", "the atrium by night, lit by glowing particles that swarm through it (clip swarm)",
         {{"count", "1024", {}, 0, 1 << 20}, {"detail", "1", {}, 0.25f, 4}}, make_particles},
        {"teatime", "a table laid for tea in a room with sunny windows",
         {{"detail", "1", {}, 0.25f, 4}}, make_teatime},
    };
    return all;
}

std::vector<std::string> builtin_names() {
    std::vector<std::string> lines;
    for (const auto& builtin : builtins()) {
        std::string options;
        for (const auto& o : builtin.options) options += (options.empty() ? "?" : "&") + o.key + "=" + o.fallback;
        lines.push_back(builtin.name + options + ": " + builtin.summary);
    }
    return lines;
}

Scene load_builtin(const std::string& query, uint32_t seed) {
    const size_t mark = query.find('?');
    const std::string name = query.substr(0, mark);
    for (const auto& builtin : builtins()) {
        if (builtin.name != name) continue;
        const BuiltinOptions options(name, builtin.options, mark == std::string::npos ? "" : query.substr(mark + 1));
        Scene scene = builtin.make(options, seed);
        scene.name = "builtin:" + query;
        return scene;
    }
    std::vector<std::string> names;
    for (const auto& builtin : builtins()) names.push_back(builtin.name);
    throw InputError("builtin:" + name + ": there is no such built-in scene; known: " + joined(names) + ".");
}

}  // namespace myriad::scenes
