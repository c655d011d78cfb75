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

// Text of the file's own, fit for a message: shortened, without control characters; and the same in quotes.
std::string shown(const std::string& text);
std::string quote(const std::string& text);

// The bytes of a buffer view.
Range buffer_view(const Place& place, int index);

// Elements in a buffer view, `stride` bytes apart, all of them inside of it.
struct Elements {
    const uint8_t* first = nullptr;
    size_t stride = 0;
};

// An accessor of floats, whatever it is stored as: float, integers, normalised integers, strided, sparse.
class FloatReader {
public:
    // Checks every range that read() will touch. `components` an element must be what the accessor has; 0: any number.
    FloatReader(const Place& place, int accessor, int components);

    size_t count() const { return accessor_.count; }
    int components() const { return components_; }
    // Integers that are not marked as normalised are read as if they were.
    void normalize() { normalized_ = true; }
    // Writes count() * components() floats.
    void read(float* out) const;

private:
    const Place place_;
    const tinygltf::Accessor& accessor_;
    int components_ = 0;
    bool normalized_ = false;
    Elements base_, sparse_indices_, sparse_values_;  // no base: zeros
};

// Accessor `index` as vectors.
template <int n>
std::vector<glm::vec<n, float>> read_vectors(const Place& place, int index) {
    const FloatReader reader(place, index, n);
    std::vector<glm::vec<n, float>> out(reader.count());
    if (!out.empty()) reader.read(&out[0].x);
    return out;
}

// Accessor `index` as linear colours with alpha, stored with or without it. Integers are always read as normalised: nothing
// else makes sense of them.
std::vector<glm::vec4> read_colors(const Place& place, int index);

// Accessor `index` as indices.
std::vector<uint32_t> read_indices(const Place& place, int index);

}  // namespace myriad::scenes::gltf
