#include "tools/arguments.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace myriad::tools {
namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& text, const std::string& cure) {
    throw InputError(option + " '" + text + "': " + cure);
}

// All of `text` as a T, or false; no sign but '-', no blanks, no hexadecimals.
template <class T>
bool read(const std::string& text, T& value) {
    const char *begin = text.data(), *end = begin + text.size();
    const auto [stop, error] = std::from_chars(begin, end, value);
    return error == std::errc() && stop == end;
}

}  // namespace

uint64_t parse_whole(const std::string& option, const std::string& text, uint64_t least, uint64_t most) {
    uint64_t value = 0;
    if (read(text, value) && value >= least && value <= most) return value;
    refuse(option, text, "give a whole number from " + std::to_string(least) + " to " + std::to_string(most));
}

float parse_number(const std::string& option, const std::string& text, float least, float most) {
    float value = 0;
    if (read(text, value) && value >= least && value <= most) return value;  // NaN is not
    refuse(option, text, "give a number from " + show_number(least) + " to " + show_number(most));
}

glm::vec3 parse_point(const std::string& option, const std::string& text) {
    glm::vec3 point(0);
    size_t at = 0;
    for (int c = 0; c < 3; ++c) {
        const size_t end = c < 2 ? text.find(',', at) : text.size();
        if (end == std::string::npos || !read(text.substr(at, end - at), point[c]) || !(std::abs(point[c]) <= 1e9f))
            refuse(option, text, "give X,Y,Z in metres, each from -1e9 to 1e9, such as 0,1.6,5");
        at = end + 1;
    }
    return point;
}

std::string show_point(const glm::vec3& p) { return show_number(p.x) + "," + show_number(p.y) + "," + show_number(p.z); }

std::pair<uint32_t, uint32_t> parse_size(const std::string& option, const std::string& text) {
    const size_t cross = text.find('x');
    uint32_t width = 0, height = 0;
    if (cross != std::string::npos && read(text.substr(0, cross), width) && read(text.substr(cross + 1), height) && width >= 1 &&
        height >= 1 && width <= max_side && height <= max_side)
        return {width, height};
    refuse(option, text, "give WIDTHxHEIGHT in pixels, each from 1 to " + std::to_string(max_side) + ", such as 640x360");
}

double parse_seconds(const std::string& option, const std::string& text) {
    double value = 0;
    if (read(text, value) && std::abs(value) <= 1e6) return value;
    refuse(option, text, "give seconds, from -1e6 to 1e6");
}

double parse_rate(const std::string& option, const std::string& text) {
    double value = 0;
    if (read(text, value) && value >= 0.001 && value <= 100000) return value;  // NaN is not
    refuse(option, text, "give a number from 0.001 to 100000");
}

std::pair<uint32_t, uint32_t> parse_frames(const std::string& option, const std::string& text) {
    constexpr uint32_t most = 999999;
    const size_t dash = std::min(text.find('-'), text.size());
    uint32_t first = 0, last = 0;
    if (read(text.substr(0, dash), first) && read(dash < text.size() ? text.substr(dash + 1) : text, last) && first <= last && last <= most)
        return {first, last};
    refuse(option, text, "give FIRST-LAST, numbers from 0 to " + std::to_string(most) + ", such as 0-47");
}

std::vector<std::string> parse_list(const std::string& option, const std::string& text, const std::vector<std::string>& known) {
    if (text == "all") return known;
    std::vector<std::string> wanted, ordered;
    for (size_t at = 0; at <= text.size();) {
        const size_t comma = std::min(text.find(',', at), text.size());
        wanted.push_back(text.substr(at, comma - at));
        at = comma + 1;
        if (std::ranges::find(known, wanted.back()) == known.end())
            refuse(option, text, "there is no '" + wanted.back() + "'; give all, or some of " + CLI::detail::join(known, ","));
    }
    std::ranges::copy_if(known, std::back_inserter(ordered),
                         [&](const std::string& name) { return std::ranges::find(wanted, name) != wanted.end(); });
    if (ordered.size() != wanted.size()) refuse(option, text, "a name comes twice; give each once");
    return ordered;
}

void refuse_choice(const std::string& option, const std::string& text, const std::vector<std::string>& choices) {
    refuse(option, text, "give one of " + CLI::detail::join(choices, ", "));
}

std::string show_number(float value) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

}  // namespace myriad::tools
