// What lies at a point of a triangle: position, normals, and the material's textures, filtered here because textures
// are plain memory (compute/common/texture.h). One level, bilinear: a pixel sees its centre only.
#ifndef MYRIAD_PASSES_SURFACE_GLSL
#define MYRIAD_PASSES_SURFACE_GLSL

#include "compute/instances/instances.glsl"
#include "passes/geometry/geometry_io.h"

// A point as vertices' attributes know it: its triangle's corners, its barycentrics, its texture coordinates of set 0, and the
// instance that attributes with a direction are to be turned by.
struct SurfacePoint {
    uvec4 corners;
    float u, v;
    vec2 set0;
    bool placed;
    Instance instance;
};

vec2 blend(vec2 a, vec2 b, vec2 c, float u, float v) { return (1.0 - u - v) * a + u * b + v * c; }

vec2 texture_coordinates(GeometryArrays g, SurfacePoint at, TextureRef t) {
    if (texture_set(t) == 0u) return at.set0;
    return blend(g.texcoords1.at[at.corners.x], g.texcoords1.at[at.corners.y], g.texcoords1.at[at.corners.z], at.u, at.v);
}

vec3 texel_rgb(GeometryArrays g, uint at, bool srgb) {
    const uint word = g.texels.at[at];
    const uvec3 code = uvec3(word, word >> 8, word >> 16) & 0xffu;
    if (!srgb) return vec3(code) / 255.0;
    return uintBitsToFloat(uvec3(g.texels.at[code.r], g.texels.at[code.g], g.texels.at[code.b]));
}

// White where there is no texture, so that the result always multiplies a factor.
vec3 texture_rgb(GeometryArrays g, uint index, SurfacePoint at, bool srgb) {
    if (index == no_texture) return vec3(1.0);
    const TextureRef t = g.textures.at[index];
    const TexelQuad q = texel_quad(t, texture_place(t, texture_coordinates(g, at, t)));
    const vec3 top = mix(texel_rgb(g, q.word.x, srgb), texel_rgb(g, q.word.y, srgb), q.weight.x);
    const vec3 bottom = mix(texel_rgb(g, q.word.z, srgb), texel_rgb(g, q.word.w, srgb), q.weight.x);
    return mix(top, bottom, q.weight.y);
}

vec4 turned_tangent(SurfacePoint at, vec4 t) {
    if (!at.placed) return t;
    return vec4(unit_or(at.instance.x * t.x + at.instance.y * t.y + at.instance.z * t.z, vec3(0.0)), instance_swaps(at.instance) ? -t.w : t.w);
}

// Of the vertices where all three have one, else from the coordinates of the normal texture.
vec4 tangent_at(GeometryArrays g, Material material, SurfacePoint at, vec3 p0, vec3 p1, vec3 p2, float winding) {
    if ((g.has & geometry_tangents) != 0u) {
        const vec4 t0 = g.tangents.at[at.corners.x], t1 = g.tangents.at[at.corners.y], t2 = g.tangents.at[at.corners.z];
        if (dot(t0.xyz, t0.xyz) > 0.0 && dot(t1.xyz, t1.xyz) > 0.0 && dot(t2.xyz, t2.xyz) > 0.0) {
            const vec4 a = turned_tangent(at, t0), b = turned_tangent(at, t1), c = turned_tangent(at, t2);
            return vec4((1.0 - at.u - at.v) * a.xyz + at.u * b.xyz + at.v * c.xyz, a.w);
        }
    }
    const TextureRef t = g.textures.at[material.normal_texture];
    const bool first = texture_set(t) == 0u;
    const vec2 c0 = first ? g.texcoords.at[at.corners.x] : g.texcoords1.at[at.corners.x];
    const vec2 c1 = first ? g.texcoords.at[at.corners.y] : g.texcoords1.at[at.corners.y];
    const vec2 c2 = first ? g.texcoords.at[at.corners.z] : g.texcoords1.at[at.corners.z];
    const vec4 tangent = tangent_of(p0, p1, p2, texture_place(t, c0), texture_place(t, c1), texture_place(t, c2));
    return vec4(tangent.xyz, winding * tangent.w);
}

