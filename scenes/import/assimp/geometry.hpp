// From assimp's scene, which nothing vouches for, to meshes, instances, cameras and lights.
#pragma once

#include <string>

#include <assimp/scene.h>

#include "scenes/scene.hpp"

namespace myriad::scenes::importing {

// Appends all that hangs in the tree of nodes. Materials are not touched: primitives have the file's numbers. Vertices that are the same are
// one. Throws
// InputError where a mesh refers to what it does not have. What is left out is counted in warnings.
struct GeometryOptions {
    bool linear_colors = false;   // else they are sRGB
    bool without_normals = false; // those of the file are not to be trusted
};
void add_geometry(const aiScene& in, const std::string& path, const GeometryOptions& options, Scene& out);

}  // namespace myriad::scenes::importing
