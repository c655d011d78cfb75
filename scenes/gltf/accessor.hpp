// Reading accessors, every range checked before the first byte is read.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "scenes/gltf/container.hpp"

namespace myriad::scenes::gltf {

// A model, the file it came from, and where in it we are: what each message starts with.
struct Place {
    const tinygltf::Model& model;
    std::string file, where;
    Document* document;

    Place at(const std::string& inner) const { return {model, file, where.empty() ? inner : where + " " + inner, document}; }
    // Throws InputError: "FILE: WHERE: WHAT; CURE."
    [[noreturn]] void fail(const std::string& what, const std::string& cure) const;
    // Before count * size bytes are decoded: fails where they are more than a file like this may ask for (limits.hpp).
    void spend(uint64_t count, uint64_t size) const;
};

// Text of the file's own, fit for a message: in quotes, shortened, without control characters.
std::string quote(const std::string& text);

// The bytes of a buffer view.
Range buffer_view(const Place& place, int index);

// Accessor `index` as `components` floats an element, whatever it is stored as: float, integers, normalised integers,
// strided, sparse.
std::vector<float> read_floats(const Place& place, int index, int components);

// Accessor `index` as indices.
std::vector<uint32_t> read_indices(const Place& place, int index);

}  // namespace myriad::scenes::gltf
