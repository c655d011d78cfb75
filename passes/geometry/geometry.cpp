#include "passes/geometry/geometry.hpp"

#include <map>

#include "engine/transfer.hpp"

namespace myriad::passes {
namespace {

// Appends each texture that a material refers to, once, and each use of one.
class TexturePacker {
public:
    TexturePacker(const scenes::Scene& scene, const scenes::Triangles& triangles, GeometryData& data)
        : scene_(scene), sets_(triangles.texcoords1.empty() ? 1 : 2), data_(data) {}

    // Width 0 where there is no texture.
    TextureRef ref(const scenes::TextureUse& use) {
        if (use.texture == scenes::none || scene_.textures[use.texture].rgba.empty()) return {};
        const scenes::Texture& texture = scene_.textures[use.texture];
        const uint set = std::min(use.set, sets_ - 1);
        data_.on_set[set] = true;
        return {.first = first_texel(use.texture),
                .width = texture.width,
                .height = texture.height,
                .use = uint(texture.wrap_u) | uint(texture.wrap_v) << 2 | set << 4,
                .along_u = use.transform[0],
                .along_v = use.transform[1],
                .origin = use.transform[2]};
    }
    // Its index among the uses.
    uint index(const scenes::TextureUse& use) {
        const TextureRef r = ref(use);
        if (r.width == 0) return no_texture;
        data_.textures.push_back(r);
        return uint(data_.textures.size() - 1);
    }

private:
    uint first_texel(uint32_t index) {
        if (const auto known = packed_.find(index); known != packed_.end()) return known->second;
        std::vector<uint>& texels = data_.texels;
        if (texels.empty())
            for (uint code = 0; code < srgb_table_size; ++code) texels.push_back(floatBitsToUint(float(srgb_to_linear(uint8_t(code)))));
        const scenes::Texture& texture = scene_.textures[index];
        const uint64_t count = uint64_t(texture.width) * texture.height;
        if (texels.size() + count > scenes::none) throw InputError(scene_.name + ": its textures have more than 2^32 texels; make them smaller.");
        const uint first = packed_[index] = uint(texels.size());
        texels.resize(first + count);  // grows by doubling: to reserve just enough for each texture would copy all that came before it
        for (uint64_t i = 0; i < count; ++i) {
            const uint8_t* c = &texture.rgba[4 * i];
            texels[first + i] = c[0] | uint(c[1]) << 8 | uint(c[2]) << 16 | uint(c[3]) << 24;
        }
        return first;
    }

