#include "tools/reference/surface.hpp"

#include <algorithm>
#include <cmath>

namespace myriad::reference {
namespace {

using scenes::Material;
using scenes::Texture;

// IEC 61966-2-1.
double decoded(double code) { return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4); }

// Texel number i of n along an axis, wherever the pattern goes on.
uint32_t wrapped(int64_t i, uint32_t size, Texture::Wrap wrap) {
    const int64_t n = size;
    if (wrap == Texture::Wrap::clamp) return uint32_t(std::clamp<int64_t>(i, 0, n - 1));
    if (wrap == Texture::Wrap::repeat) return uint32_t((i % n + n) % n);
    const int64_t folded = (i % (2 * n) + 2 * n) % (2 * n);
    return uint32_t(folded < n ? folded : 2 * n - 1 - folded);
}

struct Pair {
    uint32_t low, high;
    float weight;  // of high
};
Pair pair_at(double place, uint32_t size, Texture::Wrap wrap) {
    if (!(std::abs(place) < 16777216)) place = 0;  // floats have no fraction there, or it is no number
    const double at = place * size - 0.5, whole = std::floor(at);
    return {wrapped(int64_t(whole), size, wrap), wrapped(int64_t(whole) + 1, size, wrap), float(at - whole)};
}

template <class T>
T blend(const T& a, const T& b, const T& c, float u, float v) { return (1 - u - v) * a + u * b + v * c; }

}  // namespace

vec3 unit_or(const vec3& v, const vec3& fallback) {
    const glm::dvec3 wide(v);
    const double length = glm::length(wide);
    return length > 0 ? vec3(wide / length) : fallback;
}

Surfaces::Surfaces(const scenes::Scene& scene, const scenes::Triangles& triangles) : scene_(scene), triangles_(triangles) {
    for (int i = 0; i < 256; ++i) linear_[size_t(i)] = float(decoded(i / 255.0));
    for (const Material& m : scene.materials) {
        glm::dvec3 mean(m.unlit ? vec3(0) : m.emissive);
        if (mean != glm::dvec3(0) && m.emissive_texture.texture != scenes::none) {
            const Texture& t = scene.textures[m.emissive_texture.texture];
            glm::dvec3 sum(0);
            for (size_t i = 0; i + 3 < t.rgba.size(); i += 4) sum += glm::dvec3(linear_[t.rgba[i]], linear_[t.rgba[i + 1]], linear_[t.rgba[i + 2]]);
            mean *= sum / double(std::max<size_t>(t.rgba.size() / 4, 1));
        }
        means_.push_back(vec3(mean));
    }
}

std::array<vec3, 3> Surfaces::corners(uint32_t triangle) const {
    const glm::uvec4& t = triangles_.triangles[triangle];
    return {triangles_.positions[t.x], triangles_.positions[t.y], triangles_.positions[t.z]};
}

// What is rounded are the corners less the ray's origin, and their products: with a dozen operations, each by half an ulp of 2^-24, of at most
// the corners' distance from one another or from the world's origin (a bound in the manner of Pharr, Jakob and Humphreys, 2016, section 3.9).
float Surfaces::error_of(const std::array<vec3, 3>& p) {
    const vec3 most = glm::max(glm::max(glm::abs(p[0]), glm::abs(p[1])), glm::abs(p[2])), extent = glm::max(glm::abs(p[1] - p[0]), glm::abs(p[2] - p[0]));
    constexpr float gamma = 16 * 0x1p-24f;
    return gamma * (std::max({most.x, most.y, most.z}) + std::max({extent.x, extent.y, extent.z}));
}

vec2 Surfaces::coordinates(uint32_t triangle, uint32_t set, float u, float v) const {
    const std::vector<vec2>& of = set == 0 ? triangles_.texcoords : triangles_.texcoords1;
    if (of.empty()) return vec2(0);
    const glm::uvec4& t = triangles_.triangles[triangle];
    return blend(of[t.x], of[t.y], of[t.z], u, v);
}

vec4 Surfaces::texel(const Texture& t, vec2 place, bool srgb) const {
    const Pair x = pair_at(place.x, t.width, t.wrap_u), y = pair_at(place.y, t.height, t.wrap_v);
    const auto read = [&](uint32_t column, uint32_t row) {
        const uint8_t* c = &t.rgba[4 * (size_t(row) * t.width + column)];
        if (srgb) return vec4(linear_[c[0]], linear_[c[1]], linear_[c[2]], float(c[3]) / 255.0f);
        return vec4(c[0], c[1], c[2], c[3]) / 255.0f;
    };
    return glm::mix(glm::mix(read(x.low, y.low), read(x.high, y.low), x.weight), glm::mix(read(x.low, y.high), read(x.high, y.high), x.weight), y.weight);
}

vec4 Surfaces::look_up(const scenes::TextureUse& use, uint32_t triangle, float u, float v, bool srgb) const {
    if (use.texture == scenes::none) return vec4(1);
    return texel(scene_.textures[use.texture], use.transform * vec3(coordinates(triangle, use.set, u, v), 1), srgb);
}

bool Surfaces::partial(uint32_t triangle) const {
    const Material& m = scene_.materials[material_of(triangle)];
    return m.alpha != Material::Alpha::opaque && (m.base_color.a < 1 || m.base_color_texture.texture != scenes::none || !triangles_.colors.empty());
}

