// The path-traced reference: an image of a scene without VPLs, apart from the device's code. README.md says what it promises.
//
//   reference::Film film(settings.width, settings.height);
//   reference::Reference(scene, lights, triangles, camera, settings).add_to(film);
//   const tools::Image image = film.image(false);
#pragma once

#include <functional>
#include <limits>

#include "tools/reference/film.hpp"

namespace myriad::reference {

enum class Pixel {
    centre,  // rays go through its middle, as those of `myriad render`
    box,     // anywhere in it, evenly
};

struct Settings {
    uint32_t width = 640, height = 360;
    uint32_t bounces = 1;         // reflections of light before that to the camera: as of `myriad render`
    uint32_t seed = 1;
    Model model = Model::gltf;
    Pixel pixel = Pixel::centre;
    // Of the geometry term between what is seen and what lights it, 1/m^2: for comparisons with images of VPLs, which are bounded by their --vpl-bound.
    float bound = std::numeric_limits<float>::infinity();
    uint32_t samples = 64;        // a pixel, in all
    double time_limit = std::numeric_limits<double>::infinity();  // seconds: no pass of one sample a pixel begins after that
    uint32_t threads = 0;         // 0: as many as there are; the image is the same
    // Called after each pass, with the seconds since add_to() was called; false ends it.
    std::function<bool(const Film& film, double seconds)> after_pass;
};

class Reference {
public:
    // Scene and triangles (in the world's space: flatten(scene, Sharing::never, …), moved to the moment) stay where they are; `lights` are the
    // scene's at the moment. Throws OutOfMemory.
    Reference(const scenes::Scene& scene, std::span<const scenes::Light> lights, const scenes::Triangles& triangles, const scenes::Camera& camera, const Settings& settings);

    // Samples until the film has as many as are asked for, or time is up: at least one, unless it has them all already.
    void add_to(Film& film) const;

private:
    void sample(Film& film) const;

    const Settings settings_;
    const Paths paths_;
    vec3 eye_, forward_, right_, up_;  // right and up as long as the tangents of half the angles of view
};

}  // namespace myriad::reference
