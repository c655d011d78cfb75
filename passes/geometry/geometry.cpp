#include "passes/geometry/geometry.hpp"

#include <map>

#include "engine/transfer.hpp"

namespace myriad::passes {
namespace {

// Appends each texture that a material refers to, once.
class TexelPacker {
public:
    TexelPacker(const scenes::Scene& scene, std::vector<uint>& texels) : scene_(scene), texels_(texels) {}

    TextureRef operator()(uint32_t index) {
        if (index == scenes::none || scene_.textures[index].rgba.empty()) return {};
        if (const auto known = packed_.find(index); known != packed_.end()) return known->second;
        if (texels_.empty())
            for (uint code = 0; code < srgb_table_size; ++code) texels_.push_back(floatBitsToUint(float(srgb_to_linear(uint8_t(code)))));
        const scenes::Texture& texture = scene_.textures[index];
        const uint64_t count = uint64_t(texture.width) * texture.height;
        if (texels_.size() + count > scenes::none) throw InputError(scene_.name + ": its textures have more than 2^32 texels; make them smaller.");
        const TextureRef ref{uint(texels_.size()), texture.width, texture.height, uint(texture.wrap_u) | uint(texture.wrap_v) << 2};
        for (uint64_t i = 0; i < count; ++i) {
            const uint8_t* c = &texture.rgba[4 * i];
            texels_.push_back(c[0] | uint(c[1]) << 8 | uint(c[2]) << 16 | uint(c[3]) << 24);
        }
        return packed_[index] = ref;
    }

private:
    const scenes::Scene& scene_;
    std::vector<uint>& texels_;
    std::map<uint32_t, TextureRef> packed_;
};

}  // namespace

double srgb_to_linear(uint8_t code) {
    const double c = code / 255.0;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

compute::WorldTriangles world_triangles(const scenes::Triangles& triangles) {
    compute::WorldTriangles world{triangles.positions, triangles.triangles};
    world.instances.reserve(triangles.placements.size());
    for (const scenes::Placement& p : triangles.placements) {
        const bool mirrored = glm::determinant(glm::dmat3(p.to_world)) < 0;
        world.instances.push_back({vec3(p.to_world[0]), vec3(p.to_world[1]), vec3(p.to_world[2]), vec3(p.to_world[3]), p.first_id,
                                   p.first_triangle, p.count, (p.in_world ? instance_in_world : 0) | (mirrored ? instance_mirrored : 0)});
    }
    return world;
}

GeometryData geometry_data(const scenes::Scene& scene, const scenes::Triangles& triangles) {
    GeometryData data;
    data.attributes.resize(triangles.positions.size());
    for (size_t i = 0; i < data.attributes.size(); ++i) data.attributes[i] = {triangles.normals[i], triangles.texcoords[i]};
    TexelPacker pack(scene, data.texels);
    for (const scenes::Material& m : scene.materials)
        data.materials.push_back({.base_color = m.base_color,
                                  .emission = m.emissive,
                                  .metallic = m.metallic,
                                  .base_color_texture = pack(m.base_color_texture.texture),
                                  .metallic_texture = pack(m.metallic_roughness_texture.texture),
                                  .emission_texture = m.emissive == vec3(0) ? TextureRef{} : pack(m.emissive_texture.texture),
                                  .double_sided = m.double_sided});
    return data;
}

Geometry::Geometry(engine::Device& device, const scenes::Scene& scene, const scenes::Triangles& triangles)
    : Geometry(device, triangles, geometry_data(scene, triangles)) {}

Geometry::Geometry(engine::Device& device, const scenes::Triangles& triangles, const GeometryData& data)
    : positions_(engine::upload(device, "scene", "vertex positions", triangles.positions)),
      triangles_(engine::upload(device, "scene", "triangles", triangles.triangles)),
      instances_(engine::upload(device, "scene", "instances", world_triangles(triangles).instances)),
      attributes_(engine::upload(device, "scene", "vertex attributes", data.attributes)),
      materials_(engine::upload(device, "scene", "materials", data.materials)),
      texels_(engine::upload(device, "scene", "texels", data.texels)) {
    engine::Recorder addresses(device);
    arrays_ = engine::upload(device, "scene", "geometry arrays", std::vector<GeometryArrays>{read_arrays(addresses)});
}

GeometryArrays Geometry::read_arrays(engine::Recorder& recorder) const {
    return {.positions = recorder.read(positions_),
            .triangles = recorder.read(triangles_),
            .attributes = recorder.read(attributes_),
            .materials = recorder.read(materials_),
            .instances = instances() ? recorder.read(instances_) : Instances{},
            .texels = recorder.read(texels_),
            .instance_count = uint(instances_.count()),
            .padding = 0};
}

GeometryRef Geometry::read(engine::Recorder& recorder) const {
    read_arrays(recorder);  // kernels find these addresses in memory: they are declared all the same
    return recorder.read(arrays_);
}

}  // namespace myriad::passes
