// Values of options, read strictly: the whole text counts, and what is wrong with it is told in one sentence.
#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/error.hpp"

namespace myriad::tools {

// All throw InputError that names the option, the text, and what would do.
uint64_t parse_whole(const std::string& option, const std::string& text, uint64_t least, uint64_t most);  // decimal
float parse_number(const std::string& option, const std::string& text, float least, float most);
glm::vec3 parse_point(const std::string& option, const std::string& text);  // "X,Y,Z", each at most 1e9 from 0
std::string show_point(const glm::vec3& point);
// "640x360"; each side from 1 to max_side.
std::pair<uint32_t, uint32_t> parse_size(const std::string& option, const std::string& text);
constexpr uint32_t max_side = 16384;
double parse_seconds(const std::string& option, const std::string& text);  // any finite number up to 1e6, either sign
double parse_rate(const std::string& option, const std::string& text);     // a second: from 0.001 to 100000
// "A-B", or "A" for one: numbers of frames, A <= B < 10^6.
std::pair<uint32_t, uint32_t> parse_frames(const std::string& option, const std::string& text);
// Names between commas, each one of `known` and none twice, in the order of `known`; "all" is all of them.
std::vector<std::string> parse_list(const std::string& option, const std::string& text, const std::vector<std::string>& known);

[[noreturn]] void refuse_choice(const std::string& option, const std::string& text, const std::vector<std::string>& choices);

std::string show_number(float value);  // the shortest text that reads back as the same float

// An option whose text goes through `parse`, which assigns and throws.
template <class Parse>
CLI::Option* add_parsed(CLI::App& app, const std::string& name, const std::string& type, const std::string& fallback, const std::string& help,
                        Parse parse) {
    return app.add_option_function<std::string>(name, parse, help)->type_name(type)->default_str(fallback);
}

inline CLI::Option* add_whole(CLI::App& app, const std::string& name, uint32_t& value, uint32_t least, uint32_t most,
                              const std::string& help) {
    return add_parsed(app, name, "N", std::to_string(value), help, [=, &value](const std::string& text) {
        value = static_cast<uint32_t>(parse_whole(name, text, least, most));
    });
}

// The default is shown unless it is 0, which then means "found by the program" and is explained in `help`.
inline CLI::Option* add_number(CLI::App& app, const std::string& name, float& value, float least, float most, const std::string& help) {
    return add_parsed(app, name, "X", value ? show_number(value) : "", help, [=, &value](const std::string& text) {
        value = parse_number(name, text, least, most);
    });
}

template <class T>
using Choices = std::vector<std::pair<std::string, T>>;

template <class T>
const std::string& choice_name(const Choices<T>& choices, T value) {
    for (const auto& [name, choice] : choices)
        if (choice == value) return name;
    return choices.front().first;
}

template <class T>
CLI::Option* add_choice(CLI::App& app, const std::string& name, T& value, const Choices<T>& choices, const std::string& help) {
    std::vector<std::string> names;
    for (const auto& choice : choices) names.push_back(choice.first);
    return add_parsed(app, name, CLI::detail::join(names, "|"), choice_name(choices, value), help, [=, &value](const std::string& text) {
        for (const auto& [known, choice] : choices)
            if (text == known) return void(value = choice);
        refuse_choice(name, text, names);
    });
}

}  // namespace myriad::tools
