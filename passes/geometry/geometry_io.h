// The scene's triangles, materials and textures as kernels see them, and the formulae of surfaces.
#ifndef MYRIAD_PASSES_GEOMETRY_IO_H
#define MYRIAD_PASSES_GEOMETRY_IO_H

#include "compute/instances/instances.h"
#include "compute/raytrace/raytrace_io.h"
#include "passes/brdf/brdf.h"

MYRIAD_BEGIN
const uint no_texture = 0xffffffffu;
const uint material_on_set0 = 1u;      // some texture of it is on set 0 of the coordinates
const uint material_double_sided = 2u;
const uint material_unlit = 4u;

// Alpha is in OpacityMaterial. Textures are elements of GeometryArrays::textures, read only where there are any.
struct Material {
    vec3 base_color;
    float metallic, roughness;
    vec3 emission;       // radiance
    float normal_scale;
    uint flags;
    uint base_color_texture, metallic_texture, emission_texture, normal_texture;
};
MYRIAD_ARRAY(Materials, Material, 4)
MYRIAD_ARRAY(Vec3s, vec3, 4)

const uint geometry_colors = 1u, geometry_tangents = 2u;

// Where everything is. An array an attribute, because trees, deformation and most scenes need only some; what no material
// needs is empty and must not be read.
struct GeometryArrays {
    Vec3s positions;
    Uint4s triangles;    // three vertices, then the material
    Vec3s normals;
    Vec2s texcoords, texcoords1;
    Float4s colors;      // if `has` says so
    Float4s tangents;    // likewise; xyz, and the sign of the bitangent
    Materials materials;
    TextureRefs textures;
    Uints texels;        // 256 floats that decode sRGB, then RGBA8 words, R lowest; empty when nothing is textured
    Instances instances; // where the scene shares triangles: `triangles` and vertices are then a mesh's own
    uint instance_count;
    uint has;
};
// What goes into push constants, which are short: the address of that one struct, `.at[0]`.
MYRIAD_ARRAY(GeometryRef, GeometryArrays, 8)
const uint srgb_table_size = 256u;

// A point of a triangle.
struct Surface {
    vec3 position;
    vec3 geometric_normal;  // unit, on the side from which the corners go counter-clockwise
    vec3 shading_normal;    // unit, on the same side
    vec3 albedo;            // diffuse: base colour * (1 - metallic); 0 where unlit
    vec3 f0;                // of the glossy lobe, straight on
    float roughness;        // of the glossy lobe; 0: there is none to speak of (passes/brdf)
    vec3 emission;          // radiance, from the front; from both sides where double-sided. Unlit: the base colour, for the eye only
    bool double_sided;      // or unlit
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

// The direction in which u grows over a triangle, unit, and in w the side of the bitangent: over the normal by winding, it is
// w * cross(normal, tangent). +Y of a normal texture is up in its image, where v falls, as in glTF. xyz = 0: there is none,
// for the texture coordinates do not span the triangle.
MYRIAD_FN vec4 tangent_of(vec3 p0, vec3 p1, vec3 p2, vec2 t0, vec2 t1, vec2 t2) {
    const vec2 a = t1 - t0;
    const vec2 b = t2 - t0;
    const float det = a.x * b.y - b.x * a.y;
    if (!(abs(det) > 0.0f)) return vec4(0.0f);
    const float side = det > 0.0f ? 1.0f : -1.0f;
    return vec4(unit_or(side * (b.y * (p1 - p0) - a.y * (p2 - p0)), vec3(0.0f)), -side);
}

// A unit normal bent by a texel of a normal texture, given in [0, 1].
MYRIAD_FN vec3 bent_normal(vec3 normal, vec4 tangent, vec3 texel, float scale) {
    const vec3 t = unit_or(vec3(tangent) - dot(vec3(tangent), normal) * normal, vec3(0.0f));
    const vec3 bend = 2.0f * texel - 1.0f;
    if (dot(t, t) == 0.0f) return normal;
    return unit_or(scale * (bend.x * t + bend.y * tangent.w * cross(normal, t)) + bend.z * normal, normal);
}
MYRIAD_END

#ifdef __cplusplus
static_assert(sizeof(myriad::Material) == 56 && sizeof(myriad::GeometryArrays) == 96 && sizeof(myriad::GeometryRef) == 8);
#endif

#endif
