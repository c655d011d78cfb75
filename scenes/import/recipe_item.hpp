// A JSON object of a recipe, read strictly: what is wrong is told with its place, and what is unknown is refused.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

namespace myriad::scenes::importing {

// A JSON file of up to 16 MiB, comments allowed. InputError where it is none.
nlohmann::json read_json(const std::string& path);

class Item {
public:
    // `json` must be an object and have no other keys than these. It must outlive the item.
    Item(const nlohmann::json& json, std::string place, std::initializer_list<const char*> keys);

    [[noreturn]] void fail(const std::string& what, const std::string& cure) const;
    bool has(const char* key) const { return json_.contains(key); }
    const std::string& place() const { return place_; }
    std::string place_of(const char* key) const { return place_ + " " + key; }

    // Each fails where the value is not of its kind; `fallback` where there is none.
    double number(const char* key, double fallback, double least, double most) const;
    glm::dvec3 vector(const char* key, const glm::dvec3& fallback, double least = -1e9, double most = 1e9) const;
    std::vector<double> numbers(const char* key, size_t least_count, size_t most_count, double least, double most) const;
    std::string text(const char* key, const std::string& fallback) const;
    std::string required(const char* key) const;
    bool flag(const char* key, bool fallback) const;
    std::vector<std::string> texts(const char* key) const;
    size_t choice(const char* key, const std::vector<std::string>& choices, size_t fallback) const;

    // The value of a key that there is.
    const nlohmann::json& value(const char* key) const { return json_.at(key); }
    // The elements of an array; the members of an object. None where there is no such key.
    void each(const char* key, const std::function<void(const nlohmann::json&, const std::string& place)>& action) const;
    void members(const char* key, const std::function<void(const std::string& name, const nlohmann::json&, const std::string& place)>& action) const;

private:
    const nlohmann::json* find(const char* key) const;

    const nlohmann::json& json_;
    std::string place_;
};

}  // namespace myriad::scenes::importing
