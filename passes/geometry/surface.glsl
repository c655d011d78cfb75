// What lies at a point of a triangle: position, normals, and the material's textures, filtered here because textures
// are plain memory (no descriptors, which end at 128 MiB on lavapipe). One level, bilinear: a pixel sees its centre only.
#ifndef MYRIAD_PASSES_SURFACE_GLSL
#define MYRIAD_PASSES_SURFACE_GLSL

#include "passes/geometry/geometry_io.h"
#include "compute/instances/instances.glsl"

vec3 texel_rgb(GeometryArrays g, TextureRef texture_, uint x, uint y, bool srgb) {
    const uint word = g.texels.at[texture_.first + y * texture_.width + x];
    const uvec3 code = uvec3(word, word >> 8, word >> 16) & 0xffu;
    if (!srgb) return vec3(code) / 255.0;
    return uintBitsToFloat(uvec3(g.texels.at[code.r], g.texels.at[code.g], g.texels.at[code.b]));
}

// White where there is no texture, so that the result always multiplies a factor.
vec3 texture_rgb(GeometryArrays g, TextureRef texture_, vec2 uv, bool srgb) {
    if (texture_.width == 0u) return vec3(1.0);
    const TexelPair x = texel_pair(uv.x, texture_.width, texture_.wrap & 3u);
    const TexelPair y = texel_pair(uv.y, texture_.height, texture_.wrap >> 2);
    const vec3 top = mix(texel_rgb(g, texture_, x.low, y.low, srgb), texel_rgb(g, texture_, x.high, y.low, srgb), x.weight);
    const vec3 bottom = mix(texel_rgb(g, texture_, x.low, y.high, srgb), texel_rgb(g, texture_, x.high, y.high, srgb), x.weight);
    return mix(top, bottom, y.weight);
}

// (u, v) are barycentric: (1 - u - v) p0 + u p1 + v p2.
Surface surface_at(GeometryRef geometry, uint triangle, float u, float v) {
    GeometryArrays g = geometry.at[0];
    Instance instance;
    uint stored = triangle;
    if (instanced) {
        instance = g.instances.at[find_instance(g.instances, g.instance_count, triangle)];
        stored = instance.first_triangle + (triangle - instance.first_id);
    }
    const bool placed = instanced && (instance.flags & instance_in_world) == 0u;
    uvec4 corners = g.triangles.at[stored];
    if (placed && (instance.flags & instance_mirrored) != 0u) corners.yz = corners.zy;
    vec3 p0 = g.positions.at[corners.x];
    vec3 p1 = g.positions.at[corners.y];
    vec3 p2 = g.positions.at[corners.z];
    VertexAttributes a0 = g.attributes.at[corners.x];
    VertexAttributes a1 = g.attributes.at[corners.y];
    VertexAttributes a2 = g.attributes.at[corners.z];
    if (placed) {
        p0 = instance_point(instance, p0);
        p1 = instance_point(instance, p1);
        p2 = instance_point(instance, p2);
        // Vertex by vertex, as flatten() does: a normal that is interpolated before is another one where the scale is uneven.
        a0.normal = unit_or(instance_normal(instance, a0.normal), vec3(0.0, 1.0, 0.0));
        a1.normal = unit_or(instance_normal(instance, a1.normal), vec3(0.0, 1.0, 0.0));
        a2.normal = unit_or(instance_normal(instance, a2.normal), vec3(0.0, 1.0, 0.0));
    }
    const float w = 1.0 - u - v;
    const vec2 uv = w * a0.texcoord + u * a1.texcoord + v * a2.texcoord;
    const Material material = g.materials.at[corners.w];

    Surface s;
    s.position = w * p0 + u * p1 + v * p2;
    s.geometric_normal = unit_or(cross(unit_or(p1 - p0, vec3(0.0)), unit_or(p2 - p0, vec3(0.0))), vec3(0.0, 1.0, 0.0));
    s.shading_normal = unit_or(w * a0.normal + u * a1.normal + v * a2.normal, s.geometric_normal);
    if (dot(s.shading_normal, s.geometric_normal) < 0.0) s.shading_normal = -s.shading_normal;  // winding decides the side
    const float metallic = material.metallic * texture_rgb(g, material.metallic_texture, uv, false).b;
    s.albedo = material.base_color.rgb * texture_rgb(g, material.base_color_texture, uv, true) * (1.0 - metallic);
    s.emission = material.emission;
    if (any(greaterThan(s.emission, vec3(0.0)))) s.emission *= texture_rgb(g, material.emission_texture, uv, true);
    s.double_sided = material.double_sided != 0u;
    s.reach = ray_reach(p0, p1, p2);
    return s;
}

#endif
