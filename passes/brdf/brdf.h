// How a surface reflects: glTF 2.0's metallic-roughness material (its Appendix B), once for both languages; see README.md.
#ifndef MYRIAD_PASSES_BRDF_H
#define MYRIAD_PASSES_BRDF_H

#include "compute/common/packing.h"

MYRIAD_BEGIN
const float pi = 3.14159265f;

const float brdf_dielectric = 0.04f;  // reflectance of a dielectric seen straight on: an index of refraction of 1.5
// No lobe is narrower: alpha = roughness^2 = 0.002, the tangent of its half-width, is the angle of a pixel (0.8 rad over 360 rows);
// narrower highlights of point lights would fall between pixels, and normals are kept to 4e-5 rad only.
const float brdf_least_roughness = 0.045f;
// A dielectric as rough as this is matte, a Lambertian of its base colour; README.md has the error.
const float brdf_matte_roughness = 0.9f;
// Cosines are at least this where they divide. At the silhouette a shading normal is perpendicular to the view, or beyond by rounding.
const float brdf_least_cosine = 1e-4f;

MYRIAD_FN vec3 brdf_f0(vec3 base_color, float metallic) { return mix(vec3(brdf_dielectric), base_color, metallic); }

// The roughness that a surface is given: 0 where it is matte, else no less than the least.
MYRIAD_FN float brdf_roughness(float metallic, float roughness) {
    if (!(metallic > 0.0f) && roughness >= brdf_matte_roughness) return 0.0f;
    return max(roughness, brdf_least_roughness);
}

// What a glossy pixel keeps beside its albedo; all bits 0 is a matte one.
struct Gloss {
    uint f0_rg, f0_b_roughness;  // in 16 bits each, the first one low
    uint view;                   // pack_direction, towards the eye
};
MYRIAD_ARRAY(Glosses, Gloss, 4)

MYRIAD_FN uint pack_unit(float low, float high) {
    return uint(clamp(low, 0.0f, 1.0f) * 65535.0f + 0.5f) | uint(clamp(high, 0.0f, 1.0f) * 65535.0f + 0.5f) << 16;
}
MYRIAD_FN float unpack_low(uint packed) { return float(packed & 0xffffu) / 65535.0f; }
MYRIAD_FN float unpack_high(uint packed) { return float(packed >> 16) / 65535.0f; }

MYRIAD_FN Gloss pack_gloss(vec3 f0, float roughness, vec3 view) {
    Gloss g;
    g.f0_rg = pack_unit(f0.x, f0.y);
    g.f0_b_roughness = pack_unit(f0.z, roughness);
    g.view = pack_direction(view);
    return g;
}
MYRIAD_FN bool is_matte(Gloss g) { return g.f0_b_roughness >> 16 == 0u; }

// What the glossy lobe of a dielectric reflects of all light that comes evenly from everywhere, from a bit above: f0 + t^3 (p t^2 + q)
// with t = 1 - cos. A fit of ours; the test integrates the lobe and compares.
MYRIAD_FN vec2 brdf_fit(float roughness) {
    const float s = 1.0f - roughness;
    return vec2((1.0f - brdf_dielectric) * s * s * s * s, 3.0f * roughness * s * s * s + 0.03f);
}
MYRIAD_FN float brdf_fitted(vec2 fit, float cosine) {
    const float t = 1.0f - clamp(cosine, 0.0f, 1.0f);
    return brdf_dielectric + t * t * t * (fit.x * t * t + fit.y);
}

