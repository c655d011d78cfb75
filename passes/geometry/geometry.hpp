// The scene on the device: triangles, materials, textures; see README.md.
#pragma once

#include "compute/instances/world.hpp"
#include "engine/recorder.hpp"
#include "passes/geometry/geometry_io.h"
#include "scenes/scene.hpp"

namespace myriad::passes {

// The scene's triangles as trees and samples take them. Refers to `triangles`.
compute::WorldTriangles world_triangles(const scenes::Triangles& triangles);

// What is uploaded, still on the host: tests look at it, and the product throws it away.
struct GeometryData {
    std::vector<VertexAttributes> attributes;
    std::vector<Material> materials;
    std::vector<uint> texels;  // empty when no material refers to a texture
};
GeometryData geometry_data(const scenes::Scene& scene, const scenes::Triangles& triangles);

class Geometry {
public:
    Geometry(engine::Device& device, const scenes::Scene& scene, const scenes::Triangles& triangles);

    // For push constants. Counts as a read of all of it in the next dispatch.
    GeometryRef read(engine::Recorder& recorder) const;

    const engine::Array<vec3>& positions() const { return positions_; }
    const engine::Array<uvec4>& triangles() const { return triangles_; }
    const engine::Array<Instance>* instances() const { return instances_.count() ? &instances_ : nullptr; }  // null: nothing is shared

private:
    Geometry(engine::Device& device, const scenes::Triangles& triangles, const GeometryData& data);
    GeometryArrays read_arrays(engine::Recorder& recorder) const;

    engine::Array<vec3> positions_;
    engine::Array<uvec4> triangles_;
    engine::Array<Instance> instances_;
    engine::Array<VertexAttributes> attributes_;
    engine::Array<Material> materials_;
    engine::Array<uint> texels_;
    engine::Array<GeometryArrays> arrays_;
};

// What a byte of an sRGB texture means.
double srgb_to_linear(uint8_t code);

}  // namespace myriad::passes
