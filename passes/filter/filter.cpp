#include "passes/filter/filter.hpp"

#include "passes/kernels.hpp"

namespace myriad::passes {

FilterPass::FilterPass(engine::Device& device, uint32_t width, uint32_t height, bool glossy)
    : filter_(device, engine::passes_kernels, "filter/filter", {{glossy_constant, glossy}}),
      filtered_(device, "images", "filtered irradiance", uint64_t(width) * height * (glossy ? 2 : 1)) {}

void FilterPass::record(engine::Recorder& recorder, const GBuffer& gbuffer, const engine::Array<vec4>& irradiance, uint32_t block,
                        float pixel_angle) {
    recorder.dispatch(filter_,
                      FilterPush{.gbuffer = gbuffer.read(recorder),
                                 .irradiance = recorder.read(irradiance),
                                 .filtered = recorder.write(filtered_),
                                 .block = block,
                                 .pixel_angle = pixel_angle},
                      gbuffer.pixels());
}

}  // namespace myriad::passes
