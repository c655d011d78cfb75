// The scene's triangles, materials and textures as kernels see them, and the formulae of texture filtering.
#ifndef MYRIAD_PASSES_GEOMETRY_IO_H
#define MYRIAD_PASSES_GEOMETRY_IO_H

#include "compute/raytrace/raytrace_io.h"

MYRIAD_BEGIN
const uint wrap_repeat = 0u, wrap_clamp = 1u, wrap_mirror = 2u;  // as scenes::Texture::Wrap

// Where a texture lies among the texels; width 0: there is none.
struct TextureRef {
    uint first;          // index of its first word in GeometryArrays::texels
    uint width, height;
    uint wrap;           // of u, and of v << 2
};

// Diffuse only: what scenes::Material says of roughness, and the specular lobe, are not read yet.
struct Material {
    vec4 base_color;
    vec3 emission;       // radiance
    float metallic;
    TextureRef base_color_texture, metallic_texture, emission_texture;
    uint double_sided;
};
MYRIAD_ARRAY(Materials, Material, 4)

struct VertexAttributes {
    vec3 normal;
    vec2 texcoord;
};
MYRIAD_ARRAY(VertexPositions, vec3, 4)
MYRIAD_ARRAY(VertexAttributesArray, VertexAttributes, 4)

// Where the scene's arrays are. Positions are apart from the other attributes because trees and deformation need only them.
struct GeometryArrays {
    VertexPositions positions;
    Uint4s triangles;    // three vertices, then the material
    VertexAttributesArray attributes;
    Materials materials;
    Instances instances; // where the scene shares triangles: `triangles` and vertices are then a mesh's own
    Uints texels;        // 256 floats that decode sRGB, then RGBA8 words, R lowest; empty when nothing is textured
    uint instance_count;
    uint padding;
};
const uint srgb_table_size = 256u;
// What goes into push constants, which are short: the address of that one struct, `.at[0]`.
MYRIAD_ARRAY(GeometryRef, GeometryArrays, 8)

// A point of a triangle.
struct Surface {
    vec3 position;
    vec3 geometric_normal;  // unit, on the side from which the corners go counter-clockwise
    vec3 shading_normal;    // unit, on the same side
    vec3 albedo;            // diffuse: base colour * (1 - metallic)
    vec3 emission;          // radiance, from the front; from both sides where double-sided
    bool double_sided;
    float reach;            // of the triangle, for ray_origin
};

MYRIAD_FN vec3 unit_or(vec3 v, vec3 fallback) {
    // Scaled first: the squares of very small or large components are not floats.
    const float largest = max(abs(v.x), max(abs(v.y), abs(v.z)));
    if (!(largest > 0.0f)) return fallback;
    const vec3 scaled = v / largest;
    return scaled / sqrt(dot(scaled, scaled));
}

// The surface as seen by a ray of this unit direction: normals are turned towards where the ray comes from. A
// single-sided surface seen from behind is opaque all the same, shaded with the turned normal, but does not shine there.
MYRIAD_FN Surface face_towards(Surface s, vec3 direction) {
    if (dot(s.geometric_normal, direction) > 0.0f) {
        s.geometric_normal = -s.geometric_normal;
        s.shading_normal = -s.shading_normal;
        if (!s.double_sided) s.emission = vec3(0.0f);
    }
    // An interpolated normal may lean away at silhouettes; it is brought to the edge of what the ray can see.
    const float away = dot(s.shading_normal, direction);
    if (away > 0.0f) s.shading_normal = unit_or(s.shading_normal - away * direction, s.geometric_normal);
    return s;
}

// A texel coordinate in [0, size), from one that may be outside by up to a period of the wrap mode.
MYRIAD_FN uint wrap_texel(int i, uint size, uint mode) {
    const int n = int(size);
    if (mode == wrap_clamp) return uint(clamp(i, 0, n - 1));
    if (mode == wrap_mirror) {
        const int folded = i < 0 ? i + 2 * n : i >= 2 * n ? i - 2 * n : i;
        return uint(folded < n ? folded : 2 * n - 1 - folded);
    }
    return uint(i < 0 ? i + n : i >= n ? i - n : i);
}

// The two texels that a bilinear filter blends along one axis, whose centres are at (i + 0.5) / size, as in glTF.
struct TexelPair {
    uint low, high;
    float weight;        // of `high`
};
MYRIAD_FN TexelPair texel_pair(float t, uint size, uint mode) {
    if (!(abs(t) < 16777216.0f)) t = 0.0f;                              // no fraction is left there, or not a number
    if (mode == wrap_repeat) t -= floor(t);
    if (mode == wrap_mirror) t -= 2.0f * floor(0.5f * t);
    if (mode == wrap_clamp) t = clamp(t, 0.0f, 1.0f);
    const float x = t * float(size) - 0.5f;
    const float whole = floor(x);
    TexelPair pair;
    pair.low = wrap_texel(int(whole), size, mode);
    pair.high = wrap_texel(int(whole) + 1, size, mode);
    pair.weight = x - whole;
    return pair;
}
MYRIAD_END

#ifdef __cplusplus
static_assert(sizeof(myriad::Material) == 84 && sizeof(myriad::VertexAttributes) == 20 && sizeof(myriad::GeometryArrays) == 56 && sizeof(myriad::GeometryRef) == 8);
#endif

#endif
