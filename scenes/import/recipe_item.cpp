#include "scenes/import/recipe_item.hpp"

#include <algorithm>
#include <cmath>

#include "engine/error.hpp"
#include "scenes/import/bytes.hpp"

namespace myriad::scenes::importing {
namespace {

using nlohmann::json;

constexpr size_t most_elements = 100000;  // of a list

std::string shown(double v) { return json(v).dump(); }

std::string listed(const std::vector<std::string>& names) {
    std::string out;
    for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
    return out;
}

}  // namespace

json read_json(const std::string& path) {
    constexpr uint64_t most_bytes = 16 << 20;
    const Bytes bytes = read_file(path, most_bytes);
    try {
        return json::parse(bytes.begin(), bytes.end(), nullptr, true, true);
    } catch (const json::exception& e) {  // a number of too many digits is no parse_error
        std::string what = e.what();
        for (const char* begin : {"at line", "number overflow"})
            if (const size_t at = what.find(begin); at != std::string::npos) what = what.substr(begin[0] == 'a' ? at + 3 : at);
        throw InputError(path + ": the JSON is damaged, " + what.substr(0, 200) + "; correct it.");
    }
}

Item::Item(const json& value, std::string place, std::initializer_list<const char*> keys) : json_(value), place_(std::move(place)) {
    if (!json_.is_object()) fail("it is not an object", "write { … }");
    for (const auto& [key, ignored] : json_.items())
        if (std::ranges::find(keys, std::string_view(key)) == keys.end())
            fail("\"" + key.substr(0, 60) + "\" is unknown", "known are " + listed({keys.begin(), keys.end()}));
    // A name makes the place easier to find.
    if (const json* name = find("name"); name && name->is_string()) place_ += " \"" + name->get<std::string>().substr(0, 60) + "\"";
}

void Item::fail(const std::string& what, const std::string& cure) const { throw InputError(place_ + ": " + what + "; " + cure + "."); }

const json* Item::find(const char* key) const {
    const auto it = json_.find(key);
    return it == json_.end() ? nullptr : &*it;
}

double Item::number(const char* key, double fallback, double least, double most) const {
    const json* value = find(key);
    if (!value) return fallback;
    const double v = value->is_number() ? value->get<double>() : NAN;
    if (!(v >= least && v <= most)) fail(std::string(key) + " is no number from " + shown(least) + " to " + shown(most), "correct it");
    return v;
}

std::vector<double> Item::numbers(const char* key, size_t least_count, size_t most_count, double least, double most) const {
    const json* value = find(key);
    if (!value) return {};
    std::vector<double> out;
    bool good = value->is_array() && value->size() >= least_count && value->size() <= most_count;
    if (good)
        for (const json& element : *value) {
            const double v = element.is_number() ? element.get<double>() : NAN;
            good &= v >= least && v <= most;
            out.push_back(v);
        }
    if (!good)
        fail(std::string(key) + " is not " + (least_count == most_count ? "" : std::to_string(least_count) + " to ") + std::to_string(most_count) +
                 " numbers from " + shown(least) + " to " + shown(most), "correct it");
    return out;
}

glm::dvec3 Item::vector(const char* key, const glm::dvec3& fallback, double least, double most) const {
    const std::vector<double> v = numbers(key, 3, 3, least, most);
    return v.empty() ? fallback : glm::dvec3(v[0], v[1], v[2]);
}

std::string Item::text(const char* key, const std::string& fallback) const {
    const json* value = find(key);
    if (!value) return fallback;
    if (!value->is_string()) fail(std::string(key) + " is no text", "put it in quotes");
    return value->get<std::string>();
}

std::string Item::required(const char* key) const {
    if (!has(key)) fail(std::string("there is no ") + key, "give it one");
    return text(key, "");
}

bool Item::flag(const char* key, bool fallback) const {
    const json* value = find(key);
    if (value && !value->is_boolean()) fail(std::string(key) + " is neither true nor false", "correct it");
    return value ? value->get<bool>() : fallback;
}

std::vector<std::string> Item::texts(const char* key) const {
    std::vector<std::string> out;
    const json* value = find(key);
    if (!value) return out;
    bool good = value->is_array() && value->size() <= most_elements;
    if (good)
        for (const json& element : *value) {
            good &= element.is_string();
            if (element.is_string()) out.push_back(element.get<std::string>());
        }
    if (!good) fail(std::string(key) + " is no list of texts", "write [\"…\", \"…\"]");
    return out;
}

size_t Item::choice(const char* key, const std::vector<std::string>& choices, size_t fallback) const {
    if (!has(key)) return fallback;
    const auto it = std::ranges::find(choices, text(key, ""));
    if (it == choices.end()) fail(std::string(key) + " is \"" + text(key, "").substr(0, 60) + "\"", "give one of " + listed(choices));
    return size_t(it - choices.begin());
}

void Item::each(const char* key, const std::function<void(const json&, const std::string&)>& action) const {
    const json* value = find(key);
    if (!value) return;
    if (!value->is_array() || value->size() > most_elements) fail(std::string(key) + " is no list", "write [ … ], of at most 100,000");
    for (size_t i = 0; i < value->size(); ++i) action((*value)[i], place_ + " " + key + "[" + std::to_string(i) + "]");
}

void Item::members(const char* key, const std::function<void(const std::string&, const json&, const std::string&)>& action) const {
    const json* value = find(key);
    if (!value) return;
    if (!value->is_object()) fail(std::string(key) + " is no object", "write { \"name\": … }");
    for (const auto& [name, member] : value->items()) action(name, member, place_ + " " + key + " \"" + name.substr(0, 60) + "\"");
}

}  // namespace myriad::scenes::importing
