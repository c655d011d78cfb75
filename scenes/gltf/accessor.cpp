#include "scenes/gltf/accessor.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include "engine/error.hpp"
#include "scenes/gltf/meshopt.hpp"

namespace myriad::scenes::gltf {
namespace {

using tinygltf::Accessor;

template <class T>
T load(const uint8_t* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

// glTF 2.0, 3.6.2.2: normalised integers map their range to [0, 1] or [-1, 1].
template <class T, bool normalized>
float component(const uint8_t* at) {
    const float value = float(load<T>(at));
    if constexpr (!normalized) return value;
    return std::max(value / float(std::numeric_limits<T>::max()), -1.0f);
}

using Component = float (*)(const uint8_t*);

template <class T>
Component integer_component(bool normalized) { return normalized ? component<T, true> : component<T, false>; }

// How to read a component of this type; null where glTF has no such type for what is not an index.
Component component_of(int type, bool normalized) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE: return integer_component<int8_t>(normalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return integer_component<uint8_t>(normalized);
        case TINYGLTF_COMPONENT_TYPE_SHORT: return integer_component<int16_t>(normalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return integer_component<uint16_t>(normalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return integer_component<uint32_t>(normalized);
        case TINYGLTF_COMPONENT_TYPE_FLOAT: return component<float, false>;
        default: return nullptr;
    }
}

size_t size_of(int type) { return size_t(tinygltf::GetComponentSizeInBytes(uint32_t(type))); }

uint32_t integer(const uint8_t* at, int type) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return *at;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return load<uint16_t>(at);
        default: return load<uint32_t>(at);
    }
}

bool is_index_type(int type) {
    return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
           type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

Elements elements(const Place& place, int view, size_t offset, size_t count, size_t element, size_t stride) {
    const Range range = buffer_view(place, view);
    if (stride == 0) stride = element;
    // Written so that no product or sum can wrap: all of it in terms of what is left of the view.
    const bool fits = count == 0 || (offset <= range.size && element <= range.size - offset &&
                                     (count - 1) <= (range.size - offset - element) / stride);
    if (!fits)
        place.fail("needs " + std::to_string(count) + " elements of " + std::to_string(element) + " bytes from byte " +
                       std::to_string(offset) + " on, but bufferView " + std::to_string(view) + " has only " +
                       std::to_string(range.size) + " bytes",
                   "export the file again");
    return {range.data + (count ? offset : 0), stride};
}

const Accessor& get(const Place& place, int index) {
    if (index < 0 || size_t(index) >= place.model.accessors.size())
        place.fail("there is no accessor " + std::to_string(index), "export the file again");
    return place.model.accessors[size_t(index)];
}

// The elements of an accessor's own buffer view; none where it has no view.
Elements base(const Place& place, const Accessor& accessor, size_t element) {
    if (accessor.bufferView < 0) return {};
    const auto& views = place.model.bufferViews;
    const size_t stride = size_t(accessor.bufferView) < views.size() ? views[size_t(accessor.bufferView)].byteStride : 0;
    return elements(place, accessor.bufferView, accessor.byteOffset, accessor.count, element, stride);
}

struct Sparse {
    Elements indices, values;
};

Sparse sparse(const Place& place, const Accessor& accessor, size_t element) {
    const auto& in = accessor.sparse;
    if (!in.isSparse) return {};
    if (in.count < 0 || size_t(in.count) > accessor.count || in.indices.byteOffset < 0 || in.values.byteOffset < 0 ||
        !is_index_type(in.indices.componentType))
        place.fail("the sparse part is malformed", "export the file again");
    return {elements(place, in.indices.bufferView, size_t(in.indices.byteOffset), size_t(in.count), size_of(in.indices.componentType), 0),
            elements(place, in.values.bufferView, size_t(in.values.byteOffset), size_t(in.count), element, 0)};
}

// Calls f(target, bytes) for each element that a sparse accessor replaces.
template <class F>
void each_replaced(const Place& place, const Accessor& accessor, const Elements& indices, const Elements& values, F&& f) {
    for (size_t i = 0; accessor.sparse.isSparse && i < size_t(accessor.sparse.count); ++i) {
        const size_t target = integer(indices.first + i * indices.stride, accessor.sparse.indices.componentType);
        if (target >= accessor.count) place.fail("sparse index " + std::to_string(target) + " is out of range", "export the file again");
        f(target, values.first + i * values.stride);
    }
}

}  // namespace

void Place::fail(const std::string& what, const std::string& cure) const {
    throw InputError(file + ": " + (where.empty() ? "" : where + ": ") + what + "; " + cure + ".");
}

void Place::spend(uint64_t count, uint64_t size) const {
    if (!document->budget.spend(count, size))
        fail("it asks for " + std::to_string(count) + " times " + std::to_string(size) + " bytes of memory, out of all proportion to the file",
             "the file is damaged or made to exhaust memory, export it again");
}

std::string shown(const std::string& text) {
    std::string out = text.substr(0, limits::shown_characters);
    for (char& c : out)
        if (static_cast<unsigned char>(c) < ' ' || c == 0x7f) c = '?';
    return out.size() < text.size() ? out + " …" : out;
}

std::string quote(const std::string& text) { return '"' + shown(text) + '"'; }

Range buffer_view(const Place& place, int index) {
    const auto& model = place.model;
    const std::string name = "bufferView " + std::to_string(index);
    if (index < 0 || size_t(index) >= model.bufferViews.size()) place.fail("there is no " + name, "export the file again");
    const auto& view = model.bufferViews[size_t(index)];
    if (const auto* compressed = extension(view, meshopt_extension)) return decode_meshopt(place.at(name), index, *compressed);
    const auto& buffers = place.document->buffers;
    if (view.buffer < 0 || size_t(view.buffer) >= buffers.size())
        place.fail(name + " refers to buffer " + std::to_string(view.buffer) + ", which does not exist", "export the file again");
    const Range& data = buffers[size_t(view.buffer)];
    if (view.byteOffset > data.size || view.byteLength > data.size - view.byteOffset)
        place.fail(name + " ends beyond buffer " + std::to_string(view.buffer) + ", which has " + std::to_string(data.size) + " bytes",
                   "the buffer is truncated, export or download it again");
    return {data.data + view.byteOffset, view.byteLength};
}

FloatReader::FloatReader(const Place& place, int index, int components)
    : place_(place), accessor_(get(place, index)), components_(tinygltf::GetNumComponentsInType(uint32_t(accessor_.type))),
      normalized_(accessor_.normalized) {
    if (components_ < 1 || (components && components_ != components))
        place_.fail("has " + std::to_string(components_) + " components an element where " + std::to_string(components) + " are expected",
                    "export the file again");
    if (!component_of(accessor_.componentType, false))
        place_.fail("has component type " + std::to_string(accessor_.componentType) + ", which glTF does not know", "export the file again");
    const size_t element = size_of(accessor_.componentType) * size_t(components_);
    base_ = base(place_, accessor_, element);
    const Sparse replaced = sparse(place_, accessor_, element);
    sparse_indices_ = replaced.indices;
    sparse_values_ = replaced.values;
    place_.spend(accessor_.count, sizeof(float) * size_t(std::max(components_, 4)));
}

void FloatReader::read(float* out) const {
    const size_t n = size_t(components_), size = size_of(accessor_.componentType);
    const Component component = component_of(accessor_.componentType, normalized_);
    const auto convert = [&](size_t target, const uint8_t* bytes) {
        for (size_t c = 0; c < n; ++c) out[target * n + c] = component(bytes + c * size);
    };
    if (!base_.first) std::fill_n(out, count() * n, 0.0f);
    else if (accessor_.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT)
        for (size_t i = 0; i < count(); ++i) std::memcpy(out + i * n, base_.first + i * base_.stride, n * sizeof(float));
    else
        for (size_t i = 0; i < count(); ++i) convert(i, base_.first + i * base_.stride);
    each_replaced(place_, accessor_, sparse_indices_, sparse_values_, convert);
}

std::vector<glm::vec4> read_colors(const Place& place, int index) {
    FloatReader reader(place, index, 0);
    const size_t n = size_t(reader.components());
    if (n != 3 && n != 4) place.fail("has " + std::to_string(n) + " components an element, not 3 or 4", "export the file again");
    reader.normalize();
    std::vector<glm::vec4> out(reader.count(), glm::vec4(1));
    if (out.empty()) return out;
    if (n == 4) {
        reader.read(&out[0].x);
        return out;
    }
    std::vector<float> rgb(3 * out.size());
    reader.read(rgb.data());
    for (size_t i = 0; i < out.size(); ++i) out[i] = glm::vec4(rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2], 1);
    return out;
}

std::vector<uint32_t> read_indices(const Place& place, int index) {
    const Accessor& accessor = get(place, index);
    const int type = accessor.componentType;
    if (accessor.type != TINYGLTF_TYPE_SCALAR || !is_index_type(type)) place.fail("are not unsigned integers", "export the file again");
    const Elements in = base(place, accessor, size_of(type));
    const Sparse replaced = sparse(place, accessor, size_of(type));
    place.spend(accessor.count, sizeof(uint32_t));
    std::vector<uint32_t> out(accessor.count, 0);
    for (size_t i = 0; in.first && i < out.size(); ++i) out[i] = integer(in.first + i * in.stride, type);
    each_replaced(place, accessor, replaced.indices, replaced.values,
                  [&](size_t target, const uint8_t* bytes) { out[target] = integer(bytes, type); });
    const uint32_t restart = uint32_t((uint64_t(1) << 8 * size_of(type)) - 1);
    if (std::find(out.begin(), out.end(), restart) != out.end())
        place.fail("hold " + std::to_string(restart) + ", which restarts a primitive and is no index in glTF", "export without primitive restart");
    return out;
}

}  // namespace myriad::scenes::gltf
