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

glm::dvec4 texture_ref(const scenes::Texture& texture, dvec2 uv, bool srgb) {
    const dvec2 at = uv * dvec2(texture.width, texture.height) - 0.5;
    glm::dvec4 sum(0);
    for (int dy = 0; dy < 2; ++dy)
        for (int dx = 0; dx < 2; ++dx) {
            const dvec2 corner = glm::floor(at) + dvec2(dx, dy);
            const dvec2 weight = 1.0 - glm::abs(at - corner);
            const int64_t x = wrapped(int64_t(corner.x), texture.width, texture.wrap_u);
            const int64_t y = wrapped(int64_t(corner.y), texture.height, texture.wrap_v);
            const uint8_t* c = &texture.rgba[4 * (y * texture.width + x)];
            sum += weight.x * weight.y * glm::dvec4(decode(c[0], srgb), decode(c[1], srgb), decode(c[2], srgb), c[3] / 255.0);
        }
    return sum;
}

namespace {

// What the vertices of a triangle say of a point of it, and what textures do.
struct PointRef {
    const scenes::Scene& scene;
    const scenes::Triangles& triangles;
    glm::uvec4 corners;
    double u, v;

    template <class T>
    auto blend(const std::vector<T>& of) const {
        using D = glm::vec<T::length(), double>;
        return (1 - u - v) * D(of[corners.x]) + u * D(of[corners.y]) + v * D(of[corners.z]);
    }
    const std::vector<glm::vec2>& set(const scenes::TextureUse& use) const {
        return use.set == 1 && !triangles.texcoords1.empty() ? triangles.texcoords1 : triangles.texcoords;
    }
    dvec2 on_texture(const scenes::TextureUse& use, const dvec2& uv) const { return glm::dmat3x2(use.transform) * dvec3(uv, 1); }
    glm::dvec4 texel(const scenes::TextureUse& use, bool srgb) const {
        if (use.texture == scenes::none) return glm::dvec4(1);
        return texture_ref(scene.textures[use.texture], on_texture(use, blend(set(use))), srgb);
    }
    glm::dvec4 color() const { return triangles.colors.empty() ? glm::dvec4(1) : glm::dvec4(blend(triangles.colors)); }
};

// The vertex normal, bent by the normal texture: the derivatives of the position along u and against v span its image.
dvec3 bent(const PointRef& at, const scenes::Material& m, const dvec3& normal) {
    const glm::uvec4 c = at.corners;
    const auto& tangents = at.triangles.tangents;
    dvec3 right(0), up(0);
    if (!tangents.empty() && dvec3(tangents[c.x]) != dvec3(0) && dvec3(tangents[c.y]) != dvec3(0) && dvec3(tangents[c.z]) != dvec3(0)) {
        right = dvec3(at.blend(tangents));
        right -= normal * glm::dot(normal, right);
        up = glm::cross(normal, right) * double(tangents[c.x].w);
    } else {
        const auto& uvs = at.set(m.normal_texture);
        const dvec2 p = at.on_texture(m.normal_texture, dvec2(uvs[c.x]));
        const glm::dmat2 along(at.on_texture(m.normal_texture, dvec2(uvs[c.y])) - p, at.on_texture(m.normal_texture, dvec2(uvs[c.z])) - p);
        if (glm::determinant(along) == 0) return normal;
        const glm::dmat2 inverse = glm::inverse(along);
        const dvec3 o(at.triangles.positions[c.x]), e1 = dvec3(at.triangles.positions[c.y]) - o, e2 = dvec3(at.triangles.positions[c.z]) - o;
        const dvec3 by_u = inverse[0].x * e1 + inverse[0].y * e2, by_v = inverse[1].x * e1 + inverse[1].y * e2;
        right = by_u - normal * glm::dot(normal, by_u);
        up = glm::cross(normal, right);
        if (glm::dot(glm::cross(by_u, by_v), glm::cross(e1, e2)) * glm::dot(normal, glm::cross(e1, e2)) > 0) up = -up;
    }
    if (glm::length(right) == 0) return normal;
    const dvec3 t = 2.0 * dvec3(at.texel(m.normal_texture, false)) - 1.0;
    return unit(double(m.normal_scale) * (t.x * glm::normalize(right) + t.y * glm::normalize(up)) + t.z * normal, normal);
}

}  // namespace

