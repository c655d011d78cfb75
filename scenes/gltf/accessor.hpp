// Reading accessors, every range checked before the first byte is read.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <tiny_gltf.h>

namespace myriad::scenes::gltf {

// A model, the file it came from, and where in it we are: what each message starts with.
struct Place {
    const tinygltf::Model& model;
    std::string file, where;

    Place at(const std::string& inner) const { return {model, file, where.empty() ? inner : where + " " + inner}; }
    // Throws InputError: "FILE: WHERE: WHAT; CURE."
    [[noreturn]] void fail(const std::string& what, const std::string& cure) const;
};

struct Range {
    const uint8_t* data = nullptr;
    size_t size = 0;
};

// The bytes of a buffer view.
Range buffer_view(const Place& place, int index);

// Accessor `index` as `components` floats an element, whatever it is stored as: float, integers, normalised integers,
// strided, sparse.
std::vector<float> read_floats(const Place& place, int index, int components);

// Accessor `index` as indices.
std::vector<uint32_t> read_indices(const Place& place, int index);

}  // namespace myriad::scenes::gltf
