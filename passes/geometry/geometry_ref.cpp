#include "passes/geometry/geometry_ref.hpp"

#include <cmath>

namespace myriad::passes {

using glm::dvec2, glm::dvec3;

namespace {

double decode(uint8_t code, bool srgb) {
    const double c = code / 255.0;
    return !srgb ? c : c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

int64_t wrapped(int64_t i, int64_t n, scenes::Texture::Wrap wrap) {
    const auto modulo = [](int64_t a, int64_t b) { return (a % b + b) % b; };
    switch (wrap) {
        case scenes::Texture::Wrap::clamp: return std::min(std::max(i, int64_t(0)), n - 1);
        case scenes::Texture::Wrap::mirror: return modulo(i, 2 * n) < n ? modulo(i, 2 * n) : 2 * n - 1 - modulo(i, 2 * n);
        default: return modulo(i, n);
    }
}

dvec3 unit(const dvec3& v, const dvec3& otherwise) { return glm::length(v) > 0 ? glm::normalize(v) : otherwise; }

}  // namespace

dvec3 texture_ref(const scenes::Texture& texture, dvec2 uv, bool srgb) {
    const dvec2 at = uv * dvec2(texture.width, texture.height) - 0.5;
    dvec3 sum(0);
    for (int dy = 0; dy < 2; ++dy)
        for (int dx = 0; dx < 2; ++dx) {
            const dvec2 corner = glm::floor(at) + dvec2(dx, dy);
            const dvec2 weight = 1.0 - glm::abs(at - corner);
            const int64_t x = wrapped(int64_t(corner.x), texture.width, texture.wrap_u);
            const int64_t y = wrapped(int64_t(corner.y), texture.height, texture.wrap_v);
            const uint8_t* c = &texture.rgba[4 * (y * texture.width + x)];
            sum += weight.x * weight.y * dvec3(decode(c[0], srgb), decode(c[1], srgb), decode(c[2], srgb));
        }
    return sum;
}

SurfaceRef surface_ref(const scenes::Scene& scene, const scenes::Triangles& triangles, uint32_t triangle, double u, double v) {
    const glm::uvec4 t = triangles.triangles[triangle];
    const auto blend = [&](const auto& of) { return (1 - u - v) * dvec3(of[t.x]) + u * dvec3(of[t.y]) + v * dvec3(of[t.z]); };
    const auto& p = triangles.positions;
    const auto& uvs = triangles.texcoords;
    const dvec2 uv = (1 - u - v) * dvec2(uvs[t.x]) + u * dvec2(uvs[t.y]) + v * dvec2(uvs[t.z]);
    const scenes::Material& m = scene.materials[t.w];
    const auto texture = [&](uint32_t index, bool srgb) {
        return index == scenes::none ? dvec3(1) : texture_ref(scene.textures[index], uv, srgb);
    };

    SurfaceRef s;
    s.position = blend(p);
    s.geometric_normal = unit(glm::cross(dvec3(p[t.y]) - dvec3(p[t.x]), dvec3(p[t.z]) - dvec3(p[t.x])), dvec3(0, 1, 0));
    s.shading_normal = unit(blend(triangles.normals), s.geometric_normal);
    if (glm::dot(s.shading_normal, s.geometric_normal) < 0) s.shading_normal = -s.shading_normal;
    s.albedo = dvec3(m.base_color) * texture(m.base_color_texture.texture, true) * (1 - m.metallic * texture(m.metallic_roughness_texture.texture, false).z);
    s.emission = dvec3(m.emissive) * texture(m.emissive_texture.texture, true);
    s.double_sided = m.double_sided;
    return s;
}

SurfaceRef face_towards_ref(SurfaceRef s, const dvec3& direction) {
    if (glm::dot(s.geometric_normal, direction) > 0) {
        s.geometric_normal = -s.geometric_normal;
        s.shading_normal = -s.shading_normal;
        if (!s.double_sided) s.emission = dvec3(0);
    }
    const double away = glm::dot(s.shading_normal, direction);
    if (away > 0) s.shading_normal = unit(s.shading_normal - away * direction, s.geometric_normal);
    return s;
}

// Moeller and Trumbore 1997.
HitRef closest_ref(const scenes::Triangles& triangles, const dvec3& origin, const dvec3& direction, double t_min, double t_max) {
    HitRef hit;
    hit.t = t_max;
    for (uint32_t i = 0; i < triangles.triangles.size(); ++i) {
        const glm::uvec4 t = triangles.triangles[i];
        const dvec3 p(triangles.positions[t.x]), e1 = dvec3(triangles.positions[t.y]) - p, e2 = dvec3(triangles.positions[t.z]) - p;
        const dvec3 q = glm::cross(direction, e2), o = origin - p, r = glm::cross(o, e1);
        const double det = glm::dot(e1, q);
        if (det == 0) continue;
        const double u = glm::dot(o, q) / det, v = glm::dot(direction, r) / det, at = glm::dot(e2, r) / det;
        if (u >= 0 && v >= 0 && u + v <= 1 && at > t_min && at < hit.t) hit = {at, i, u, v};
    }
    return hit;
}

}  // namespace myriad::passes
