#include "scenes/gltf/draco.hpp"

#include "scenes/gltf/draco_mesh.hpp"

namespace myriad::scenes::gltf {
namespace {

// Attribute `name` for every point of the mesh; empty where the primitive has no such attribute.
template <class Vector>
std::vector<Vector> attribute(const Place& place, const draco::Mesh& mesh, const tinygltf::Value& ids, const char* name) {
    if (!ids.Has(name)) return {};
    const tinygltf::Value& id = ids.Get(name);
    const auto* found = id.IsInt() && id.Get<int>() >= 0 ? mesh.GetAttributeByUniqueId(uint32_t(id.Get<int>())) : nullptr;
    constexpr int components = Vector::length();
    if (!found || found->num_components() != components)
        place.fail(std::string("the compressed data has no usable ") + name, "compress the file again");
    place.spend(mesh.num_points(), sizeof(Vector));
    std::vector<Vector> out(mesh.num_points());
    for (draco::PointIndex p(0); p < mesh.num_points(); ++p)
        // Converts from the stored type, quantised integers included; false on an index outside of the attribute.
        if (!found->ConvertValue<float, components>(found->mapped_index(p), &out[p.value()].x))
            place.fail(std::string("the compressed ") + name + " cannot be converted", "compress the file again");
    return out;
}

}  // namespace

Primitive decode_draco(const Place& outer, const tinygltf::Value& extension) {
    const Place place = outer.at(draco_extension);
    if (!extension.IsObject() || !extension.Has("bufferView") || !extension.Get("bufferView").IsInt() || !extension.Has("attributes"))
        place.fail("bufferView or attributes are missing", "compress the file again");
    const Range range = buffer_view(place, extension.Get("bufferView").Get<int>());
    const std::unique_ptr<draco::Mesh> mesh = decode_draco_mesh(place, range);

    const tinygltf::Value& ids = extension.Get("attributes");
    Primitive out;
    out.positions = attribute<glm::vec3>(place, *mesh, ids, "POSITION");
    out.normals = attribute<glm::vec3>(place, *mesh, ids, "NORMAL");
    out.texcoords = attribute<glm::vec2>(place, *mesh, ids, "TEXCOORD_0");
    place.spend(mesh->num_faces(), 3 * sizeof(uint32_t));
    out.indices.reserve(size_t(mesh->num_faces()) * 3);
    for (draco::FaceIndex f(0); f < mesh->num_faces(); ++f)
        for (const auto& point : mesh->face(f)) out.indices.push_back(point.value());
    return out;
}

}  // namespace myriad::scenes::gltf
