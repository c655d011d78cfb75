// What lies at a point of a triangle: place, normals, and what its material's textures say there.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "scenes/scene.hpp"

namespace myriad::reference {

using glm::vec2;
using glm::vec3;
using glm::vec4;

struct Surface {
    uint32_t triangle = 0;
    vec3 position{0};
    vec3 geometric{0};      // unit normals, on the side that the ray came from
    vec3 shading{0};
    vec3 origin{0};         // where rays leave from: on that side, surely beyond the triangle's plane, and seen from where the ray came from
    vec3 base{0};           // base colour
    float metallic = 0, roughness = 1;
    vec3 emission{0};       // radiance towards where the ray came from; of unlit ones too, which only the camera sees
    bool unlit = false;
};

// Of all triangles in the world's space.
class Surfaces {
public:
    // Both stay where they are.
    Surfaces(const scenes::Scene& scene, const scenes::Triangles& triangles);

    // As a ray in direction `d` sees the point (1 - u - v) p0 + u p1 + v p2.
    Surface at(uint32_t triangle, float u, float v, const vec3& d) const;

    // Whether a triangle can be there in part, and how much of a point is: 0 or 1 where masked, alpha where blended.
    bool partial(uint32_t triangle) const;
    float opacity(uint32_t triangle, float u, float v) const;

    // Of emission: whether there is any, and the radiance of a point, from the front.
    bool emits(uint32_t triangle) const;
    vec3 emission(uint32_t triangle, float u, float v) const;
    const vec3& mean_emission(uint32_t triangle) const { return means_[material_of(triangle)]; }  // of its material over the whole texture
    bool double_sided(uint32_t triangle) const { return scene_.materials[material_of(triangle)].double_sided; }

    std::array<vec3, 3> corners(uint32_t triangle) const;
    uint32_t count() const { return uint32_t(triangles_.triangles.size()); }
    uint32_t material_of(uint32_t triangle) const { return triangles_.triangles[triangle].w; }
    // How far a ray's meeting with a triangle of these corners may be off, metres.
    static float error_of(const std::array<vec3, 3>& corners);

private:
    vec2 coordinates(uint32_t triangle, uint32_t set, float u, float v) const;
    vec4 texel(const scenes::Texture& texture, vec2 place, bool srgb) const;
    vec4 look_up(const scenes::TextureUse& use, uint32_t triangle, float u, float v, bool srgb) const;
    vec3 bent(const scenes::Material& material, uint32_t triangle, float u, float v, const std::array<vec3, 3>& p, vec3 normal, float winding) const;

    const scenes::Scene& scene_;
    const scenes::Triangles& triangles_;
    std::array<float, 256> linear_;  // of sRGB bytes
    std::vector<vec3> means_;        // emission, one a material
};

// Unit, or `fallback` where v has no direction. In double: squares of tiny lengths are no floats.
vec3 unit_or(const vec3& v, const vec3& fallback);

}  // namespace myriad::reference
