// Scenes for tests, made by hand. Tests only.
#pragma once

#include <glm/gtc/matrix_transform.hpp>

#include "scenes/scene.hpp"

namespace myriad::tests {

using glm::vec3;

struct Kit {
    scenes::Scene scene;

    Kit() {
        scene.name = "test";
        scene.meshes.push_back({"all", {}});
        scene.instances.push_back({0, glm::mat4(1)});
    }

    uint32_t material(const vec3& albedo, const vec3& emission = vec3(0)) {
        scenes::Material m;
        m.base_color = glm::vec4(albedo, 1);
        m.metallic = 0;
        m.emissive = emission;
        m.double_sided = true;
        scene.materials.push_back(m);
        scene.meshes[0].primitives.push_back({.material = uint32_t(scene.materials.size() - 1)});
        return uint32_t(scene.materials.size() - 1);
    }
    void triangle(uint32_t material, const vec3& a, const vec3& b, const vec3& c) {
        scenes::Primitive& p = scene.meshes[0].primitives[material];
        for (const vec3& v : {a, b, c}) p.indices.push_back(uint32_t(p.positions.size())), p.positions.push_back(v);
    }
    void quad(uint32_t material, const vec3& corner, const vec3& along, const vec3& up) {
        triangle(material, corner, corner + along, corner + along + up);
        triangle(material, corner, corner + along + up, corner + up);
    }
    void box(uint32_t material, const vec3& lo, const vec3& hi) {
        const vec3 e = hi - lo, x(e.x, 0, 0), y(0, e.y, 0), z(0, 0, e.z);
        quad(material, lo, y, x), quad(material, lo, z, y), quad(material, lo, x, z);
        quad(material, hi, -x, -y), quad(material, hi, -y, -z), quad(material, hi, -z, -x);
    }
    void point_light(const vec3& at, const vec3& intensity) {
        scene.lights.push_back({scenes::Light::Type::point, "", at, {0, -1, 0}, intensity});
    }
    void look(const vec3& from, const vec3& at, const vec3& up = {0, 1, 0}) {
        scene.cameras = {{"test", glm::mat4(glm::inverse(glm::lookAt(glm::dvec3(from), glm::dvec3(at), glm::dvec3(up)))), 0.9f}};
    }

    // A closed white room of half side s around `at`, a box on its floor, a light, a camera: the same image for any s and at.
    static Kit room(float s = 1, const vec3& at = vec3(0)) {
        Kit kit;
        kit.material({0.7f, 0.7f, 0.7f});
        kit.material({0.7f, 0.2f, 0.1f});
        kit.box(0, at - s, at + s);
        kit.box(1, at + s * vec3(-0.2f, -0.999f, -0.4f), at + s * vec3(0.5f, 0.1f, 0.2f));
        kit.point_light(at + s * vec3(-0.3f, 0.6f, 0.3f), s * s * vec3(3));
        kit.look(at + s * vec3(0.1f, 0.2f, 0.95f), at + s * vec3(0, -0.1f, -1));
        return kit;
    }
};

}  // namespace myriad::tests
