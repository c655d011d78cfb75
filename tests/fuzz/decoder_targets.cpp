#include <iterator>

#include "engine/error.hpp"
#include "scenes/gltf/draco_mesh.hpp"
#include "scenes/gltf/image.hpp"
#include "scenes/gltf/meshopt.hpp"
#include "tests/fuzz/targets.hpp"

namespace myriad::fuzz {
namespace {

// Runs a decoder on bytes that are all that its file brings.
template <class Decoder>
void decode(size_t size, const Decoder& decoder) {
    scenes::gltf::Document document;
    document.budget.earn(size);
    const scenes::gltf::Place place{document.model, "fuzz", "input", &document};
    try {
        decoder(place);
    } catch (const Error&) {
    }
}

}  // namespace

void picture(const uint8_t* data, size_t size) {
    decode(size, [&](const scenes::gltf::Place& place) { scenes::gltf::decode_picture(place, {data, size}); });
}

void draco(const uint8_t* data, size_t size) {
    decode(size, [&](const scenes::gltf::Place& place) { scenes::gltf::decode_draco_mesh(place, {data, size}); });
}

void meshopt(const uint8_t* data, size_t size) {
    if (size < 5) return;
    const char *const modes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"}, *const filters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};
    const int stride = data[2], count = data[3] + 256 * data[4], length = int(size - 5);
    using tinygltf::Value;
    const Value extension(Value::Object{{"buffer", Value(0)}, {"byteLength", Value(length)}, {"byteStride", Value(stride)}, {"count", Value(count)},
                                        {"mode", Value(std::string(modes[data[0] % std::size(modes)]))},
                                        {"filter", Value(std::string(filters[data[1] % std::size(filters)]))}});
    decode(size, [&](const scenes::gltf::Place& place) {
        place.document->buffers.push_back({data + 5, size_t(length)});
        place.document->model.bufferViews.emplace_back().byteLength = size_t(stride) * size_t(count);
        scenes::gltf::decode_meshopt(place, 0, extension);
    });
}

}  // namespace myriad::fuzz
