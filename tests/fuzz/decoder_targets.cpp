#include "engine/error.hpp"
#include "scenes/gltf/draco_mesh.hpp"
#include "scenes/gltf/image.hpp"
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

}  // namespace myriad::fuzz
