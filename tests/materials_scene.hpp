// A small yard in which every kind of surface that glTF knows is seen, built in code. Tests only.
#pragma once

#include <cmath>
#include <functional>

#include <glm/gtc/matrix_transform.hpp>

#include "scenes/scene.hpp"

namespace myriad::tests {

// Textures are drawn by functions of the place in [0, 1)^2 (v down), in sRGB and alpha, or in tangent space.
class MaterialsScene {
public:
    using vec2 = glm::vec2;
    using vec3 = glm::vec3;
    using vec4 = glm::vec4;
    using Alpha = scenes::Material::Alpha;

    static scenes::Scene make() { return MaterialsScene().scene_; }

private:
    MaterialsScene() {
        scene_.name = "materials";
        scene_.background = {0.35f, 0.5f, 0.8f};
        floor(), wall(), fence(), plant(), sign(), cube(), pane(), lamp();
        scene_.lights.push_back({scenes::Light::Type::directional, "sun", vec3(0), glm::normalize(vec3(-0.5f, -1, -0.6f)), vec3(5, 4.6f, 4)});
        const glm::dmat4 to_world = glm::inverse(glm::lookAt(glm::dvec3(0.6, 1.9, 5.6), glm::dvec3(0, 0.85, 0), glm::dvec3(0, 1, 0)));
        scene_.cameras.push_back({"yard", glm::mat4(to_world), 0.75f});
    }

    uint32_t texture(uint32_t width, uint32_t height, const std::function<vec4(vec2)>& color) {
        scenes::Texture t;
        t.width = width, t.height = height;
        for (uint32_t y = 0; y < height; ++y)
            for (uint32_t x = 0; x < width; ++x) {
                const vec4 c = glm::clamp(color(vec2(float(x) + 0.5f, float(y) + 0.5f) / vec2(width, height)), 0.0f, 1.0f);
                for (int k = 0; k < 4; ++k) t.rgba.push_back(uint8_t(std::lround(c[k] * 255)));
            }
        scene_.textures.push_back(t);
        return uint32_t(scene_.textures.size() - 1);
    }
    scenes::Material& material(const char* name, const vec3& color) {
        scenes::Material m;
        m.name = name, m.base_color = vec4(color, 1), m.metallic = 0, m.double_sided = true;
        scene_.materials.push_back(m);
        scene_.meshes.push_back({name, {{}}});
        scene_.meshes.back().primitives[0].material = uint32_t(scene_.materials.size() - 1);
        scene_.instances.push_back({uint32_t(scene_.meshes.size() - 1), glm::mat4(1)});
        return scene_.materials.back();
    }
    // A part of the last material's mesh; v falls along `up`.
    scenes::Primitive& quad(const vec3& corner, const vec3& along, const vec3& up, const vec2& uv_lo = vec2(0), const vec2& uv_hi = vec2(1)) {
        scenes::Primitive& p = scene_.meshes.back().primitives[0];
        const uint32_t n = uint32_t(p.positions.size());
        p.positions.insert(p.positions.end(), {corner, corner + along, corner + along + up, corner + up});
        p.normals.insert(p.normals.end(), 4, glm::normalize(glm::cross(along, up)));
        p.texcoords.insert(p.texcoords.end(), {{uv_lo.x, uv_hi.y}, uv_hi, {uv_hi.x, uv_lo.y}, uv_lo});
        p.indices.insert(p.indices.end(), {n, n + 1, n + 2, n, n + 2, n + 3});
        return p;
    }

