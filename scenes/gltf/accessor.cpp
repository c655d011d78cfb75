#include "scenes/gltf/accessor.hpp"

#include <algorithm>
#include <cstring>

#include "engine/error.hpp"

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
float component(const uint8_t* at, int type, bool normalized) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE: return normalized ? std::max(float(load<int8_t>(at)) / 127, -1.0f) : float(load<int8_t>(at));
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return float(*at) / (normalized ? 255.0f : 1.0f);
        case TINYGLTF_COMPONENT_TYPE_SHORT: return normalized ? std::max(float(load<int16_t>(at)) / 32767, -1.0f) : float(load<int16_t>(at));
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return float(load<uint16_t>(at)) / (normalized ? 65535.0f : 1.0f);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return float(load<uint32_t>(at));
        default: return load<float>(at);
    }
}

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

// Elements in a buffer view: `count` of `element` bytes each, `stride` apart, all inside.
struct Elements {
    const uint8_t* first = nullptr;
    size_t stride = 0;
};

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
    return {range.data + offset, stride};
}

const Accessor& get(const Place& place, int index) {
    if (index < 0 || size_t(index) >= place.model.accessors.size())
        place.fail("there is no accessor " + std::to_string(index), "export the file again");
    const Accessor& accessor = place.model.accessors[size_t(index)];
    return accessor;
}

// Overwrites the elements that a sparse accessor lists.
void apply_sparse(const Place& place, const Accessor& accessor, size_t element, size_t component_size, int components, std::vector<float>& out) {
    const auto& sparse = accessor.sparse;
    if (sparse.count < 0 || size_t(sparse.count) > accessor.count || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0 ||
        !is_index_type(sparse.indices.componentType))
        place.fail("the sparse part is malformed", "export the file again");
    const size_t count = size_t(sparse.count);
    const size_t index_size = size_t(tinygltf::GetComponentSizeInBytes(uint32_t(sparse.indices.componentType)));
    const Elements indices = elements(place, sparse.indices.bufferView, size_t(sparse.indices.byteOffset), count, index_size, 0);
    const Elements values = elements(place, sparse.values.bufferView, size_t(sparse.values.byteOffset), count, element, 0);
    for (size_t i = 0; i < count; ++i) {
        const size_t target = integer(indices.first + i * index_size, sparse.indices.componentType);
        if (target >= accessor.count) place.fail("sparse index " + std::to_string(target) + " is out of range", "export the file again");
        for (size_t c = 0; c < size_t(components); ++c)
            out[target * size_t(components) + c] =
                component(values.first + i * element + c * component_size, accessor.componentType, accessor.normalized);
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

std::string quote(const std::string& text) {
    std::string out = text.substr(0, limits::quoted_characters);
    for (char& c : out)
        if (static_cast<unsigned char>(c) < ' ' || c == 0x7f) c = '?';
    return '"' + out + (out.size() < text.size() ? " …\"" : "\"");
}

Range buffer_view(const Place& place, int index) {
    const auto& model = place.model;
    const std::string name = "bufferView " + std::to_string(index);
    if (index < 0 || size_t(index) >= model.bufferViews.size()) place.fail("there is no " + name, "export the file again");
    const auto& view = model.bufferViews[size_t(index)];
    const auto& buffers = place.document->buffers;
    if (view.buffer < 0 || size_t(view.buffer) >= buffers.size())
        place.fail(name + " refers to buffer " + std::to_string(view.buffer) + ", which does not exist", "export the file again");
    const Range& data = buffers[size_t(view.buffer)];
    if (view.byteOffset > data.size || view.byteLength > data.size - view.byteOffset)
        place.fail(name + " ends beyond buffer " + std::to_string(view.buffer) + ", which has " + std::to_string(data.size) + " bytes",
                   "the buffer is truncated, export or download it again");
    return {data.data + view.byteOffset, view.byteLength};
}

std::vector<float> read_floats(const Place& place, int index, int components) {
    const Accessor& accessor = get(place, index);
    const int has = tinygltf::GetNumComponentsInType(uint32_t(accessor.type));
    if (has != components)
        place.fail("has " + std::to_string(has) + " components an element where " + std::to_string(components) + " are expected",
                   "export the file again");
    const int size = tinygltf::GetComponentSizeInBytes(uint32_t(accessor.componentType));
    if (size <= 0 || size > 4 || accessor.componentType == TINYGLTF_COMPONENT_TYPE_INT)
        place.fail("has component type " + std::to_string(accessor.componentType) + ", which glTF does not know", "export the file again");
    const size_t component_size = size_t(size), element = component_size * size_t(components);

    std::vector<float> out;
    if (accessor.bufferView >= 0) {
        const size_t stride = size_t(accessor.bufferView) < place.model.bufferViews.size()
                                  ? place.model.bufferViews[size_t(accessor.bufferView)].byteStride : 0;
        const Elements in = elements(place, accessor.bufferView, accessor.byteOffset, accessor.count, element, stride);
        place.spend(accessor.count, sizeof(float) * size_t(components));
        out.reserve(accessor.count * size_t(components));
        for (size_t i = 0; i < accessor.count; ++i)
            for (size_t c = 0; c < size_t(components); ++c)
                out.push_back(component(in.first + i * in.stride + c * component_size, accessor.componentType, accessor.normalized));
    } else {  // zeros, for sparse data
        place.spend(accessor.count, sizeof(float) * size_t(components));
        out.resize(accessor.count * size_t(components));
    }
    if (accessor.sparse.isSparse) apply_sparse(place, accessor, element, component_size, components, out);
    return out;
}

std::vector<uint32_t> read_indices(const Place& place, int index) {
    const Accessor& accessor = get(place, index);
    if (accessor.type != TINYGLTF_TYPE_SCALAR || !is_index_type(accessor.componentType) || accessor.sparse.isSparse)
        place.fail("are not plain unsigned integers", "export the file again");
    const size_t size = size_t(tinygltf::GetComponentSizeInBytes(uint32_t(accessor.componentType)));
    const Elements in = elements(place, accessor.bufferView, accessor.byteOffset, accessor.count, size, 0);
    place.spend(accessor.count, sizeof(uint32_t));
    std::vector<uint32_t> out(accessor.count);
    for (size_t i = 0; i < out.size(); ++i) out[i] = integer(in.first + i * in.stride, accessor.componentType);
    return out;
}

}  // namespace myriad::scenes::gltf