double alpha_ref(const scenes::Scene& scene, const scenes::Triangles& triangles, uint32_t triangle, double u, double v) {
    const PointRef at{scene, triangles, triangles.triangles[triangle], u, v};
    const scenes::Material& m = scene.materials[at.corners.w];
    return m.base_color.a * at.color().a * at.texel(m.base_color_texture, true).a;
}

ThereRef there_ref(const scenes::Scene& scene, const scenes::Triangles& triangles, uint dice) {
    return [&scene, &triangles, dice](uint32_t triangle, double u, double v) {
        const scenes::Material& m = scene.materials[triangles.triangles[triangle].w];
        if (m.alpha == scenes::Material::Alpha::opaque) return true;
        const double alpha = alpha_ref(scene, triangles, triangle, u, v);
        return m.alpha == scenes::Material::Alpha::mask ? alpha >= m.alpha_cutoff : alpha > opacity_threshold(triangle, float(u), float(v), dice);
    };
}

SurfaceRef surface_ref(const scenes::Scene& scene, const scenes::Triangles& triangles, uint32_t triangle, double u, double v) {
    const PointRef at{scene, triangles, triangles.triangles[triangle], u, v};
    const glm::uvec4 t = at.corners;
    const auto& p = triangles.positions;
    const scenes::Material& m = scene.materials[t.w];

    SurfaceRef s;
    s.position = at.blend(p);
    s.geometric_normal = unit(glm::cross(dvec3(p[t.y]) - dvec3(p[t.x]), dvec3(p[t.z]) - dvec3(p[t.x])), dvec3(0, 1, 0));
    const dvec3 normal = unit(at.blend(triangles.normals), s.geometric_normal);
    s.shading_normal = m.normal_texture.texture == scenes::none || m.unlit ? normal : bent(at, m, normal);
    if (glm::dot(normal, s.geometric_normal) < 0) s.shading_normal = -s.shading_normal;
    const dvec3 color = dvec3(m.base_color) * dvec3(at.color()) * dvec3(at.texel(m.base_color_texture, true));
    const glm::dvec4 texel = at.texel(m.metallic_roughness_texture, false);
    const double metallic = m.metallic * texel.z, roughness = m.roughness * texel.y;
    s.albedo = m.unlit ? dvec3(0) : color * (1 - metallic);
    const bool matte = m.unlit || (metallic == 0 && roughness >= double(0.9f));
    if (!matte) s.gloss = {glm::mix(dvec3(0.04), color, metallic), std::max(roughness, 0.045)};
    s.emission = m.unlit ? color : dvec3(m.emissive) * dvec3(at.texel(m.emissive_texture, true));
    s.double_sided = m.double_sided || m.unlit;
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
HitRef closest_ref(const scenes::Triangles& triangles, const dvec3& origin, const dvec3& direction, double t_min, double t_max, const ThereRef& there) {
    HitRef hit;
    hit.t = t_max;
    for (uint32_t i = 0; i < triangles.triangles.size(); ++i) {
        const glm::uvec4 t = triangles.triangles[i];
        const dvec3 p(triangles.positions[t.x]), e1 = dvec3(triangles.positions[t.y]) - p, e2 = dvec3(triangles.positions[t.z]) - p;
        const dvec3 q = glm::cross(direction, e2), o = origin - p, r = glm::cross(o, e1);
        const double det = glm::dot(e1, q);
        if (det == 0) continue;
        const double u = glm::dot(o, q) / det, v = glm::dot(direction, r) / det, at = glm::dot(e2, r) / det;
        if (u >= 0 && v >= 0 && u + v <= 1 && at > t_min && at < hit.t && (!there || there(i, u, v))) hit = {at, i, u, v};
    }
    return hit;
}

}  // namespace myriad::passes
