#include "passes/tonemap/tonemap.hpp"

#include "passes/kernels.hpp"

namespace myriad::passes {

TonemapPass::TonemapPass(engine::Device& device, uint64_t pixels)
    : tonemap_(device, engine::passes_kernels, "tonemap/tonemap"), pixels_(device, "images", "tone-mapped image", pixels) {}

void TonemapPass::record(engine::Recorder& recorder, const engine::Array<vec4>& radiance, float exposure) {
    recorder.dispatch(tonemap_,
                      TonemapPush{.radiance = recorder.read(radiance),
                                  .pixels = recorder.write(pixels_),
                                  .count = uint(pixels_.count()),
                                  .exposure = exposure},
                      pixels_.count());
}

}  // namespace myriad::passes