// (u, v) are barycentric: (1 - u - v) p0 + u p1 + v p2.
Surface surface_at(GeometryRef geometry, uint triangle, float u, float v) {
    GeometryArrays g = geometry.at[0];
    SurfacePoint at;
    at.u = u;
    at.v = v;
    uint stored = triangle;
    if (instanced) {
        at.instance = g.instances.at[find_instance(g.instances, g.instance_count, triangle)];
        stored = at.instance.first_triangle + (triangle - at.instance.first_id);
    }
    at.placed = instanced && (at.instance.flags & instance_in_world) == 0u;
    at.corners = g.triangles.at[stored];
    if (at.placed && instance_swaps(at.instance)) at.corners.yz = at.corners.zy;
    vec3 p0 = g.positions.at[at.corners.x];
    vec3 p1 = g.positions.at[at.corners.y];
    vec3 p2 = g.positions.at[at.corners.z];
    vec3 n0 = g.normals.at[at.corners.x];
    vec3 n1 = g.normals.at[at.corners.y];
    vec3 n2 = g.normals.at[at.corners.z];
    if (at.placed) {
        p0 = instance_point(at.instance, p0);
        p1 = instance_point(at.instance, p1);
        p2 = instance_point(at.instance, p2);
        // Vertex by vertex, as flatten() does: a normal that is interpolated before is another one where the scale is uneven.
        n0 = unit_or(instance_normal(at.instance, n0), vec3(0.0, 1.0, 0.0));
        n1 = unit_or(instance_normal(at.instance, n1), vec3(0.0, 1.0, 0.0));
        n2 = unit_or(instance_normal(at.instance, n2), vec3(0.0, 1.0, 0.0));
    }
    const Material material = g.materials.at[at.corners.w];
    at.set0 = vec2(0.0);
    if ((material.flags & material_on_set0) != 0u)
        at.set0 = blend(g.texcoords.at[at.corners.x], g.texcoords.at[at.corners.y], g.texcoords.at[at.corners.z], u, v);
    const float w = 1.0 - u - v;

    Surface s;
    s.position = w * p0 + u * p1 + v * p2;
    s.geometric_normal = unit_or(cross(unit_or(p1 - p0, vec3(0.0)), unit_or(p2 - p0, vec3(0.0))), vec3(0.0, 1.0, 0.0));
    s.shading_normal = unit_or(w * n0 + u * n1 + v * n2, s.geometric_normal);
    // Winding decides the side, not the vertices' normals; a texture bends the normal that they give.
    const float winding = dot(s.shading_normal, s.geometric_normal) < 0.0 ? -1.0 : 1.0;
    if (material.normal_texture != no_texture)
        s.shading_normal = bent_normal(s.shading_normal, tangent_at(g, material, at, p0, p1, p2, winding),
                                       texture_rgb(g, material.normal_texture, at, false), material.normal_scale);
    s.shading_normal *= winding;

    vec3 color = material.base_color * texture_rgb(g, material.base_color_texture, at, true);
    if ((g.has & geometry_colors) != 0u)
        color *= w * g.colors.at[at.corners.x].rgb + u * g.colors.at[at.corners.y].rgb + v * g.colors.at[at.corners.z].rgb;
    s.double_sided = (material.flags & (material_double_sided | material_unlit)) != 0u;
    if ((material.flags & material_unlit) != 0u) {
        s.albedo = vec3(0.0);
        s.f0 = vec3(0.0);
        s.roughness = 0.0;
        s.emission = color;
    } else {
        const vec3 texel = texture_rgb(g, material.metallic_texture, at, false);
        const float metallic = material.metallic * texel.b;
        s.albedo = color * (1.0 - metallic);
        s.f0 = brdf_f0(color, metallic);
        s.roughness = brdf_roughness(metallic, material.roughness * texel.g);
        s.emission = material.emission;
        if (any(greaterThan(s.emission, vec3(0.0)))) s.emission *= texture_rgb(g, material.emission_texture, at, true);
    }
    s.reach = ray_reach(p0, p1, p2);
    return s;
}

#endif
