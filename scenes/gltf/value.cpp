#include "scenes/gltf/value.hpp"

#include <cmath>

namespace myriad::scenes::gltf {

double number_in(const Place& place, const tinygltf::Value& object, const char* key, double fallback) {
    if (!object.Has(key)) return fallback;
    const tinygltf::Value& value = object.Get(key);
    if (!value.IsNumber() || !std::isfinite(value.GetNumberAsDouble())) place.fail(std::string(key) + " is not a number", "correct it");
    return value.GetNumberAsDouble();
}

std::optional<int> index_in(const Place& place, const tinygltf::Value& object, const char* key) {
    if (!object.Has(key)) return {};
    const double value = number_in(place, object, key, -1);
    if (value < 0 || value > 0x7fffffff || value != std::floor(value)) place.fail(std::string(key) + " is not an index", "correct it");
    return int(value);
}

glm::dvec2 pair_in(const Place& place, const tinygltf::Value& object, const char* key, const glm::dvec2& fallback) {
    if (!object.Has(key)) return fallback;
    const tinygltf::Value& array = object.Get(key);
    glm::dvec2 out(0);
    bool good = array.IsArray() && array.ArrayLen() == 2;
    for (int i = 0; i < 2 && good; ++i) {
        good = array.Get(i).IsNumber() && std::isfinite(array.Get(i).GetNumberAsDouble());
        if (good) out[i] = array.Get(i).GetNumberAsDouble();
    }
    if (!good) place.fail(std::string(key) + " is not two numbers", "correct it");
    return out;
}

}  // namespace myriad::scenes::gltf
