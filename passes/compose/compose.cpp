#include "passes/compose/compose.hpp"

#include "passes/kernels.hpp"

namespace myriad::passes {

ComposePass::ComposePass(engine::Device& device, uint32_t width, uint32_t height, bool lamps)
    : compose_(device, engine::passes_kernels, "compose/compose"), indirect_(device, "images", "indirect", uint64_t(width) * height),
      beauty_(device, "images", "beauty", uint64_t(width) * height),
      all_direct_(device, "images", "all direct light", lamps ? uint64_t(width) * height : 0) {}

void ComposePass::record(engine::Recorder& recorder, const GBuffer& gbuffer, const engine::Array<vec4>* irradiance,
                         const engine::Array<vec4>* natural, const engine::Array<vec4>* direct, const engine::Array<vec4>* lamps, const engine::Array<vec4>* beyond) {
    assert(!lamps || all_direct());
    recorder.dispatch(compose_,
                      ComposePush{.albedo = recorder.read(gbuffer.albedo),
                                  .emitted = recorder.read(gbuffer.emitted),
                                  .irradiance = irradiance ? recorder.read(*irradiance) : Float4s{},
                                  .natural = natural ? recorder.read(*natural) : Float4s{},
                                  .direct = direct ? recorder.read(*direct) : Float4s{},
                                  .lamps = lamps ? recorder.read(*lamps) : Float4s{},
                                  .beyond = beyond ? recorder.read(*beyond) : Float4s{},
                                  .indirect = recorder.write(indirect_),
                                  .beauty = recorder.write(beauty_),
                                  .all_direct = lamps ? recorder.write(all_direct_) : Float4s{},
                                  .count = uint(gbuffer.pixels()),
                                  .has_irradiance = irradiance != nullptr,
                                  .has_natural = natural != nullptr,
                                  .has_mirrored = gbuffer.glossy(),
                                  .has_direct = direct != nullptr,
                                  .has_lamps = lamps != nullptr,
                                  .has_beyond = beyond != nullptr},
                      gbuffer.pixels());
}

}  // namespace myriad::passes
