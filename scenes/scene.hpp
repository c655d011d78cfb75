// What is rendered: meshes, instances, materials, lights and cameras, on the host, in the terms of glTF 2.0.
//
// Lengths are metres, +Y is up, right-handed. Radiance is linear; colours of textures are decoded where they are read.
// glTF's photometric units are taken as radiometric 1:1 (spec, section 5): point and spot intensity in W/sr,
// directional light in W/m^2.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

#include "scenes/animation.hpp"
#include "scenes/environment.hpp"
#include "scenes/motion.hpp"

namespace myriad::scenes {

// Coordinates beyond this, in metres, are as good as infinite: of what is nearer, squares of distances, areas and fluxes stay
// finite in 32-bit floats.
inline constexpr float farthest = 1e9f;

struct Texture {
    std::string name;
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgba;  // width * height * 4, row 0 at v = 0
    enum class Wrap : uint32_t { repeat, clamp, mirror } wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
};

// How a material uses a texture: where on it a surface's point lies.
struct TextureUse {
    uint32_t texture = none;
    uint32_t set = 0;                            // of texture coordinates: 0 or 1
    glm::mat3x2 transform{1, 0, 0, 1, 0, 0};     // (u, v) on the texture = transform * (u, v, 1)
};

struct Material {
    std::string name;
    glm::vec4 base_color{1};           // linear; multiplies the texture and the vertex colour
    float metallic = 1, roughness = 1;
    glm::vec3 emissive{0};             // radiance, W/(m^2 sr); multiplies the texture
    TextureUse base_color_texture;           // sRGB, alpha linear
    TextureUse metallic_roughness_texture;   // linear; G roughness, B metallic
    TextureUse emissive_texture;             // sRGB
    TextureUse normal_texture;               // linear; tangent space, +Y up
    float normal_scale = 1;
    enum class Alpha : uint32_t { opaque, mask, blend } alpha = Alpha::opaque;
    float alpha_cutoff = 0.5f;         // mask: a point with less alpha is not there
    bool unlit = false;                // shows its base colour as radiance, reflects no light (KHR_materials_unlit)
    bool double_sided = false;
};

// How far each vertex of a primitive goes with a weight of 1.
struct MorphTarget {
    std::vector<glm::vec3> positions;   // one a vertex; empty: none moves
    std::vector<glm::vec3> normals;     // one a vertex; empty: normals stay
};

struct Primitive {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;     // unit; empty: flat shading from the geometry
    std::vector<glm::vec4> tangents;    // xyz unit, w the sign of the bitangent; empty: from the texture coordinates
    std::vector<glm::vec2> texcoords, texcoords1;  // sets 0 and 1; empty: (0, 0)
    std::vector<glm::vec4> colors;      // linear, with alpha; empty: white
    std::vector<uint32_t> indices;      // three a triangle, always present, always in range
    uint32_t material = 0;
    // For skins: joints of the skin and their weights, four a vertex and set, which sum to 1; empty: no such set.
    std::vector<glm::u16vec4> joints[2];
    std::vector<glm::vec4> joint_weights[2];
    std::vector<MorphTarget> targets;   // as many in all primitives of a mesh
};

struct Mesh {
    std::string name;
    std::vector<Primitive> primitives;
};

struct Instance {
    uint32_t mesh = 0;
    glm::mat4 to_world{1};      // at rest
    uint32_t node = none;       // that it stands at, where that can matter: it can move, or is skinned or morphed
    uint32_t skin = none;       // only with a node; its joints place the mesh then, to_world does not
};

struct Camera {
    std::string name;
    glm::mat4 to_world{1};        // looks along -Z, +Y up, as in glTF
    float yfov = 0.8f;            // radians, the full vertical angle
    uint32_t node = none;         // that it goes with, where that can move
};

struct Light {
    enum class Type : uint32_t { point, spot, directional } type = Type::point;
    std::string name;
    glm::vec3 position{0};        // world
    glm::vec3 direction{0, 0, -1};// world, unit, the way the light travels
    glm::vec3 intensity{0};       // colour times intensity: W/sr (point, spot) or W/m^2 (directional)
    float inner_cone = 0, outer_cone = 0.785398f;  // spot: half-angles, radians
    uint32_t node = none;         // that it goes with, where that can move
    float radius = 0;             // point: metres, of the glowing ball that it is seen as, and within which its light grows no more; 0: a mere point, not seen
};

struct Scene {
    std::string name;             // as the user gave it: a path or "builtin:NAME"
    std::vector<Mesh> meshes;
    std::vector<Instance> instances;
    std::vector<Material> materials;   // never empty: a scene without materials gets glTF's default material
    std::vector<Texture> textures;
    std::vector<Light> lights;
    std::vector<Camera> cameras;       // may be empty: see framing_camera()
    glm::vec3 background{0};           // radiance, the same in all directions, of what rays that leave the scene see
    std::optional<Environment> environment;  // in place of `background`; the last solid_angles.size() of `lights` stand for it
    // What can move, and what that hangs from; all empty for a scene that stands still.
    std::vector<Node> nodes;
    std::vector<Skin> skins;
    std::vector<Clip> clips;
    std::vector<std::string> warnings; // harmless defects that were repaired or ignored, one sentence each
};

// Appends the warning "COUNT WHAT." where there is anything to count.
void warn(Scene& scene, size_t count, std::string_view what);

// A range of the scene's triangles: an instance of a mesh that is stored once, or what is stored in world space as it is.
struct Placement {
    glm::mat4 to_world{1};          // invertible; identity where in_world
    bool in_world = true;
    uint32_t first_id = 0;          // in the world these are triangles first_id + i …
    uint32_t first_triangle = 0;    // … stored at first_triangle + i,
    uint32_t count = 0;             // i < count
};

// All triangles of the scene in one index space, the world's ids: what goes to the device.
struct Triangles {
    std::vector<glm::vec3> positions, normals;   // one a vertex; normals are unit
    std::vector<glm::vec2> texcoords;            // one a vertex
    // One a vertex, or empty where no primitive has them: white, as set 0, from the texture coordinates (xyz 0: this vertex has none).
    std::vector<glm::vec4> colors;
    std::vector<glm::vec2> texcoords1;
    std::vector<glm::vec4> tangents;
    std::vector<glm::uvec4> triangles;           // three vertex indices, then the material
    // By ids, without gaps. Empty where no mesh is shared: all is in world space, and a triangle's id is its index.
    std::vector<Placement> placements;
    // Bounds of what triangles use, in the world, over all that plays; lo == hi == 0 when empty.
    glm::vec3 lo{0}, hi{0};
    Motion motion;                               // what clips move of this; empty where none plays

