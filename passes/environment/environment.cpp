#include "passes/environment/environment.hpp"

#include <algorithm>
#include <numbers>

#include "compute/views/parallel.h"
#include "engine/transfer.hpp"
#include "passes/kernels.hpp"

namespace myriad::passes {

namespace {

using glm::dvec3;

struct Interval {
    double low = 1e300, high = -1e300;
    void hold(double v) { low = std::min(low, v), high = std::max(high, v); }
    double length() const { return high - low; }
};

// The bounds' shadow along an axis.
Interval shadow(const dvec3& axis, const dvec3& lo, const dvec3& hi) {
    Interval interval;
    for (int corner = 0; corner < 8; ++corner)
        interval.hold(glm::dot(axis, dvec3(corner & 1 ? hi.x : lo.x, corner & 2 ? hi.y : lo.y, corner & 4 ? hi.z : lo.z)));
    return interval;
}

}  // namespace

View parallel_view(const vec3& direction, const vec3& lo, const vec3& hi, uint map_size) {
    const ParallelFrame frame = parallel_frame(direction);
    const dvec3 across(frame.across), down(frame.down), along(direction);
    Interval u = shadow(across, lo, hi), v = shadow(down, lo, hi), depth = shadow(along, lo, hi);
    // What floats round off, here and in kernels. And what is seen edge-on gets some width: else texels would be far finer across it than the
    // samples, and all cuts would go down to the leaves.
    const double far = std::max({glm::length(dvec3(lo)), glm::length(dvec3(hi)), 1e-30});
    const double size = std::max({u.length(), v.length(), depth.length(), 1e-6 * far});
    const double margin = 1e-4 * size + 1e-6 * far;
    for (Interval* i : {&u, &v}) {
        const double missing = 0.5 * std::max(0.0, size / 8 - i->length());
        i->low -= missing + margin, i->high += missing + margin;
    }
    depth.low -= margin;

    const uint texels = map_texels(map_size);
    uint columns = 1;
    double texel = 1e300;
    const double ideal = std::sqrt(texels * u.length() / v.length());
    for (double candidate : {std::floor(ideal), std::ceil(ideal)}) {
        const uint n = uint(std::clamp(candidate, 1.0, double(texels)));
        const double side = std::max(u.length() / n, v.length() / (texels / n));
        if (side < texel) texel = side, columns = n;
    }
    View view;
    view.position = vec3(u.low * across + v.low * down + depth.low * along);
    view.cos_phi = -1 - float(columns);
    view.direction = direction;
    view.sin_phi = float(0.5 * texel * map_size);
    return view;
}

std::span<const scenes::Light> environment_lights(const scenes::Scene& scene) {
    return std::span(scene.lights).last(scene.environment ? scene.environment->solid_angles.size() : 0);
}

EnvironmentPass::EnvironmentPass(engine::Device& device, const scenes::Scene& scene, const vec3& lo, const vec3& hi, uint map_size)
    : columns_(scene.environment->width), rows_(scene.environment->height), turn_(float(scene.environment->rotation / (2 * std::numbers::pi))),
      background_(device, engine::passes_kernels, "environment/background"),
      texels_(engine::upload(device, "scene", "environment", scene.environment->texels)) {
    std::vector<Vpl> lights;
    std::vector<View> views;
    for (const scenes::Light& light : environment_lights(scene)) {
        lights.push_back(far_light(-light.direction, light.intensity, scene.environment->solid_angles[lights.size()]));
        views.push_back(parallel_view(light.direction, lo, hi, map_size));
    }
    lights_ = engine::upload(device, "scene", "environment lights", lights);
    views_ = engine::upload(device, "scene", "environment views", views);
    count_ = engine::upload(device, "scene", "environment light count", std::vector<uint>{uint(lights.size())});
}

void EnvironmentPass::record_background(engine::Recorder& recorder, const GBuffer& gbuffer, const scenes::Camera& camera) {
    recorder.dispatch(background_,
                      BackgroundPush{.texels = recorder.read(texels_),
                                     .positions = recorder.read(gbuffer.positions),
                                     .emitted = recorder.write(gbuffer.emitted),
                                     .camera = camera_push(camera, gbuffer.width, gbuffer.height),
                                     .width = gbuffer.width,
                                     .height = gbuffer.height,
                                     .columns = columns_,
                                     .rows = rows_,
                                     .turn = turn_},
                      gbuffer.pixels());
}

}  // namespace myriad::passes