    const scenes::Scene& scene_;
    uint sets_;  // of texture coordinates that there are
    GeometryData& data_;
    std::map<uint32_t, uint> packed_;
};

Material material(const scenes::Material& m, TexturePacker& pack, const std::vector<TextureRef>& textures) {
    const bool shines = !m.unlit && m.emissive != vec3(0);
    Material out{.base_color = vec3(m.base_color),
                 .metallic = m.metallic,
                 .roughness = m.roughness,
                 .emission = m.unlit ? vec3(0) : m.emissive,
                 .normal_scale = m.normal_scale,
                 .flags = (m.double_sided ? material_double_sided : 0) | (m.unlit ? material_unlit : 0),
                 .base_color_texture = pack.index(m.base_color_texture),
                 .metallic_texture = m.unlit ? no_texture : pack.index(m.metallic_roughness_texture),
                 .emission_texture = shines ? pack.index(m.emissive_texture) : no_texture,
                 .normal_texture = m.unlit ? no_texture : pack.index(m.normal_texture)};
    for (uint index : {out.base_color_texture, out.metallic_texture, out.emission_texture, out.normal_texture})
        if (index != no_texture && texture_set(textures[index]) == 0) out.flags |= material_on_set0;
    return out;
}

// Whether some point of it may not be matte: textures only ever lessen roughness.
bool glossy(const scenes::Material& m) {
    return !m.unlit && (brdf_roughness(m.metallic, m.roughness) > 0 || m.metallic_roughness_texture.texture != scenes::none);
}

OpacityMaterial alpha(const scenes::Material& m, TexturePacker& pack) {
    using Alpha = scenes::Material::Alpha;
    if (m.alpha == Alpha::opaque) return compute::Opacity::opaque();
    // A cutoff of 0 or less leaves nothing out.
    return {.texture = pack.ref(m.base_color_texture), .alpha = m.base_color.a, .cutoff = m.alpha == Alpha::mask ? std::max(m.alpha_cutoff, 0.0f) : opacity_blended};
}

// Empty where the scene need not have it.
template <class T>
engine::Array<T> upload_if(bool needed, engine::Device& device, std::string name, const std::vector<T>& values) {
    return engine::upload(device, "scene", std::move(name), needed ? values : std::vector<T>{});
}

}  // namespace

double srgb_to_linear(uint8_t code) {
    const double c = code / 255.0;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

compute::WorldTriangles world_triangles(const scenes::Triangles& triangles) {
    compute::WorldTriangles world{triangles.positions, triangles.triangles};
    if (triangles.motion.count() > 0) world.first_moving = triangles.motion.first_triangle;
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
    TexturePacker pack(scene, triangles, data);
    for (const scenes::Material& m : scene.materials) {
        data.materials.push_back(material(m, pack, data.textures));
        data.alphas.push_back(alpha(m, pack));
        data.bends = data.bends || data.materials.back().normal_texture != no_texture;
        data.glossy = data.glossy || glossy(m);
    }
    data.world = world_triangles(triangles);
    data.world.opacity = {triangles.triangles, triangles.texcoords, triangles.texcoords1, triangles.colors, data.alphas, data.texels};
    return data;
}

Geometry::Geometry(engine::Device& device, const scenes::Triangles& triangles, const GeometryData& data)
    : positions_(engine::upload(device, "scene", "vertex positions", triangles.positions)),
      normals_(engine::upload(device, "scene", "vertex normals", triangles.normals)),
      triangles_(engine::upload(device, "scene", "triangles", triangles.triangles)),
      texcoords_(upload_if(data.on_set[0], device, "texture coordinates 0", triangles.texcoords)),
      texcoords1_(upload_if(data.on_set[1], device, "texture coordinates 1", triangles.texcoords1)),
      colors_(engine::upload(device, "scene", "vertex colours", triangles.colors)),
      tangents_(upload_if(data.bends, device, "vertex tangents", triangles.tangents)),
      materials_(engine::upload(device, "scene", "materials", data.materials)),
      alphas_(engine::upload(device, "scene", "alphas of materials", data.alphas)),
      textures_(engine::upload(device, "scene", "textures of materials", data.textures)),
      texels_(engine::upload(device, "scene", "texels", data.texels)),
      instances_(engine::upload(device, "scene", "instances", data.world.instances)) {
    engine::Recorder addresses(device);
    arrays_ = engine::upload(device, "scene", "geometry arrays", std::vector<GeometryArrays>{read_arrays(addresses)});
    opacity_arrays_ = engine::upload(device, "scene", "opacity arrays", std::vector<OpacityArrays>{read_opacity(addresses)});
}

GeometryArrays Geometry::read_arrays(engine::Recorder& recorder) const {
    return {.positions = recorder.read(positions_),
            .triangles = recorder.read(triangles_),
            .normals = recorder.read(normals_),
            .texcoords = recorder.read(texcoords_),
            .texcoords1 = recorder.read(texcoords1_),
            .colors = recorder.read(colors_),
            .tangents = recorder.read(tangents_),
            .materials = recorder.read(materials_),
            .textures = recorder.read(textures_),
            .texels = recorder.read(texels_),
            .instances = recorder.read(instances_),
            .instance_count = uint(instances_.count()),
            .has = (colors_.count() ? geometry_colors : 0) | (tangents_.count() ? geometry_tangents : 0)};
}

OpacityArrays Geometry::read_opacity(engine::Recorder& recorder) const {
    return {.triangles = recorder.read(triangles_),
            .texcoords = recorder.read(texcoords_),
            .texcoords1 = recorder.read(texcoords1_),
            .colors = recorder.read(colors_),
            .materials = recorder.read(alphas_),
            .texels = recorder.read(texels_),
            .instances = recorder.read(instances_),
            .instance_count = uint(instances_.count()),
            .has_colors = colors_.count() > 0};
}

GeometryRef Geometry::read(engine::Recorder& recorder) const {
    read_arrays(recorder);  // kernels find these addresses in memory: they are declared all the same
    return recorder.read(arrays_);
}

compute::OpacityReader Geometry::opacity() const {
    return [this](engine::Recorder& recorder) {
        read_opacity(recorder);
        return OpacityRef{recorder.read(opacity_arrays_)};
    };
}

}  // namespace myriad::passes
