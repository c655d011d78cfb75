// Where light paths go: low-discrepancy points, and how they become directions and places. Both languages share it, so
// the twin takes the same paths; there is no sin, cos or pow in it, which differ between drivers.
//
// The points are Owen-scrambled Sobol points [Owen 1995; Joe and Kuo 2008; scrambling by hash: Laine and Karras 2011,
// Burley 2020], taken in bit-reversed order. The first dimension, which chooses the light, is then path / paths, that is
// sorted, and the set is a net in both ways that matter here: a range of neighbouring paths (those of one light) has
// well-spread positions and directions, and so has every 2^k-th path (a set of the interleaved gather), for in Sobol
// order those are one aligned block. Plain Sobol or Halton order fails the latter: every second point of the radical
// inverse in base 2 lies in the same half.
#ifndef MYRIAD_PASSES_VPL_SAMPLING_H
#define MYRIAD_PASSES_VPL_SAMPLING_H

#include "compute/common/hash.h"
#include "passes/geometry/light_io.h"

MYRIAD_BEGIN
// Sobol's sequence, dimensions 0 to 4. Instead of a table, the direction numbers come from the recurrence of the
// dimension's primitive polynomial, of which three back are all that is needed.
MYRIAD_FN uint sobol(uint index, uint dimension) {
    if (dimension == 0u) return reverse_bits(index);
    uint older = 0u;
    uint old = 0u;
    uint now = 0x80000000u;
    uint point = 0u;
    for (uint bit = 0u; index != 0u; ++bit, index >>= 1) {
        if ((index & 1u) != 0u) point ^= now;
        uint next = 0u;
        if (dimension == 1u) next = now ^ (now >> 1);                                                // x + 1
        else if (dimension == 2u) next = bit == 0u ? 0xc0000000u : now ^ old ^ (old >> 2);           // x^2 + x + 1; 1 3
        else if (dimension == 3u)                                                                    // x^3 + x + 1; 1 3 1
            next = bit == 0u ? 0xc0000000u : bit == 1u ? 0x20000000u : old ^ older ^ (older >> 3);
        else                                                                                         // x^3 + x^2 + 1; 1 1 1
            next = bit == 0u ? 0x40000000u : bit == 1u ? 0x20000000u : now ^ older ^ (older >> 3);
        older = old;
        old = now;
        now = next;
    }
    return point;
}

MYRIAD_FN uint path_index(uint path, uint path_bits) { return path_bits == 0u ? 0u : reverse_bits(path) >> (32u - path_bits); }

// Which light: one path in each of `paths` equal strata, at the same place in all.
MYRIAD_FN float path_selection(uint path, uint paths, uint seed) {
    return min((float(path) + to_unit(hash(seed))) / float(paths), 0.99999994f);
}
// Where on the light, or in which direction from one that is a point (x, y); in which direction from there (z, w).
MYRIAD_FN vec4 path_emission_point(uint index, uint seed) {
    return vec4(to_unit(owen_scramble(sobol(index, 1u), hash_pair(seed, 1u))),
                to_unit(owen_scramble(sobol(index, 2u), hash_pair(seed, 2u))),
                to_unit(owen_scramble(sobol(index, 3u), hash_pair(seed, 3u))),
                to_unit(owen_scramble(sobol(index, 4u), hash_pair(seed, 4u))));
}
// The direction after `bounce` reflections: pairs of dimensions are padded, each in an order of its own (Burley 2020).
MYRIAD_FN vec2 path_bounce_point(uint index, uint bounce, uint seed) {
    const uint shuffled = owen_scramble(index, hash_pair(seed, 8u * bounce));
    return vec2(to_unit(owen_scramble(sobol(shuffled, 0u), hash_pair(seed, 8u * bounce + 1u))),
                to_unit(owen_scramble(sobol(shuffled, 1u), hash_pair(seed, 8u * bounce + 2u))));
}

// Cosine and sine of `turn` whole turns, 0 <= turn <= 1; error below 1e-7. The nearest quarter turn is taken off, Taylor
// does the rest.
MYRIAD_FN vec2 cos_sin_turns(float turn) {
    const float quarter = floor(4.0f * turn + 0.5f);
    const float a = (4.0f * turn - quarter) * (0.5f * pi);
    const float s = a * a;
    const float c = 1.0f + s * (-0.5f + s * (1.0f / 24.0f + s * (-1.0f / 720.0f + s * (1.0f / 40320.0f))));
    const float n = a * (1.0f + s * (-1.0f / 6.0f + s * (1.0f / 120.0f + s * (-1.0f / 5040.0f + s * (1.0f / 362880.0f)))));
    const uint q = uint(quarter) & 3u;
    if (q == 0u) return vec2(c, n);
    if (q == 1u) return vec2(-n, c);
    if (q == 2u) return vec2(-c, -n);
    return vec2(n, -c);
}

