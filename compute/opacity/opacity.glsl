// Whether there is a surface at a point of a triangle: opacity_is_there, the test of every ray's hit on a triangle that asks.
#ifndef MYRIAD_COMPUTE_OPACITY_GLSL
#define MYRIAD_COMPUTE_OPACITY_GLSL

#include "compute/instances/instances.glsl"
#include "compute/opacity/opacity_io.h"

vec2 opacity_texcoord(OpacityArrays o, uint set, uvec4 corners, float u, float v) {
    vec2 a, b, c;
    if (set == 0u) a = o.texcoords.at[corners.x], b = o.texcoords.at[corners.y], c = o.texcoords.at[corners.z];
    else a = o.texcoords1.at[corners.x], b = o.texcoords1.at[corners.y], c = o.texcoords1.at[corners.z];
    return vec2(opacity_at_point(a.x, b.x, c.x, u, v), opacity_at_point(a.y, b.y, c.y, u, v));
}

float opacity_alpha(OpacityArrays o, uvec4 corners, OpacityMaterial material, float u, float v) {
    float alpha = material.alpha;
    if (o.has_colors != 0u)
        alpha *= opacity_at_point(o.colors.at[corners.x].a, o.colors.at[corners.y].a, o.colors.at[corners.z].a, u, v);
    if (material.texture.width != 0u) {
        const vec2 place = texture_place(material.texture, opacity_texcoord(o, texture_set(material.texture), corners, u, v));
        const TexelQuad q = texel_quad(material.texture, place);
        alpha *= opacity_of_texels(uvec4(o.texels.at[q.word.x], o.texels.at[q.word.y], o.texels.at[q.word.z], o.texels.at[q.word.w]), q.weight);
    }
    return alpha;
}

// A triangle of the world, by where it is stored, with its last corners swapped where its instance is mirrored; or by its id.
struct OpacityPlace {
    uint stored;
    bool mirrored;
};
OpacityPlace opacity_place(OpacityArrays o, uint id) {
    if (!instanced) return OpacityPlace(id, false);
    const Instance i = o.instances.at[find_instance(o.instances, o.instance_count, id)];
    return OpacityPlace(i.first_triangle + (id - i.first_id), instance_swaps(i));
}

struct OpacityHere {
    float alpha, cutoff;
};
OpacityHere opacity_here(OpacityArrays o, OpacityPlace at, float u, float v) {
    uvec4 corners = o.triangles.at[at.stored];
    if (at.mirrored) corners.yz = corners.zy;
    const OpacityMaterial material = o.materials.at[corners.w];
    return OpacityHere(opacity_alpha(o, corners, material, u, v), material.cutoff);
}

bool opacity_is_there(OpacityRef opacity, OpacityPlace at, uint id, float u, float v, uint dice) {
    const OpacityHere here = opacity_here(opacity.at[0], at, u, v);
    return opacity_decides(here.alpha, here.cutoff, id, u, v, dice);
}
bool opacity_is_there(OpacityRef opacity, uint id, float u, float v, uint dice) {
    return opacity_is_there(opacity, opacity_place(opacity.at[0], id), id, u, v, dice);
}

// How much is missing, for trees.
uint opacity_missing_at(OpacityRef opacity, uint id, float u, float v) {
    const OpacityHere here = opacity_here(opacity.at[0], opacity_place(opacity.at[0], id), u, v);
    if (here.cutoff < 0.0) return opacity_missing(here.alpha);
    return here.alpha >= here.cutoff ? 0u : opacity_nothing;
}

#endif
