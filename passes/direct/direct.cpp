#include "passes/direct/direct.hpp"

#include "passes/kernels.hpp"

namespace myriad::passes {
namespace {

// What a shadow ray may take of Device::loop_limit(): on devices that end loops silently, the lights are spread over
// dispatches so that each ray has this many steps of its walk.
constexpr uint32_t steps_a_ray = 4096;

}  // namespace

DirectPass::DirectPass(engine::Device& device, uint32_t width, uint32_t height, uint32_t lights_a_dispatch,
                       const engine::Constants& variant)
    : direct_(device, engine::passes_kernels, "direct/direct", variant),
      lights_a_dispatch_(lights_a_dispatch ? lights_a_dispatch : std::max(1u, device.loop_limit() / steps_a_ray)),
      radiance_(device, "images", "direct light", uint64_t(width) * height),
      exhausted_(device, "images", "direct light exhausted", 1) {}

void DirectPass::record(engine::Recorder& recorder, const GBuffer& gbuffer, const compute::Bvh& bvh, const LightTable& lights) {
    assert(gbuffer.pixels() == radiance_.count());
    recorder.fill(exhausted_, 0);
    uint32_t first = 0;
    do {
        const uint32_t last = first + std::min(lights.lamps() - first, lights_a_dispatch_);
        recorder.dispatch(direct_,
                          DirectPush{.gbuffer = gbuffer.read(recorder),
                                     .bvh = bvh.read(recorder),
                                     .lights = lights.read(recorder),
                                     .radiance = recorder.write(radiance_),
                                     .exhausted = recorder.write(exhausted_),
                                     .first = first,
                                     .last = last},
                          gbuffer.pixels());
        first = last;
    } while (first < lights.lamps());
}

}  // namespace myriad::passes
