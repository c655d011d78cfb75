#include "scenes/sky.hpp"

#include <algorithm>
#include <cmath>

#include <glm/gtc/constants.hpp>

namespace myriad::scenes {
namespace {

float largest(const glm::vec3& v) { return std::max({v.x, v.y, v.z}); }

bool shines(const Material& m) { return !m.unlit && largest(m.emissive) > (m.emissive_texture.texture == none ? 0.0f : 1.0f); }

}  // namespace

std::vector<Light> sky_lights(float radiance, uint32_t count) {
    std::vector<Light> lights(count);
    const double turn = glm::pi<double>() * (3 - std::sqrt(5.0));  // the golden angle
    for (uint32_t i = 0; i < count; ++i) {
        // Equal steps of height cut a hemisphere into rings of equal solid angle.
        const double up = (i + 0.5) / count, out = std::sqrt(1 - up * up), angle = turn * i;
        Light& light = lights[i];
        light.type = Light::Type::directional;
        light.name = "sky " + std::to_string(i);
        light.direction = -glm::vec3(glm::dvec3(out * std::cos(angle), up, out * std::sin(angle)));
        light.intensity = glm::vec3(float(2 * glm::pi<double>() / count * radiance));
    }
    return lights;
}

bool needs_sky(const Scene& scene) {
    for (const Light& light : scene.lights)
        if (largest(light.intensity) > 0) return false;
    bool lit = false;
    for (const Instance& instance : scene.instances)
        for (const Primitive& primitive : scene.meshes[instance.mesh].primitives) {
            if (primitive.indices.empty()) continue;
            const Material& material = scene.materials[primitive.material];
            if (shines(material)) return false;
            lit |= !material.unlit;
        }
    return lit;
}

void apply_sky(Scene& scene, SkyChoice choice) {
    if (choice == SkyChoice::off || (choice == SkyChoice::automatic && !needs_sky(scene))) return;
    scene.background = glm::vec3(default_sky_radiance);
    const std::vector<Light> sky = sky_lights(default_sky_radiance, default_sky_lights);
    scene.lights.insert(scene.lights.end(), sky.begin(), sky.end());
    if (choice == SkyChoice::automatic)
        scene.warnings.push_back("the scene has no light: it is lit by a sky of radiance 1 (" + std::to_string(default_sky_lights) +
                                 " directional lights), --sky off leaves it dark.");
}

}  // namespace myriad::scenes
