#include "scenes/gltf/draco.hpp"

#include <algorithm>

#include "scenes/gltf/draco_mesh.hpp"

namespace myriad::scenes::gltf {
namespace {

// What a stored integer stands for: the accessor says so, for encoders leave Draco's own flag unset.
float unit_of(const Place& place, const tinygltf::Primitive& primitive, const char* name, bool always) {
    const auto it = primitive.attributes.find(name);
    if (it == primitive.attributes.end() || it->second < 0 || size_t(it->second) >= place.model.accessors.size()) return 1;
    const auto& accessor = place.model.accessors[size_t(it->second)];
    if (!accessor.normalized && !always) return 1;
    switch (accessor.componentType) {
        case TINYGLTF_COMPONENT_TYPE_BYTE: return 127;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return 255;
        case TINYGLTF_COMPONENT_TYPE_SHORT: return 32767;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return 65535;
        default: return 1;
    }
}

class Attributes {
public:
    Attributes(const Place& place, const tinygltf::Primitive& primitive, const tinygltf::Value& ids, const draco::Mesh& mesh)
        : place_(place), primitive_(primitive), ids_(ids), mesh_(mesh) {}

    // Attribute `name` for every point of the mesh, with the components from `least` on that it has; empty where the
    // primitive has no such attribute. One that is not in the compressed data is stored as usual.
    template <int n>
    std::vector<glm::vec<n, float>> read(const char* name, int least = n, bool normalized = false) const {
        if (!ids_.Has(name)) {
            const auto it = primitive_.attributes.find(name);
            if (it == primitive_.attributes.end()) return {};
            if constexpr (n == 4)
                if (least == 3) return read_colors(place_.at(name), it->second);
            return read_vectors<n>(place_.at(name), it->second);
        }
        const tinygltf::Value& id = ids_.Get(name);
        const auto* found = id.IsInt() && id.Get<int>() >= 0 ? mesh_.GetAttributeByUniqueId(uint32_t(id.Get<int>())) : nullptr;
        if (!found || found->num_components() < least || found->num_components() > n)
            place_.fail(std::string("the compressed data has no usable ") + name, "compress the file again");
        const float unit = found->normalized() || found->data_type() == draco::DT_FLOAT32 ? 1 : unit_of(place_, primitive_, name, normalized);
        place_.spend(mesh_.num_points(), n * sizeof(float));
        std::vector<glm::vec<n, float>> out(mesh_.num_points(), glm::vec<n, float>(1));
        for (draco::PointIndex p(0); p < mesh_.num_points(); ++p) {
            auto& value = out[p.value()];
            // Converts from the stored type, quantised floats included; false on an index outside of the attribute.
            if (!found->ConvertValue<float>(found->mapped_index(p), found->num_components(), &value.x))
                place_.fail(std::string("the compressed ") + name + " cannot be converted", "compress the file again");
            if (unit != 1)
                for (int c = 0; c < found->num_components(); ++c) value[c] = std::max(value[c] / unit, -1.0f);
        }
        return out;
    }

private:
    const Place& place_;
    const tinygltf::Primitive& primitive_;
    const tinygltf::Value& ids_;
    const draco::Mesh& mesh_;
};

}  // namespace

Primitive decode_draco(const Place& outer, const tinygltf::Primitive& primitive, const tinygltf::Value& extension, JointSets* joints) {
    const Place place = outer.at(draco_extension);
    if (!extension.IsObject() || !extension.Has("bufferView") || !extension.Get("bufferView").IsInt() || !extension.Has("attributes"))
        place.fail("bufferView or attributes are missing", "compress the file again");
    const Range range = buffer_view(place, extension.Get("bufferView").Get<int>());
    const std::unique_ptr<draco::Mesh> mesh = decode_draco_mesh(place, range);
    const Attributes attributes(place, primitive, extension.Get("attributes"), *mesh);
    Primitive out;
    out.positions = attributes.read<3>("POSITION");
    out.normals = attributes.read<3>("NORMAL");
    out.tangents = attributes.read<4>("TANGENT");
    out.texcoords = attributes.read<2>("TEXCOORD_0");
    out.texcoords1 = attributes.read<2>("TEXCOORD_1");
    out.colors = attributes.read<4>("COLOR_0", 3, true);
    for (size_t set = 0; joints && set < joints->size(); ++set) {
        (*joints)[set].joints = attributes.read<4>(("JOINTS_" + std::to_string(set)).c_str());
        (*joints)[set].weights = attributes.read<4>(("WEIGHTS_" + std::to_string(set)).c_str(), 4, true);
    }
    place.spend(mesh->num_faces(), 3 * sizeof(uint32_t));
    out.indices.reserve(size_t(mesh->num_faces()) * 3);
    for (draco::FaceIndex f(0); f < mesh->num_faces(); ++f)
        for (const auto& point : mesh->face(f)) out.indices.push_back(point.value());
    return out;
}

}  // namespace myriad::scenes::gltf
