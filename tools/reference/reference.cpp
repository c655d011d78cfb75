#include "tools/reference/reference.hpp"

#include <atomic>
#include <cassert>
#include <chrono>
#include <cmath>

#include "engine/parallel.hpp"

namespace myriad::reference {

Reference::Reference(const scenes::Scene& scene, std::span<const scenes::Light> lights, const scenes::Triangles& triangles, const scenes::Camera& camera,
                     const Settings& settings)
    : settings_(settings), paths_(scene, lights, triangles, settings.bounces, settings.model, settings.bound), eye_(camera.to_world[3]) {
    assert(triangles.placements.empty());
    const double tangent = std::tan(0.5 * double(camera.yfov));
    const auto axis = [&](int i) { return glm::normalize(glm::dvec3(camera.to_world[i])); };  // a scaled node scales no camera
    forward_ = vec3(-axis(2));
    right_ = vec3(axis(0) * (tangent * settings.width / settings.height));
    up_ = vec3(axis(1) * tangent);
}

void Reference::sample(Film& film) const {
    std::atomic<uint64_t> dropped = 0;
    const size_t pixels = size_t(settings_.width) * settings_.height;
    engine::parallel_pieces(pixels, 256, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            Sampler sampler(settings_.seed, uint32_t(i), film.samples());
            const vec2 in = settings_.pixel == Pixel::box ? sampler.pair() : vec2(0.5f);
            const float x = 2 * (float(i % settings_.width) + in.x) / float(settings_.width) - 1;
            const float y = 1 - 2 * (float(i / settings_.width) + in.y) / float(settings_.height);
            Radiance radiance = paths_.along(eye_, glm::normalize(forward_ + x * right_ + y * up_), sampler);
            if (!Film::finite(radiance)) radiance = {}, ++dropped;
            film.add(i, radiance);
        }
    }, settings_.threads);
    film.end_pass(dropped);
}

void Reference::add_to(Film& film) const {
    assert(film.width() == settings_.width && film.height() == settings_.height);
    const auto start = std::chrono::steady_clock::now();
    while (film.samples() < settings_.samples) {
        sample(film);
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (settings_.after_pass && !settings_.after_pass(film, seconds)) break;
        if (seconds >= settings_.time_limit) break;
    }
}

}  // namespace myriad::reference
