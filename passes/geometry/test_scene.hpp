// Small scenes for the tests of this room, made triangle by triangle, and what of them is on the device.
#pragma once

#include <random>

#include "compute/raytrace/bvh.hpp"
#include "passes/geometry/geometry.hpp"
#include "passes/geometry/lights.hpp"

namespace myriad::passes {

struct TestScene {
    scenes::Scene scene;
    scenes::Triangles triangles;

    uint32_t material(const vec3& albedo, const vec3& emission = vec3(0), bool double_sided = false) {
        scenes::Material m;
        m.base_color = vec4(albedo, 1);
        m.metallic = 0;
        m.emissive = emission;
        m.double_sided = double_sided;
        scene.materials.push_back(m);
        return uint32_t(scene.materials.size() - 1);
    }

    uint32_t texture(uint32_t width, uint32_t height, std::mt19937& random, scenes::Texture::Wrap u = {}, scenes::Texture::Wrap v = {}) {
        scenes::Texture t;
        t.width = width, t.height = height, t.wrap_u = u, t.wrap_v = v;
        for (uint32_t i = 0; i < 4 * width * height; ++i) t.rgba.push_back(uint8_t(random()));
        scene.textures.push_back(t);
        return uint32_t(scene.textures.size() - 1);
    }

    uint32_t vertex(const vec3& p, const vec3& n, const vec2& uv = vec2(0)) {
        triangles.lo = triangles.positions.empty() ? p : glm::min(triangles.lo, p);
        triangles.hi = triangles.positions.empty() ? p : glm::max(triangles.hi, p);
        triangles.positions.push_back(p);
        triangles.normals.push_back(n);
        triangles.texcoords.push_back(uv);
        return uint32_t(triangles.positions.size() - 1);
    }

    // Gives all vertices that there are colours, a second set and tangents, some of which there are none of.
    void decorate(std::mt19937& random) {
        std::uniform_real_distribution<float> unit(0, 1);
        const auto any = [&] { return vec3(unit(random), unit(random), unit(random)); };
        for (size_t i = triangles.colors.size(); i < triangles.positions.size(); ++i) {
            triangles.colors.emplace_back(any(), random() % 3 ? 1 : unit(random));
            triangles.texcoords1.push_back(2.0f * vec2(any()));
            const bool none = i / 3 % 4 == 0;
            triangles.tangents.emplace_back(none ? vec3(0) : glm::normalize(any() - 0.5f), random() % 2 ? 1 : -1);
        }
    }

    // A material that has a texture of noise in every place, with transforms, on both sets.
    scenes::Material& textured(std::mt19937& random, scenes::Texture::Wrap u = {}, scenes::Texture::Wrap v = {}) {
        std::uniform_real_distribution<float> unit(-1, 1);
        const uint32_t index = material({0.9f, 1, 0.8f}, {1, 1, 2}, u == scenes::Texture::Wrap::mirror);
        const auto use = [&](uint32_t width, uint32_t height) {
            scenes::TextureUse to{texture(width, height, random, u, v), uint32_t(random() % 2)};
            if (random() % 2) to.transform = glm::mat3x2(vec2(1, unit(random)), vec2(unit(random), 1), vec2(unit(random), unit(random)));
            return to;
        };
        scenes::Material& m = scene.materials[index];
        m.metallic = 0.6f;
        m.base_color_texture = use(7, 5), m.metallic_roughness_texture = use(1, 3), m.emissive_texture = use(16, 1), m.normal_texture = use(4, 4);
        m.normal_scale = 0.5f;
        return m;
    }

    // Its front is where `along` turns to `up` counter-clockwise. Texture coordinates go from uv0 to uv1.
    void quad(const vec3& corner, const vec3& along, const vec3& up, uint32_t material, vec2 uv0 = vec2(0), vec2 uv1 = vec2(1)) {
        const vec3 n = glm::normalize(glm::cross(along, up));
        const uint32_t a = vertex(corner, n, uv0), b = vertex(corner + along, n, {uv1.x, uv0.y});
        const uint32_t c = vertex(corner + along + up, n, uv1), d = vertex(corner + up, n, {uv0.x, uv1.y});
        triangles.triangles.emplace_back(a, b, c, material);
        triangles.triangles.emplace_back(a, c, d, material);
    }

    // Closed, seen from inside.
    void room(const vec3& lo, const vec3& hi, uint32_t material) {
        const vec3 e = hi - lo, x(e.x, 0, 0), y(0, e.y, 0), z(0, 0, e.z);
        quad(lo, y, z, material), quad(lo, z, x, material), quad(lo, x, y, material);
        quad(hi, -z, -y, material), quad(hi, -x, -z, material), quad(hi, -y, -x, material);
    }

    // Triangles of about the unit size in a cube of +-`extent`, with normals that are not those of the faces.
    void soup(size_t count, float extent, std::mt19937& random) {
        std::uniform_real_distribution<float> unit(-1, 1);
        const auto point = [&](float s) { return s * vec3(unit(random), unit(random), unit(random)); };
        for (size_t i = 0; i < count; ++i) {
            const vec3 p = point(extent);
            const vec3 a = p + point(1), b = p + point(1), c = p + point(1);
            const vec3 n = glm::normalize(glm::cross(b - a, c - a));
            const auto corner = [&](const vec3& at) { return vertex(at, glm::normalize(n + point(0.4f)), 3.0f * vec2(unit(random), unit(random))); };
            const uint32_t first = corner(a);
            corner(b), corner(c);
            triangles.triangles.emplace_back(first, first + 1, first + 2, uint32_t(random() % scene.materials.size()));
        }
    }

    void light(scenes::Light::Type type, const vec3& position, const vec3& direction, const vec3& intensity, float inner = 0, float outer = 0.785398f) {
        scene.lights.push_back({type, "", position, glm::normalize(direction), intensity, inner, outer});
    }

    void look(const vec3& from, const vec3& at, float yfov = 0.8f) {
        const vec3 z = glm::normalize(from - at), x = glm::normalize(glm::cross(vec3(0.1f, 1, 0.05f), z));
        scene.cameras = {{"", mat4(vec4(x, 0), vec4(glm::cross(z, x), 0), vec4(z, 0), vec4(from, 1)), yfov}};
    }
};

struct UploadedScene {
    GeometryData data;
    Geometry geometry;
    compute::Bvh bvh;
    LightTable lights;

    UploadedScene(engine::Device& device, const TestScene& from, bool points_apart = false)
        : data(geometry_data(from.scene, from.triangles)), geometry(device, from.triangles, data),
          bvh(device, data.world, compute::BvhQuality::quick, geometry.opacity()),
          lights(device, from.scene, from.triangles, data, points_apart) {}
};

}  // namespace myriad::passes
