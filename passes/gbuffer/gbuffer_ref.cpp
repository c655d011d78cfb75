#include "passes/gbuffer/gbuffer_ref.hpp"

#include <cmath>

namespace myriad::passes {

using glm::dvec3;

std::vector<PixelRef> gbuffer_ref(const scenes::Scene& scene, const scenes::Triangles& triangles, const scenes::Camera& camera,
                                  uint32_t width, uint32_t height) {
    const glm::dmat4 to_world(camera.to_world);
    const double tangent = std::tan(0.5 * double(camera.yfov));
    const dvec3 eye(to_world[3]);
    std::vector<PixelRef> pixels(size_t(width) * height);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const double right = (2 * (x + 0.5) / width - 1) * tangent * width / height, up = (1 - 2 * (y + 0.5) / height) * tangent;
            const dvec3 direction = glm::normalize(dvec3(to_world * glm::dvec4(right, up, -1, 0)));
            const HitRef hit = closest_ref(triangles, eye, direction, 0, 1e30, there_ref(scene, triangles, opacity_pixel(x, y)));
            PixelRef& pixel = pixels[size_t(y) * width + x];
            pixel.surface.emission = dvec3(scene.background);
            if (!hit) continue;
            pixel.surface = face_towards_ref(surface_ref(scene, triangles, hit.triangle, hit.u, hit.v), direction);
            pixel.direction = direction;
            pixel.depth = hit.t * glm::dot(direction, -dvec3(to_world[2]));
        }
    return pixels;
}

}  // namespace myriad::passes
