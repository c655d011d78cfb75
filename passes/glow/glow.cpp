#include "passes/glow/glow.hpp"

#include <algorithm>

#include "passes/kernels.hpp"

namespace myriad::passes {

namespace {

std::span<const Light> punctual(const LightTable& lights) { return std::span(lights.data().lights).first(lights.punctual()); }

bool glows(const Light& light) { return light.type == light_point && light.extent.x > 0; }

}  // namespace

bool GlowPass::needed(const LightTable& lights) { return std::ranges::any_of(punctual(lights), glows); }

float GlowPass::unit_of(std::span<const Light> lights) {
    float most = 0;
    uint32_t count = 0;
    for (const Light& light : lights) {
        if (!glows(light)) continue;
        ++count;
        for (int c = 0; c < 3; ++c) most = std::max(most, glow_radiance(light.intensity[c], light.extent.x));
    }
    return std::max(float(double(most) * count / double(glow_units)), 1e-30f);
}

GlowPass::GlowPass(engine::Device& device, uint32_t width, uint32_t height)
    : splat_(device, engine::passes_kernels, "glow/splat"), resolve_(device, engine::passes_kernels, "glow/resolve"),
      sums_(device, "images", "glow", uint64_t(width) * height * 3) {}

void GlowPass::record(engine::Recorder& recorder, const GBuffer& gbuffer, const scenes::Camera& camera, const LightTable& lights) {
    const float unit = unit_of(punctual(lights));
    recorder.fill(sums_, 0);
    recorder.dispatch(splat_,
                      GlowSplatPush{.lights = lights.read(recorder),
                                    .positions = recorder.read(gbuffer.positions),
                                    .sums = recorder.write(sums_),
                                    .camera = camera_push(camera, gbuffer.width, gbuffer.height),
                                    .width = gbuffer.width,
                                    .height = gbuffer.height,
                                    .first = 0,
                                    .count = lights.punctual(),
                                    .per_unit = 1 / unit},
                      lights.punctual());
    recorder.dispatch(resolve_,
                      GlowResolvePush{.sums = recorder.read(sums_), .emitted = recorder.write(gbuffer.emitted), .pixels = uint(gbuffer.pixels()), .unit = unit},
                      gbuffer.pixels());
}

}  // namespace myriad::passes
