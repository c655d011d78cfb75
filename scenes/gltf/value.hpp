// Reading the JSON of extensions, every type checked.
#pragma once

#include <optional>

#include "scenes/gltf/accessor.hpp"

namespace myriad::scenes::gltf {

// Extension `name` of whatever has extensions; null where it has no such one.
template <class Extensible>
const tinygltf::Value* extension(const Extensible& from, const char* name) {
    const auto it = from.extensions.find(name);
    return it == from.extensions.end() ? nullptr : &it->second;
}

// A finite number, `fallback` where it is absent.
double number_in(const Place& place, const tinygltf::Value& object, const char* key, double fallback);

// A whole number from 0 on, nothing where it is absent.
std::optional<int> index_in(const Place& place, const tinygltf::Value& object, const char* key);

// Two finite numbers, `fallback` where they are absent.
glm::dvec2 pair_in(const Place& place, const tinygltf::Value& object, const char* key, const glm::dvec2& fallback);

}  // namespace myriad::scenes::gltf
