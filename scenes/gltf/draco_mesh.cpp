#include "scenes/gltf/draco_mesh.hpp"

#include <exception>
#include <type_traits>
#include <utility>

#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>

#include "engine/error.hpp"

namespace myriad::scenes::gltf {
namespace {

// What a decoder holds for each face and vertex while it works: corner tables, marks, the order of traversal; and a corner
// table more for each set of attributes with seams of its own.
constexpr uint64_t bytes_per_face = 64, bytes_per_vertex = 64, bytes_per_face_and_set = 32;

// A Draco decoder that asks the budget before it allocates: Draco takes the counts in a stream at their word, and a
// kilobyte can claim 2^30 faces, or attributes of 255 doubles for each of its vertices.
template <class Decoder>
class Guarded final : public Decoder {
public:
    explicit Guarded(const Place& place) : place_(place) {}

private:
    bool DecodeConnectivity() override {
        draco::DecoderBuffer ahead = *this->buffer();  // a copy: reading from it moves nothing
        uint32_t faces = 0, vertices = 0;
        uint8_t sets = 0;
        if constexpr (std::is_same_v<Decoder, draco::MeshEdgebreakerDecoder>) {
            if (!draco::DecodeVarint(&vertices, &ahead) || !draco::DecodeVarint(&faces, &ahead) || !ahead.Decode(&sets)) return false;
            place_.spend(faces, bytes_per_vertex);  // where a traversal splits it makes a vertex, at most one a face
        } else if (!draco::DecodeVarint(&faces, &ahead) || !draco::DecodeVarint(&vertices, &ahead)) {
            return false;
        }
        place_.spend(vertices, bytes_per_vertex);
        place_.spend(faces, bytes_per_face + sets * bytes_per_face_and_set);
        return Decoder::DecodeConnectivity();
    }

    bool DecodeAllAttributes() override {
        const auto& cloud = *this->point_cloud();
        for (int i = 0; i < cloud.num_attributes(); ++i)  // as it is wanted, as it is stored, and a prediction
            place_.spend(cloud.num_points(), uint64_t(cloud.attribute(i)->byte_stride()) + 8ull * cloud.attribute(i)->num_components());
        return Decoder::DecodeAllAttributes();
    }

    const Place& place_;
};

// Fills the mesh; or returns why it cannot.
std::string decode(const Place& place, Range bytes, draco::Mesh& mesh) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data), bytes.size);
    draco::DracoHeader header;
    draco::DecoderBuffer ahead = buffer;
    if (const draco::Status status = draco::PointCloudDecoder::DecodeHeader(&ahead, &header); !status.ok()) return status.error_msg_string();
    if (header.encoder_type != draco::TRIANGULAR_MESH) return "it is no mesh";
    if (std::pair(header.version_major, header.version_minor) < std::pair<uint8_t, uint8_t>(2, 2)) return "it is older than Draco 2.2, which glTF asks for";
    const auto run = [&](auto&& decoder) { return decoder.Decode({}, &buffer, &mesh).error_msg_string(); };
    switch (header.encoder_method) {
        case draco::MESH_SEQUENTIAL_ENCODING: return run(Guarded<draco::MeshSequentialDecoder>(place));
        case draco::MESH_EDGEBREAKER_ENCODING: return run(Guarded<draco::MeshEdgebreakerDecoder>(place));
        default: return "its encoding is unknown";
    }
}

}  // namespace

std::unique_ptr<draco::Mesh> decode_draco_mesh(const Place& place, Range bytes) {
    auto mesh = std::make_unique<draco::Mesh>();
    std::string problem;
    try {
        problem = decode(place, bytes, *mesh);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& e) {  // a damaged stream can still ask for any amount of memory
        problem = e.what();
    }
    if (!problem.empty()) place.fail("the data cannot be decoded (" + problem + ")", "compress the file again");
    return mesh;
}

}  // namespace myriad::scenes::gltf
