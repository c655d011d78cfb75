#include "scenes/gltf/meshopt.hpp"

#include <meshoptimizer.h>

namespace myriad::scenes::gltf {
namespace {

struct Compressed {
    Range bytes;
    size_t count = 0, stride = 0;
    std::string mode, filter;
};

std::string text_in(const Place& place, const tinygltf::Value& object, const char* key, const char* fallback) {
    if (!object.Has(key)) return fallback;
    if (!object.Get(key).IsString()) place.fail(std::string(key) + " is not a text", "compress the file again");
    return object.Get(key).Get<std::string>();
}

size_t required(const Place& place, const tinygltf::Value& object, const char* key) {
    const std::optional<int> value = index_in(place, object, key);
    if (!value) place.fail(std::string(key) + " is missing", "compress the file again");
    return size_t(*value);
}

Compressed read(const Place& place, const tinygltf::Value& in) {
    Compressed out;
    const size_t buffer = required(place, in, "buffer"), offset = size_t(index_in(place, in, "byteOffset").value_or(0));
    const auto& buffers = place.document->buffers;
    if (buffer >= buffers.size()) place.fail("there is no buffer " + std::to_string(buffer), "compress the file again");
    out.bytes.size = required(place, in, "byteLength");
    if (offset > buffers[buffer].size || out.bytes.size > buffers[buffer].size - offset)
        place.fail("it ends beyond buffer " + std::to_string(buffer) + ", which has " + std::to_string(buffers[buffer].size) + " bytes",
                   "the buffer is truncated, export or download it again");
    out.bytes.data = buffers[buffer].data + offset;
    out.count = required(place, in, "count");
    out.stride = required(place, in, "byteStride");
    out.mode = text_in(place, in, "mode", "");
    out.filter = text_in(place, in, "filter", "NONE");
    return out;
}

// What the extension allows, and the library takes for granted.
bool sound(const Compressed& in) {
    const size_t stride = in.stride;
    if (in.mode == "TRIANGLES" || in.mode == "INDICES")
        return (stride == 2 || stride == 4) && in.filter == "NONE" && (in.mode == "INDICES" || in.count % 3 == 0);
    if (in.mode != "ATTRIBUTES" || stride == 0 || stride > 256 || stride % 4) return false;
    return in.filter == "NONE" || in.filter == "EXPONENTIAL" || (in.filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) ||
           (in.filter == "QUATERNION" && stride == 8);
}

bool decode(const Compressed& in, uint8_t* out) {
    if (in.mode == "TRIANGLES") return meshopt_decodeIndexBuffer(out, in.count, in.stride, in.bytes.data, in.bytes.size) == 0;
    if (in.mode == "INDICES") return meshopt_decodeIndexSequence(out, in.count, in.stride, in.bytes.data, in.bytes.size) == 0;
    if (meshopt_decodeVertexBuffer(out, in.count, in.stride, in.bytes.data, in.bytes.size) != 0) return false;
    if (in.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out, in.count, in.stride);
    if (in.filter == "QUATERNION") meshopt_decodeFilterQuat(out, in.count, in.stride);
    if (in.filter == "EXPONENTIAL") meshopt_decodeFilterExp(out, in.count, in.stride);
    return true;
}

}  // namespace

Range decode_meshopt(const Place& outer, int index, const tinygltf::Value& extension) {
    Document& document = *outer.document;
    if (const auto known = document.decoded.find(index); known != document.decoded.end()) return known->second;
    const Place place = outer.at(meshopt_extension);
    const Compressed in = read(place, extension);
    if (!sound(in))
        place.fail("mode " + quote(in.mode) + ", filter " + quote(in.filter) + ", stride " + std::to_string(in.stride) + " and count " +
                       std::to_string(in.count) + " do not go together",
                   "compress the file again");
    if (place.model.bufferViews[size_t(index)].byteLength != in.count * in.stride)
        place.fail("its " + std::to_string(in.count) + " elements of " + std::to_string(in.stride) + " bytes do not fill the buffer view",
                   "compress the file again");
    place.spend(in.count, in.stride);
    Bytes& bytes = document.owned.emplace_back(in.count * in.stride);
    if (in.count && !decode(in, bytes.data())) place.fail("the data cannot be decoded", "compress the file again");
    return document.decoded[index] = {bytes.data(), bytes.size()};
}

}  // namespace myriad::scenes::gltf
