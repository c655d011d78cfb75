// How a surface reflects: glTF 2.0's metallic-roughness material (its Appendix B), evaluated and sampled; what Myriad adds to it is in README.md.
#pragma once

#include <vector>

#include "tools/reference/surface.hpp"

namespace myriad::reference {

enum class Model {
    gltf,     // a GGX lobe over a diffuse base
    diffuse,  // the base alone
};

// What a dielectric's lobe reflects of light that comes evenly from everywhere, and the mean of that over cosine-weighted directions: integrated
// once, looked up by cosine and roughness.
class Albedos {
public:
    static const Albedos& all();  // made when first asked for
    float at(float cosine, float roughness) const;
    float mean(float roughness) const;

private:
    Albedos();
    static constexpr int cosines = 64, roughnesses = 32;
    float row(int i, float cosine) const;
    std::vector<float> table_, means_;
};

// A surface's reflection towards a viewer. Directions are in the world, unit, away from the surface.
class Brdf {
public:
    Brdf(const Surface& surface, const vec3& view, Model model);

    bool black() const { return diffuse_ == vec3(0) && !glossy_; }
    // The reflected radiance of radiance from `l` over a small solid angle: 1/sr, times the cosine. 0 from below the surface.
    vec3 times_cosine(const vec3& l) const;
    float density(const vec3& l) const;  // of sample(), 1/sr

    struct Sample {
        vec3 direction;
        vec3 weight;      // times_cosine / density
        float density;    // 0: nothing comes of it
    };
    Sample sample(float choice, const vec2& x) const;

private:
    vec3 local(const vec3& v) const { return {glm::dot(v, x_), glm::dot(v, y_), glm::dot(v, z_)}; }
    vec3 world(const vec3& v) const { return v.x * x_ + v.y * y_ + v.z * z_; }

    vec3 x_, y_, z_;          // a frame, z_ the shading normal
    vec3 geometric_;
    vec3 view_;               // in the frame
    vec3 diffuse_;            // albedo
    vec3 f0_{0};
    bool glossy_ = false;
    float alpha_ = 0, roughness_ = 0, under_ = 1, choose_glossy_ = 0;
};

// Trowbridge and Reitz's distribution of facets of a local half-way vector, Smith's masking of one way (local), and of both, by height.
float facets(const vec3& half, float alpha);
float masking(float cosine, float alpha);
float masking(float cosine, float other, float alpha);
// A facet as seen from `view`, in proportion to its visible area (Heitz, "Sampling the GGX Distribution of Visible Normals", 2018).
vec3 visible_facet(const vec3& view, float alpha, const vec2& x);

// Two vectors that make a right-handed frame with the unit vector n (Duff et al. 2017).
void complete_frame(const vec3& n, vec3& x, vec3& y);
// By cosine around +z.
vec3 cosine_direction(const vec2& x);

}  // namespace myriad::reference
