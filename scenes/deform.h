// Where a moving vertex is: the structs and the formula, for the host and for a kernel. What holds them is scenes/motion.hpp.
//
// A moving vertex is kept where it is in its mesh's own space. Each frame gives matrices and morph weights anew, and
//   p = position + sum over its morph deltas of weight * delta
//   M = sum over its influences of weight * matrix         (weights sum to 1; a rigid part has one influence, of weight 1)
//   in the world it is at M p, with the normal along the cofactors of M times n.
// Nothing else tells rigid, skinned and morphed vertices apart.
#ifndef MYRIAD_SCENES_DEFORM_H
#define MYRIAD_SCENES_DEFORM_H

#include "engine/shared.h"

#ifdef __cplusplus
#define precise
#endif

MYRIAD_BEGIN
// The affine map p -> p.x * x + p.y * y + p.z * z + at; 48 bytes.
struct Affine {
    vec3 x, y, z, at;
};
MYRIAD_ARRAY(Affines, Affine, 4)

// 8 bytes.
struct Influence {
    uint matrix;   // in the frame's matrices
    float weight;
};
MYRIAD_ARRAY(Influences, Influence, 4)

// 28 bytes.
struct MorphDelta {
    uint weight;   // in the frame's morph weights
    vec3 position, normal;
};
MYRIAD_ARRAY(MorphDeltas, MorphDelta, 4)

// 32 bytes. Its influences and deltas end where those of the next vertex begin: arrays of these have one element more than
// there are vertices.
struct MovingVertex {
    vec3 position, normal;   // in the mesh's space; unit
    uint influences, deltas; // its first of each
};
MYRIAD_ARRAY(MovingVertices, MovingVertex, 4)

MYRIAD_FN Affine affine_zero() {
    Affine m;
    m.x = m.y = m.z = m.at = vec3(0.0);
    return m;
}

MYRIAD_FN Affine affine_add(Affine sum, Affine m, float weight) {
    precise Affine s = sum;
    s.x = s.x + m.x * weight;
    s.y = s.y + m.y * weight;
    s.z = s.z + m.z * weight;
    s.at = s.at + m.at * weight;
    return s;
}

// The order of roundings is that of glm's `to_world * vec4(p, 1)`, as for what stands still.
MYRIAD_FN vec3 affine_point(Affine m, vec3 p) {
    precise const vec3 q = (m.x * p.x + m.y * p.y) + (m.z * p.z + m.at);
    return q;
}

// Of the volume that the axes span; negative where the map mirrors.
MYRIAD_FN float affine_determinant(Affine m) {
    precise const float d = dot(m.x, cross(m.y, m.z));
    return d;
}

MYRIAD_FN vec3 unit_vector(vec3 v, vec3 fallback) {
    const float most = max(max(abs(v.x), abs(v.y)), abs(v.z));
    if (!(most > 1e-37 && most < 1e37)) return fallback;  // NaN is not
    precise const vec3 near_one = v / most;               // squares neither over- nor underflow
    precise const float squares = near_one.x * near_one.x + near_one.y * near_one.y + near_one.z * near_one.z;
    precise const vec3 unit = near_one / sqrt(squares);
    return unit;
}

// The unit normal of what had normal `n`; up where nothing is left of it.
MYRIAD_FN vec3 affine_normal(Affine m, vec3 n) {
    // Of axes scaled to about 1: products of three would leave what floats hold. A normal has no length to lose by that.
    const float most = max(max(max(max(abs(m.x.x), abs(m.x.y)), abs(m.x.z)), max(max(abs(m.y.x), abs(m.y.y)), abs(m.y.z))),
                           max(max(abs(m.z.x), abs(m.z.y)), abs(m.z.z)));
    const float scale = most > 1e-30 && most < 1e30 ? 1.0f / most : 1.0f;
    precise const vec3 x = m.x * scale, y = m.y * scale, z = m.z * scale;
    precise const vec3 yz = cross(y, z);
    precise const float volume = x.x * yz.x + x.y * yz.y + x.z * yz.z;
    precise const vec3 along = yz * n.x + cross(z, x) * n.y + cross(x, y) * n.z;
    return unit_vector(volume < 0.0f ? -along : along, vec3(0.0, 1.0, 0.0));
}

// A tangent goes with the surface; w, the sign of the bitangent, turns where the map mirrors. Zero: there is none.
MYRIAD_FN vec4 affine_tangent(Affine m, vec4 t) {
    precise const vec3 along = m.x * t.x + m.y * t.y + m.z * t.z;
    return vec4(unit_vector(along, vec3(0.0)), affine_determinant(m) < 0.0f ? -t.w : t.w);
}

// What the world may hold: coordinates end at 1e9 m (scenes::farthest), denormals are 0, and so is what is no number. A clip can
// throw a vertex anywhere, and trees are to survive it.
MYRIAD_FN float settled(float x) {
    const float size = abs(x);
    if (size <= 1e9f) return size >= 1.17549435e-38f ? x : 0.0f;
    return x > 0.0f ? 1e9f : x < 0.0f ? -1e9f : 0.0f;
}
MYRIAD_FN vec3 settled_point(vec3 p) { return vec3(settled(p.x), settled(p.y), settled(p.z)); }

// The unit normal of a flat triangle at these places, counter-clockwise; up where it has no area.
MYRIAD_FN vec3 flat_normal(vec3 a, vec3 b, vec3 c) {
    const vec3 u = b - a, v = c - a;
    const float most = max(max(max(abs(u.x), abs(u.y)), abs(u.z)), max(max(abs(v.x), abs(v.y)), abs(v.z)));
    const float scale = most > 1e-30f ? 1.0f / most : 1.0f;
    precise const vec3 s = u * scale, t = v * scale;
    precise const vec3 n = vec3(s.y * t.z - s.z * t.y, s.z * t.x - s.x * t.z, s.x * t.y - s.y * t.x);
    return unit_vector(n, vec3(0.0, 1.0, 0.0));
}
MYRIAD_END

#ifdef __cplusplus
#undef precise
static_assert(sizeof(myriad::Affine) == 48 && sizeof(myriad::Influence) == 8 && sizeof(myriad::MorphDelta) == 28 &&
              sizeof(myriad::MovingVertex) == 32);
#endif

#endif