    uint32_t count() const {                     // of the world's triangles
        return placements.empty() ? uint32_t(triangles.size()) : placements.back().first_id + placements.back().count;
    }
};

// What becomes of a mesh with several instances. Ids, hence samples and hits, are the same in any case.
enum class Sharing {
    automatic,  // stored once where that saves enough, see sharing_least
    never,      // written out, an instance each
    always,     // stored once wherever an instance allows it
};
// What `automatic` asks for. A mesh: as many triangles, because rays pay for every instance that they look into. The scene:
// as many bytes saved, and that part of what it takes written out, because kernels for instances are slower for all rays.
inline constexpr uint32_t sharing_least_triangles = 64;
inline constexpr uint64_t sharing_least_bytes = 16 << 20;
inline constexpr double sharing_least_part = 0.25;
// An instance is written out where it is singular or nearly, or smaller than its own distance from the origin divided by
// this: rays in its mesh's own space would be too inexact there.
inline constexpr double sharing_most_distortion = 8192;

// Applies instance transforms, computes missing normals, drops triangles with a vertex that is not finite or beyond
// `farthest` (counted in a warning that is appended to `scene.warnings`). Zero-area triangles stay: they are harmless
// downstream and keep indices stable.
// Where a mesh is shared, its vertices stay in its own space, and Triangles::placements say where it stands.
// Where clips play, what they move comes last and is described by Triangles::motion; positions and normals are those of second 0,
// whatever moment is rendered first, so that what is derived of them is the same for all. Skins and morph targets that no clip
// moves are applied for good.
Triangles flatten(Scene& scene, Sharing sharing = Sharing::automatic, const Playback& playback = {});

// A camera that sees the whole scene, for scenes without one.
Camera framing_camera(const Triangles& triangles);

// `name`: a camera's name or its index in decimal; empty: the first camera, or the framing camera when there is none.
// Throws InputError naming the cameras that exist.
Camera pick_camera(const Scene& scene, const Triangles& triangles, const std::string& name);

// `source`: a path to a .gltf or .glb file, "PATH#SCENE" for another scene in it than its default (by name, or index), or
// "builtin:NAME[?key=value&…]". Throws InputError.
Scene load(const std::string& source, uint32_t seed = 1);

// One line a built-in scene, for `-h`.
std::vector<std::string> builtin_names();

}  // namespace myriad::scenes
