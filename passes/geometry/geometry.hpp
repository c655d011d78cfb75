// The scene on the device: triangles, materials, textures; see README.md.
#pragma once

#include "compute/instances/world.hpp"
#include "compute/raytrace/bvh.hpp"
#include "engine/recorder.hpp"
#include "passes/geometry/geometry_io.h"
#include "scenes/scene.hpp"

namespace myriad::passes {

// The scene's triangles as trees and samples take them, but for their opacity. Refers to `triangles`.
compute::WorldTriangles world_triangles(const scenes::Triangles& triangles);

// What is uploaded beside the scene's own arrays, still on the host: what builds trees and samples surfaces looks at it, and
// tests do; then it is thrown away.
struct GeometryData {
    GeometryData() = default;
    GeometryData(GeometryData&&) = default;

    compute::WorldTriangles world;        // with opacity; refers to the scene's triangles and to this
    std::vector<Material> materials;
    std::vector<OpacityMaterial> alphas;  // of the materials
    std::vector<TextureRef> textures;     // as materials use them
    std::vector<uint> texels;             // empty when no material refers to a texture
    bool on_set[2] = {false, false};      // some material needs these texture coordinates
    bool bends = false;                   // some material has a normal texture
    bool glossy = false;                  // some material is not matte (passes/brdf)
};
GeometryData geometry_data(const scenes::Scene& scene, const scenes::Triangles& triangles);

class Geometry {
public:
    Geometry(engine::Device& device, const scenes::Triangles& triangles, const GeometryData& data);
    Geometry(const Geometry&) = delete;

    // For push constants. Counts as a read of all of it in the next dispatch.
    GeometryRef read(engine::Recorder& recorder) const;
    // For the ray tree over the same triangles, which must not outlive this.
    compute::OpacityReader opacity() const;

    const engine::Array<vec3>& positions() const { return positions_; }
    const engine::Array<vec3>& normals() const { return normals_; }
    const engine::Array<vec4>& tangents() const { return tangents_; }  // empty where no material bends normals
    const engine::Array<uvec4>& triangles() const { return triangles_; }
    const engine::Array<Instance>* instances() const { return instances_.count() ? &instances_ : nullptr; }  // null: nothing is shared

private:
    GeometryArrays read_arrays(engine::Recorder& recorder) const;
    OpacityArrays read_opacity(engine::Recorder& recorder) const;

    engine::Array<vec3> positions_, normals_;
    engine::Array<uvec4> triangles_;
    engine::Array<vec2> texcoords_, texcoords1_;
    engine::Array<vec4> colors_, tangents_;
    engine::Array<Material> materials_;
    engine::Array<OpacityMaterial> alphas_;
    engine::Array<TextureRef> textures_;
    engine::Array<uint> texels_;
    engine::Array<Instance> instances_;
    engine::Array<GeometryArrays> arrays_;
    engine::Array<OpacityArrays> opacity_arrays_;
};

// What a byte of an sRGB texture means.
double srgb_to_linear(uint8_t code);

}  // namespace myriad::passes