float Surfaces::opacity(uint32_t triangle, float u, float v) const {
    const Material& m = scene_.materials[material_of(triangle)];
    if (m.alpha == Material::Alpha::opaque) return 1;
    float alpha = m.base_color.a * look_up(m.base_color_texture, triangle, u, v, true).a;
    const glm::uvec4& t = triangles_.triangles[triangle];
    if (!triangles_.colors.empty()) alpha *= blend(triangles_.colors[t.x].a, triangles_.colors[t.y].a, triangles_.colors[t.z].a, u, v);
    if (m.alpha == Material::Alpha::mask) return alpha >= m.alpha_cutoff ? 1 : 0;
    return std::clamp(alpha, 0.0f, 1.0f);
}

bool Surfaces::emits(uint32_t triangle) const { return mean_emission(triangle) != vec3(0); }

vec3 Surfaces::emission(uint32_t triangle, float u, float v) const {
    if (!emits(triangle)) return vec3(0);
    const Material& m = scene_.materials[material_of(triangle)];
    return m.emissive * vec3(look_up(m.emissive_texture, triangle, u, v, true));
}

// glTF: the bitangent is cross(normal, tangent) * w; without tangents they follow the texture's axes, +Y of the normal up in its image, where v falls.
vec3 Surfaces::bent(const Material& m, uint32_t triangle, float u, float v, const std::array<vec3, 3>& p, vec3 normal, float winding) const {
    const glm::uvec4& t = triangles_.triangles[triangle];
    vec3 tangent(0);
    float side = 1;
    if (const auto& all = triangles_.tangents; !all.empty() && vec3(all[t.x]) != vec3(0) && vec3(all[t.y]) != vec3(0) && vec3(all[t.z]) != vec3(0)) {
        tangent = blend(vec3(all[t.x]), vec3(all[t.y]), vec3(all[t.z]), u, v);
        side = all[t.x].w;
    } else {
        const auto& use = m.normal_texture;
        const auto corner = [&](float cu, float cv) { return glm::dvec2(use.transform * vec3(coordinates(triangle, use.set, cu, cv), 1)); };
        const glm::dvec2 t0 = corner(0, 0), a = corner(1, 0) - t0, b = corner(0, 1) - t0;
        const double det = a.x * b.y - a.y * b.x;
        if (det == 0) return normal;
        tangent = vec3((b.y * glm::dvec3(p[1] - p[0]) - a.y * glm::dvec3(p[2] - p[0])) / det);
        side = det > 0 ? -winding : winding;
    }
    tangent = unit_or(tangent - glm::dot(tangent, normal) * normal, vec3(0));
    if (tangent == vec3(0)) return normal;
    const vec3 bend = 2.0f * vec3(look_up(m.normal_texture, triangle, u, v, false)) - 1.0f;
    return unit_or(m.normal_scale * (bend.x * tangent + bend.y * side * glm::cross(normal, tangent)) + bend.z * normal, normal);
}

Surface Surfaces::at(uint32_t triangle, float u, float v, const vec3& d) const {
    const glm::uvec4& t = triangles_.triangles[triangle];
    const Material& m = scene_.materials[t.w];
    const std::array<vec3, 3> p = corners(triangle);
    Surface s;
    s.triangle = triangle;
    s.position = blend(p[0], p[1], p[2], u, v);
    s.geometric = unit_or(glm::cross(unit_or(p[1] - p[0], vec3(0)), unit_or(p[2] - p[0], vec3(0))), vec3(0, 1, 0));
    const auto& n = triangles_.normals;
    s.shading = unit_or(blend(n[t.x], n[t.y], n[t.z], u, v), s.geometric);
    const float winding = glm::dot(s.shading, s.geometric) < 0 ? -1.0f : 1.0f;  // decides the side, not the vertices' normals
    if (m.normal_texture.texture != scenes::none) s.shading = bent(m, triangle, u, v, p, s.shading, winding);
    s.shading *= winding;

    s.base = vec3(m.base_color) * vec3(look_up(m.base_color_texture, triangle, u, v, true));
    if (const auto& c = triangles_.colors; !c.empty()) s.base *= blend(vec3(c[t.x]), vec3(c[t.y]), vec3(c[t.z]), u, v);
    const bool behind = glm::dot(s.geometric, d) > 0;
    s.unlit = m.unlit;
    if (m.unlit) {
        s.emission = s.base;
    } else {
        const vec4 mr = look_up(m.metallic_roughness_texture, triangle, u, v, false);
        s.metallic = m.metallic * mr.b, s.roughness = m.roughness * mr.g;
        if (!behind || m.double_sided) s.emission = emission(triangle, u, v);
    }
    if (behind) s.geometric = -s.geometric, s.shading = -s.shading;
    // Back along the ray, too: where two surfaces meet, the one that was hit may lie behind the other by rounding.
    s.origin = s.position + error_of(p) * (s.geometric - d);
    // A normal that leans away from the eye is brought to the edge of what it sees.
    if (const float away = glm::dot(s.shading, d); away > 0) s.shading = unit_or(s.shading - away * d, s.geometric);
    return s;
}

}  // namespace myriad::reference