// A surface with its normal and where it is seen from, ready for many lights.
struct Lobe {
    vec3 f0;
    float alpha2;        // roughness^4; 0: matte, and all the rest means nothing
    vec3 view;           // unit, towards the eye
    float cos_view;
    vec2 fit;
    float under;         // what the glossy lobe leaves to the diffuse one on the way out, normalised
};
MYRIAD_FN Lobe matte_lobe() {
    Lobe lobe;
    lobe.f0 = vec3(0.0f);
    lobe.alpha2 = 0.0f;
    lobe.view = vec3(0.0f);
    lobe.cos_view = 1.0f;
    lobe.fit = vec2(0.0f);
    lobe.under = 1.0f;
    return lobe;
}
MYRIAD_FN Lobe lobe_of(vec3 f0, float roughness, vec3 view, vec3 n) {
    Lobe lobe;
    const float alpha = roughness * roughness;
    lobe.f0 = f0;
    lobe.alpha2 = alpha * alpha;
    lobe.view = view;
    lobe.cos_view = clamp(dot(n, view), brdf_least_cosine, 1.0f);
    lobe.fit = brdf_fit(roughness);
    // The mean of the fit over cosine-weighted directions: that of t^k is 2 / ((k + 1) (k + 2)).
    lobe.under = (1.0f - brdf_fitted(lobe.fit, lobe.cos_view)) / (1.0f - brdf_dielectric - lobe.fit.x / 21.0f - lobe.fit.y / 10.0f);
    return lobe;
}
MYRIAD_FN Lobe lobe_of(Gloss g, vec3 n) {
    if (is_matte(g)) return matte_lobe();
    return lobe_of(vec3(unpack_low(g.f0_rg), unpack_high(g.f0_rg), unpack_low(g.f0_b_roughness)), unpack_high(g.f0_b_roughness),
                   unpack_direction(g.view), n);
}

// Schlick (1994), of the power that reflectance_of returns: f0 (1 - power) + power.
MYRIAD_FN vec3 brdf_fresnel(vec3 f0, float power) { return f0 + power * (vec3(1.0f) - f0); }

// How light of the unit direction l, from above the surface, is reflected to the eye: radiance is irradiance times
//     albedo / pi * diffuse + brdf_fresnel(f0, power) * glossy          (glossy in 1/sr)
// The lobe is that of a surface whose alpha^2 is greater by `widen`: for light that comes from more than one direction.
struct Reflectance {
    float diffuse, glossy, power;
};
MYRIAD_FN Reflectance reflectance_of(Lobe lobe, vec3 n, vec3 l, float widen) {
    Reflectance r;
    r.diffuse = 1.0f;
    r.glossy = 0.0f;
    r.power = 0.0f;
    if (lobe.alpha2 == 0.0f) return r;
    const float cos_light = clamp(dot(n, l), brdf_least_cosine, 1.0f);
    r.diffuse = (1.0f - brdf_fitted(lobe.fit, cos_light)) * lobe.under;

    const float a2 = min(lobe.alpha2 + widen, 1.0f);
    const vec3 sum = l + lobe.view;                    // along the half-way vector
    const float squared = max(dot(sum, sum), 1e-30f);  // 0 where the ways are opposite, both along the surface
    // Trowbridge and Reitz's distribution, a2 / (pi (cos^2 (a2 - 1) + 1)^2), with sines: 1 - cos^2 would cancel where the lobe is narrow.
    const vec3 across = cross(n, sum);
    const float along = dot(n, sum);
    const float width = max((a2 * along * along + dot(across, across)) / squared, a2);
    const float distribution = a2 / (pi * width * width);
    // Smith's masking of both ways, correlated by height (Heitz 2014), over 4 cos cos.
    const float visible = 0.5f / (cos_light * sqrt(lobe.cos_view * lobe.cos_view * (1.0f - a2) + a2) +
                                  lobe.cos_view * sqrt(cos_light * cos_light * (1.0f - a2) + a2));
    r.glossy = distribution * visible;
    // The cosine of view and half-way vector is half the sum's length.
    const float away = 1.0f - min(0.5f * sqrt(squared), 1.0f);
    const float away2 = away * away;
    r.power = away2 * away2 * away;
    return r;
}

// About what the glossy lobe reflects of even light: what a filter divides by, so that it does not blur materials.
MYRIAD_FN vec3 glossy_albedo(Lobe lobe) {
    return brdf_fresnel(lobe.f0, (brdf_fitted(lobe.fit, lobe.cos_view) - brdf_dielectric) / (1.0f - brdf_dielectric));
}
MYRIAD_END

#ifdef __cplusplus
static_assert(sizeof(myriad::Gloss) == 12);
#endif

#endif
