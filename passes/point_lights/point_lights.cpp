#include "passes/point_lights/point_lights.hpp"

#include "engine/transfer.hpp"

namespace myriad::passes {

View omni_view(const vec3& position) { return {.position = position, .cos_phi = -1, .direction = vec3(1, 0, 0), .sin_phi = 0}; }

PointLights::PointLights(engine::Device& device, const LightTable& lights)
    : device_(device), lights_(device, "vpls", "point lights", lights.points_apart().size()),
      views_(device, "vpls", "views of point lights", lights.points_apart().size()),
      count_(engine::upload(device, "vpls", "point light count", std::vector<uint>{uint(lights.points_apart().size())})) {
    upload(lights);
}

void PointLights::follow(const LightTable& lights) {
    if (lights.moves() != moves_) upload(lights);
}

void PointLights::upload(const LightTable& lights) {
    moves_ = lights.moves();
    std::vector<Vpl> vpls;
    std::vector<View> views;
    for (const Light& light : lights.points_apart()) {
        const bool shines = light.intensity.x > 0 || light.intensity.y > 0 || light.intensity.z > 0;
        vpls.push_back(omni_light(light.position, light.intensity, light.extent.x));
        views.push_back(shines ? omni_view(light.position) : view_of_nothing());
    }
    engine::upload_bytes(device_, vpls.data(), lights_, lights_.bytes());
    engine::upload_bytes(device_, views.data(), views_, views_.bytes());
}

}  // namespace myriad::passes