// From (0, 1]; relative error below 1e-6: a first guess from the exponent, then Newton.
MYRIAD_FN float cube_root(float x) {
    float y = uintBitsToFloat(floatBitsToUint(x) / 3u + 709921077u);
    for (uint i = 0u; i < 3u; ++i) y = (2.0f * y + x / (y * y)) / 3.0f;
    return y;
}

// Local z is the unit vector n (Duff et al. 2017).
MYRIAD_FN vec3 to_world(vec3 local, vec3 n) {
    const float side = n.z < 0.0f ? -1.0f : 1.0f;
    const float a = -1.0f / (side + n.z);
    const float b = n.x * n.y * a;
    const vec3 x = vec3(1.0f + side * n.x * n.x * a, side * b, -side * n.x);
    const vec3 y = vec3(b, side + n.y * n.y * a, -n.y);
    return local.x * x + local.y * y + local.z * n;
}

// Direction of density cos / pi around n.
MYRIAD_FN vec3 cosine_direction(vec2 x, vec3 n) {
    const float r = sqrt(x.x);
    const vec2 around = cos_sin_turns(x.y);
    return to_world(vec3(r * around.x, r * around.y, sqrt(1.0f - x.x)), n);
}

// Barycentrics (u, v), uniform by area (Heitz 2019): the square folded into a triangle with little distortion.
MYRIAD_FN vec2 triangle_point(vec2 x) {
    return x.y > x.x ? vec2(0.5f * x.x, x.y - 0.5f * x.x) : vec2(x.x - 0.5f * x.y, 0.5f * x.y);
}

// A ray that leaves a punctual light, and the light's whole flux, which all its rays share equally.
struct Emission {
    vec3 origin;
    vec3 direction;
    vec3 flux;
};
// `x` is uniform over the unit square, the light's domain: uniform in flux.
MYRIAD_FN Emission emit_punctual(Light light, vec2 x) {
    Emission e;
    e.origin = light.position;
    e.direction = light.direction;
    if (light.type == light_point) {
        const float z = 1.0f - 2.0f * x.x;
        const float r = sqrt(max(0.0f, 1.0f - z * z));
        const vec2 around = cos_sin_turns(x.y);
        e.direction = vec3(r * around.x, r * around.y, z);
        e.flux = 4.0f * pi * light.intensity;
    } else if (light.type == light_spot) {
        // By falloff: t^2 on the ramp of the cosine is inverted by a cube root, the plateau beyond is uniform.
        const float width = spot_width(light);
        const float room = 1.0f - light.cos_outer;
        const float below = x.x * spot_solid_angle(light) / (2.0f * pi);
        const float above_outer = 3.0f * below < width ? width * cube_root(3.0f * below / width) : below + (2.0f / 3.0f) * width;
        const float k = max(0.0f, room - above_outer);  // 1 - cos: exact where a beam is narrow
        const float r = sqrt(k * (2.0f - k));
        const vec2 around = cos_sin_turns(x.y);
        e.direction = to_world(vec3(r * around.x, r * around.y, 1.0f - k), light.direction);
        e.flux = spot_solid_angle(light) * light.intensity;
    } else {
        // Light enters the scene's bounds through the (up to three) faces that it falls on. A place on them by projected
        // area is uniform over their outline, so no ray misses the bounds. It starts a little before them, to meet
        // surfaces in the very face.
        const vec3 d = light.direction;
        const vec3 entry = vec3(d.x < 0.0f ? 1.0f : 0.0f, d.y < 0.0f ? 1.0f : 0.0f, d.z < 0.0f ? 1.0f : 0.0f);
        const vec3 areas = directional_areas(light);
        const float total = areas.x + areas.y + areas.z;
        const float rest = x.x * total;
        vec3 at;
        if (rest < areas.x) at = vec3(entry.x, rest / areas.x, x.y);
        else if (rest - areas.x < areas.y) at = vec3(x.y, entry.y, (rest - areas.x) / areas.y);
        else at = vec3(min((rest - areas.x - areas.y) / max(areas.z, 1e-30f), 1.0f), x.y, entry.z);
        const float back = 0.01f * (light.extent.x + light.extent.y + light.extent.z);
        e.origin = light.position + at * light.extent - back * d;
        e.flux = total * light.intensity;
    }
    return e;
}
MYRIAD_END

#endif
