#include "tools/view/wishes.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>

#include "tools/stats.hpp"

namespace myriad::tools::view {
namespace {

// Accepted, but shown elsewhere than in the groups.
const std::vector<std::string> others = {"--size", "--camera", "--eye", "--target", "--yfov", "--time", "--device", "--cache", "--memory-limit", "--env"};

Alternative alternative(const std::string& text) {
    using Kind = Alternative::Kind;
    if (const size_t bracket = text.find("[:"); bracket != std::string::npos) return {Kind::with_or_without, text.substr(0, bracket)};
    if (const size_t colon = text.find(':'); colon != std::string::npos) return {Kind::with_number, text.substr(0, colon)};
    const bool placeholder = std::ranges::any_of(text, [](unsigned char c) { return std::isupper(c); });
    return {placeholder ? Kind::free : Kind::word, text};
}

std::vector<Alternative> alternatives(const std::string& type) {
    std::vector<Alternative> all;
    for (size_t at = 0; at <= type.size();) {
        const size_t bar = std::min(type.find('|', at), type.size());
        all.push_back(alternative(type.substr(at, bar - at)));
        at = bar + 1;
    }
    return all;
}

std::shared_ptr<RenderOptions> parse(std::vector<std::string> arguments) {
    CLI::App app;
    auto options = add_render_options(app);
    std::ranges::reverse(arguments);  // as CLI11 has them
    try {
        app.parse(std::move(arguments));
    } catch (const CLI::ParseError& e) {
        throw InputError(e.what());
    }
    check_choices(*options);
    return options;
}

std::vector<std::string> arguments_of(const Texts& texts) {
    std::vector<std::string> arguments;
    for (const auto& [name, text] : texts) arguments.push_back(name + "=" + text);
    return arguments;
}

nlohmann::ordered_json effect(const RenderOptions& o) { return settings_json(o.frame, o.frame.vpl_bound, !o.environment.file.empty()); }

}  // namespace

const std::vector<Group>& groups() {
    static const std::vector<Group> all = {
        {"Light", {"--visibility", "--vpls", "--bounces", "--gather", "--gather-distance", "--filter", "--point-lights", "--vpl-bound", "--compensate"}},
        {"Maps", {"--map-size", "--epsilon", "--coverage", "--update", "--tree", "--arity", "--samples", "--bias", "--fusion", "--ism-points", "--append"}},
        {"Surfaces and camera", {"--brdf", "--primary", "--primary-pixels", "--exposure"}},
        {"Scene", {"--sky", "--env-lights", "--env-rotation", "--env-strength", "--animation", "--loop", "--rebuild", "--instances", "--seed"}},
    };
    return all;
}

const std::map<std::string, OptionKind>& option_kinds() {
    static const std::map<std::string, OptionKind> all = [] {
        CLI::App app;
        const auto options = add_render_options(app);
        std::vector<std::string> names = others;
        for (const Group& group : groups()) names.insert(names.end(), group.options.begin(), group.options.end());
        std::map<std::string, OptionKind> kinds;
        for (const std::string& name : names) {
            const CLI::Option* option = app.get_option(name);
            kinds[name] = {name, option->get_description(), option->get_type_name(), option->get_default_str(), alternatives(option->get_type_name())};
        }
        return kinds;
    }();
    return all;
}

const OptionKind* find_option(const std::string& name) {
    const auto found = option_kinds().find(name);
    return found == option_kinds().end() ? nullptr : &found->second;
}

std::shared_ptr<RenderOptions> read(const std::string& scene, const Texts& texts) {
    std::vector<std::string> arguments = arguments_of(texts);
    arguments.push_back(scene);
    return parse(std::move(arguments));
}

bool offered(const OptionKind& option, const std::string& scene, const Texts& texts, const Needs& needs) {
    const std::string& name = option.name;
    if (name == "--exposure" || name == "--seed") return true;
    if (name == "--sky") return !texts.contains("--env");
    if (name.starts_with("--env-")) return texts.contains("--env");
    if (name == "--instances") return needs.instances;
    if (name == "--animation" || name == "--loop") return needs.clips;
    if (name == "--rebuild" && !needs.clips) return false;
    if (name == "--point-lights" && !needs.point_lights) return false;
    nlohmann::ordered_json now;
    try {
        now = effect(*read(scene, texts));
    } catch (const InputError&) {
        return true;  // whatever is wrong may be mended there
    }
    std::vector<std::string> trials = {"1", "2"};
    for (const Alternative& a : option.alternatives)
        if (a.kind == Alternative::Kind::word || a.kind == Alternative::Kind::with_or_without) trials.push_back(a.word);
        else if (a.kind == Alternative::Kind::with_number) trials.push_back(a.word + ":1");
    for (const std::string& trial : trials) try {
            Texts changed = texts;
            changed[option.name] = trial;
            if (effect(*read(scene, changed)) != now) return true;
        } catch (const InputError&) {
        }
    return false;
}

std::vector<std::string> render_arguments(const std::string& scene, const Texts& texts, uint32_t width, uint32_t height) {
    std::vector<std::string> arguments = {"myriad", "render", scene};
    Texts all = texts;
    all["--size"] = std::to_string(width) + "x" + std::to_string(height);
    for (const auto& [name, text] : all) {
        if (find_option(name)->fallback == text) continue;
        if (text.starts_with('-')) arguments.push_back(name + "=" + text);  // else it would be taken for an option
        else arguments.push_back(name), arguments.push_back(text);
    }
    return arguments;
}

std::string shell_line(const std::vector<std::string>& arguments) {
    constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./:=,+%@";
    std::string line;
    for (const std::string& argument : arguments) {
        if (!line.empty()) line += ' ';
        if (!argument.empty() && argument.find_first_not_of(plain) == std::string::npos) {
            line += argument;
            continue;
        }
        line += '\'';
        for (const char c : argument) line += c == '\'' ? "'\\''" : std::string(1, c);
        line += '\'';
    }
    return line;
}

}  // namespace myriad::tools::view
