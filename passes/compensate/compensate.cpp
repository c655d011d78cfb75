#include "passes/compensate/compensate.hpp"

#include "passes/kernels.hpp"

namespace myriad::passes {

CompensatePass::CompensatePass(engine::Device& device, uint32_t width, uint32_t height, uint32_t rays, bool filter, const engine::Constants& variant)
    : compensate_(device, engine::passes_kernels, "compensate/compensate", variant), rays_(rays),
      irradiance_(device, "images", "light beyond the bound", uint64_t(width) * height) {
    assert(rays >= 1 && rays <= compensate_most_rays);
    if (filter) filter_.emplace(device, width, height);
}

// A ray a dispatch: on devices that end loops silently, each has all of what a dispatch may take.
void CompensatePass::record(engine::Recorder& recorder, const CompensateInputs& in, float pixel_angle,
                            const engine::Array<uint>& exhausted) {
    assert(in.gbuffer.pixels() == irradiance_.count() && in.bound > 0 && in.lights.power() > 0);
    for (uint32_t ray = 0; ray < rays_; ++ray)
        recorder.dispatch(compensate_,
                          CompensatePush{.gbuffer = in.gbuffer.read(recorder),
                                         .geometry = in.geometry.read(recorder),
                                         .bvh = in.bvh.read(recorder),
                                         .lights = in.lights.read(recorder),
                                         .irradiance = recorder.write(irradiance_),
                                         .exhausted = recorder.write(exhausted),
                                         .light_count = in.lights.count(),
                                         .bound = in.bound,
                                         .seed = in.seed,
                                         .counts = compensate_counts(ray, rays_, in.bounces)},
                          in.gbuffer.pixels());
    if (filter_) filter_->record(recorder, in.gbuffer, irradiance_, compensate_block, pixel_angle);
}

}  // namespace myriad::passes