    void floor() {  // slabs, by a transform that repeats and turns them
        scenes::Material& m = material("slabs", {0.8f, 0.78f, 0.75f});
        const float c = 2.5f * std::cos(0.4f), s = 2.5f * std::sin(0.4f);
        m.base_color_texture = {.texture = texture(32, 32, [](vec2 p) {
                                    const bool joint = std::min(p.x, p.y) < 0.06f;
                                    return joint ? vec4(0.35f, 0.33f, 0.3f, 1) : vec4(vec3((p.x < 0.53f) == (p.y < 0.53f) ? 0.85f : 0.7f), 1);
                                }),
                                .transform = glm::mat3x2(c, s, -s, c, 0.1f, 0.3f)};
        quad({-4, 0, 3}, {8, 0, 0}, {0, 0, -6});
    }
    void wall() {  // studs, by a normal texture alone
        scenes::Material& m = material("studded wall", {0.7f, 0.5f, 0.4f});
        m.normal_texture = {.texture = texture(32, 32, [](vec2 p) {
                                const vec2 d = (p - 0.5f) / 0.36f;
                                const float r = glm::length(d);
                                const vec2 tilt = r < 1 && r > 0 ? 0.7f * std::sin(3.14159f * r) * d / r : vec2(0);
                                return vec4(0.5f + 0.5f * glm::normalize(vec3(tilt.x, -tilt.y, 1)), 1);
                            }),
                            .transform = glm::mat3x2(10, 0, 0, 4, 0, 0)};
        m.normal_scale = 1.2f;
        quad({-4, 0, -2.5f}, {8, 0, 0}, {0, 2.2f, 0});
    }
    void fence() {  // laths that are cut out of one quad, in front of the sun
        scenes::Material& m = material("fence", {0.9f, 0.85f, 0.8f});
        m.alpha = Alpha::mask;
        m.base_color_texture = {.texture = texture(64, 64, [](vec2 p) {
                                    const float lath = std::abs(p.x - 0.5f), bar = std::min(std::abs(p.y - 0.3f), std::abs(p.y - 0.75f));
                                    const bool there = (lath < 0.27f && p.y > 0.04f + 0.3f * lath) || bar < 0.06f;
                                    return vec4(0.8f, 0.78f, 0.72f, there ? 1 : 0);
                                })};
        scene_.textures.back().wrap_v = scenes::Texture::Wrap::clamp;
        quad({1.0f, 0, 1.6f}, {2.6f, 0, -1.2f}, {0, 1.1f, 0}, {0, 0}, {9, 1});
    }
    void plant() {  // cards of leaves, in three instances, one of them mirrored
        scenes::Material& m = material("leaves", vec3(1));
        m.alpha = Alpha::mask, m.alpha_cutoff = 0.4f;
        m.base_color_texture = {.texture = texture(64, 64, [](vec2 p) {
            float alpha = 0;
            for (int i = 0; i < 7; ++i) {  // leaves around the middle
                const float a = 0.9f * float(i), c = std::cos(a), s = std::sin(a);
                const vec2 d = p - 0.5f, q(c * d.x + s * d.y, c * d.y - s * d.x);
                const float along = (q.x - 0.24f) / 0.24f, across = q.y / (0.085f * (1 - 0.3f * along));
                alpha = std::max(alpha, 1.2f - along * along - across * across);
            }
            return vec4(0.3f + 0.2f * p.x, 0.62f - 0.1f * p.y, 0.2f, alpha);
        })};
        for (int i = 0; i < 14; ++i) {
            const float turn = 2.4f * float(i), height = 0.25f + 0.07f * float(i), size = 0.75f - 0.03f * float(i);
            const vec3 along(std::cos(turn), 0.25f, std::sin(turn)), up = glm::normalize(glm::cross(along, vec3(0.2f, 1, 0.3f)));
            quad(vec3(0, height, 0) - 0.5f * size * (glm::normalize(along) + up), size * glm::normalize(along), size * up);
        }
        scene_.instances.back().to_world = glm::translate(glm::mat4(1), {-2.2f, 0, 0.6f});
        const uint32_t mesh = scene_.instances.back().mesh;
        scene_.instances.push_back({mesh, glm::rotate(glm::translate(glm::mat4(1), vec3(-3.1f, 0, -1.2f)), 1.0f, vec3(0, 1, 0))});
        scene_.instances.push_back({mesh, glm::scale(glm::translate(glm::mat4(1), vec3(2.6f, 0, -1.6f)), vec3(-1.2f, 1.3f, 1.2f))});
    }
    void sign() {  // unlit: the same in sun and shadow
        scenes::Material& m = material("sign", vec3(1));
        m.unlit = true;
        m.base_color_texture = {.texture = texture(32, 16, [](vec2 p) {
            const bool arrow = (p.x < 0.6f && std::abs(p.y - 0.5f) < 0.14f && p.x > 0.15f) || (p.x >= 0.6f && std::abs(p.y - 0.5f) < 0.36f * (0.88f - p.x) / 0.28f);
            return arrow ? vec4(0.98f, 0.95f, 0.8f, 1) : vec4(0.75f, 0.15f, 0.1f, 1);
        })};
        quad({-0.9f, 1.25f, -2.3f}, {1.3f, 0, 0}, {0, 0.65f, 0});
    }
    void cube() {  // vertex colours, with a texture on the second set
        scenes::Material& m = material("painted cube", vec3(0.95f));
        m.base_color_texture = {.texture = texture(16, 16, [](vec2 p) { return vec4(vec3(std::fmod(4 * p.x + 4 * p.y, 1.0f) < 0.5f ? 1.0f : 0.75f), 1); }), .set = 1};
        const vec3 lo(-0.9f, 0, -0.4f), e(0.8f), x(e.x, 0, 0), y(0, e.y, 0), z(0, 0, e.z);
        quad(lo + z, x, y), quad(lo + x + z, -z, y), quad(lo, z, y), quad(lo + x, -x, y);
        scenes::Primitive& p = quad(lo + y + z, x, -z);
        for (const vec3& at : p.positions) p.colors.emplace_back((at - lo) / e * 0.9f + 0.05f, 1);
        for (const vec2& uv : p.texcoords) p.texcoords1.push_back(uv * vec2(2, 1));
    }
    void pane() {  // tinted glass, as files have it
        scenes::Material& m = material("pane", {0.15f, 0.6f, 0.45f});
        m.alpha = Alpha::blend, m.base_color.a = 0.45f;
        quad({0.2f, 0, 0.9f}, {0.75f, 0, -0.9f}, {0, 1.3f, 0});
    }
    void lamp() {  // a strip of lights, by a transform of a texture and cut out of its quad
        scenes::Material& m = material("lamps", vec3(0));
        m.alpha = Alpha::mask, m.emissive = {30, 18, 7};
        m.emissive_texture = {.texture = texture(16, 16, [](vec2 p) { return vec4(vec3(glm::length(p - 0.5f) < 0.4f ? 1.0f : 0.0f), glm::length(p - 0.5f) < 0.44f); }),
                              .transform = glm::mat3x2(6, 0, 0, 1, 0, 0)};
        m.base_color_texture = m.emissive_texture;
        quad({-3.4f, 1.9f, -2.3f}, {1.8f, 0, 0}, {0, 0.3f, 0});
    }

    scenes::Scene scene_;
};

}  // namespace myriad::tests
