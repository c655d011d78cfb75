// From a scene to a .glb file: the one glTF that Myriad writes, self-contained, the same bytes for the same scene.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "scenes/scene.hpp"

namespace myriad::scenes {

// Takes the bytes of a file from its beginning to its end, a piece at a time.
using Sink = std::function<void(const void* bytes, size_t count)>;

struct GlbOptions {
    bool quick = false;  // textures are compressed less, several times faster: for what is read back at once
};

// All that a Scene holds but its warnings. What is read back is the same scene to the bit, but for this:
// - Cameras and lights turn by up to a rounding error: glTF knows their direction only as a rotation.
// - A transform that shears is written as two nodes, for a node of glTF cannot shear; it comes back with a rounding error.
// - What hangs from scene.nodes comes in the order of the nodes among instances, cameras and lights. A track that no channel
//   plays and a clip without channels are lost.
// - Meshes, primitives and instances without triangles are left out, and so are tangents without normals and texture
//   coordinates, which glTF has no place for.
// The scene is expected sound: indices in range, an attribute empty or as long as `positions`. Throws InputError for what
// glTF cannot hold: numbers that are not finite, a sheared texture transform, more than 4 GiB.
void write_glb(const Scene& scene, const Sink& sink, const GlbOptions& options = {});

// The whole file in memory.
std::string glb_bytes(const Scene& scene, const GlbOptions& options = {});

}  // namespace myriad::scenes
